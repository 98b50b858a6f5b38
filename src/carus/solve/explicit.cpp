// SPDX-License-Identifier: Apache-2.0
#include "carus/solve/explicit.hpp"

#include <algorithm>

#include "carus/core/error.hpp"
#include "carus/solve/energy.hpp"
#include "carus/solve/explicit_impl.hpp"

namespace carus::solve {

/// Static: inertia is left out.
std::vector<Vec3> Explicit::Impl::reactions(const std::vector<Vec3>& contact_force) const {
  std::vector<Vec3> f(state.x.size());
  for (std::size_t i = 0; i < f.size(); ++i)
    f[i] = internal_force(i) + external_force[i] + tether_force(i) + contact_force[i];
  for (const auto& tie : model.ties) {
    for (int k = 0; k < 3; ++k) f[tie.facet[k]] += tie.weights[k] * f[tie.node];
    f[tie.node].setZero();
  }
  for (std::size_t i = 0; i < f.size(); ++i) {
    for (int k = 0; k < 3; ++k) f[i][k] = (constrained[i] >> k) & 1 ? -f[i][k] : 0;
  }
  return f;
}

double Explicit::Impl::kinetic() const {
  double sum = parallel::sum_chunks(state.v.size(), node_chunk, [&](std::size_t b, std::size_t e) {
    double chunk = 0;
    for (std::size_t i = b; i < e; ++i) chunk += 0.5 * masses.scaled[i] * state.v[i].squaredNorm();
    return chunk;
  });
  for (std::size_t h = 0; h < model.hinges.size(); ++h)
    sum += 0.5 * model.hinges[h].inertia * state.hinge_rate[h] * state.hinge_rate[h];
  return sum;
}

double Explicit::Impl::stored() const { return stored_energy(model, blocks, state) + nodal_pressure->energy(); }

void Explicit::Impl::keep() {
  state.rest_length = rest_length.rings();
  state.internal = {work.external, work.contact,        work.damping, work.active,  work.relaxation,
                    max_speed,     double(pace.rung()), relaxed_at,   retracted_at, internal_energy};
  contact->pause(state.x);
  const auto partners = contact->save();
  state.internal.insert(state.internal.end(), partners.begin(), partners.end());
  for (const auto& b : blocks) {
    for (const auto& stress : b.history) {
      for (const auto& row : stress.row) state.internal.insert(state.internal.end(), row, row + fem::lanes);
    }
  }
  good = state, good_work = work;
  loads_due = true;
}

void Explicit::Impl::restore_private() {
  const double* p = state.internal.data();
  work = {p[0], p[1], p[2], p[3], p[4]}, max_speed = p[5];
  pace.set_rung(int(p[6])), relaxed_at = p[7], retracted_at = p[8], internal_energy = p[9];
  p += 10;
  take_pace();
  contact->load(p, state.x);
  p += contact->save().size();
  for (auto& b : blocks) {
    for (auto& stress : b.history) {
      for (auto& row : stress.row)
        for (float& v : row) v = float(*p++);
    }
  }
  rest_length.rings() = state.rest_length;
  set_rest_shape();
  loads_due = true;
}

Explicit::Explicit(const fem::Model& model, const ExplicitOptions& options)
    : impl_(std::make_unique<Impl>(model, options)) {}
Explicit::~Explicit() = default;

StepReport Explicit::step_report() const {
  const auto& m = impl_->masses;
  return {impl_->dt, m.critical_step, m.limiting_region, m.added_fraction};
}

std::int64_t Explicit::steps() const { return impl_->total_steps; }
const fem::State& Explicit::state() const { return impl_->state; }

void Explicit::advance_to(double time) {
  Impl& s = *impl_;
  const double end = std::min(time, s.options.labour_duration);
  s.contact_samples = 0;
  std::fill(s.contact_impulse.begin(), s.contact_impulse.end(), Vec3::Zero());
  while (s.state.time + 0.5 * s.dt * s.scale < end) s.step();
  s.keep();
}

void Explicit::restore(const fem::State& state) {
  const fem::State& own = impl_->good;
  if (state.x.size() != own.x.size() || state.v.size() != own.v.size() ||
      state.internal.size() != own.internal.size() || state.rest_length.size() != own.rest_length.size() ||
      state.hinge_angle.size() != own.hinge_angle.size())
    throw InputError(
        fmt::format("the state to restore is of another model: {} nodes and {} internal values, this model has {} and "
                    "{}; hint: mesh and scenario must "
                    "be those it was saved with",
                    state.x.size(), state.internal.size(), own.x.size(), own.internal.size()));
  impl_->state = state;
  impl_->restore_private();
  impl_->good = impl_->state, impl_->good_work = impl_->work;
}

Observables Explicit::observe() const {
  const Impl& s = *impl_;
  Observables o;
  o.pressures = s.pressures;
  o.kinetic = s.kinetic(), o.internal = s.stored();
  o.external_work = s.work.external, o.contact_work = s.work.contact, o.damping_work = s.work.damping;
  o.active_work = s.work.active;
  o.relaxation_work = s.work.relaxation + relaxed_energy(s.model, s.blocks, s.state.x);
  o.least_gap = s.contact->least_gap();
  for (const auto& r : s.reports) o.min_J = std::min(o.min_J, double(r.min_J)), o.inverted += r.inverted;
  o.contact_force = s.contact_impulse;
  const double per = s.contact_samples ? 1 / (s.dt * s.contact_samples) : 0;
  for (Vec3& f : o.contact_force) f *= per;
  o.reaction = s.reactions(o.contact_force);
  o.hinge_angle = s.state.hinge_angle;
  o.rest_length_mean = s.rest_length.mean();
  return o;
}

std::vector<std::pair<std::string, double>> Explicit::timings() const {
  std::vector<std::pair<std::string, double>> out;
  for (int k = 0; k < Impl::stage_count; ++k) out.emplace_back(Impl::stage_names[k], impl_->seconds[k]);
  return out;
}

}  // namespace carus::solve
