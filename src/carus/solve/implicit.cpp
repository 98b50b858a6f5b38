// SPDX-License-Identifier: Apache-2.0
#include "carus/solve/implicit.hpp"

#include <algorithm>
#include <limits>

#include "carus/contact/intersection.hpp"
#include "carus/core/error.hpp"
#include "carus/core/stopwatch.hpp"
#include "carus/fem/constraints.hpp"
#include "carus/solve/implicit_impl.hpp"

namespace carus::solve {

namespace {

std::vector<contact::Side> sides_of(const fem::Model& model) {
  std::vector<contact::Side> out;
  for (const auto& s : model.contact_surfaces) out.push_back({s.name, s.triangles});
  return out;
}
std::vector<contact::Touching> touching(const fem::Model& model) {
  std::vector<contact::Touching> out;
  for (const auto& p : model.contact_pairs) out.push_back({p.a, p.b, p.friction});
  return out;
}

}  // namespace

Implicit::Impl::Impl(const fem::Model& m, const ImplicitOptions& o)
    : model(m),
      options(o),
      threads(o.threads),
      freedom(m),
      elastic(m),
      rest_length(m),
      contact(sides_of(m), touching(m), m.mesh.nodes, moving(freedom), {o.barrier_distance, o.barrier_pressure}),
      step_length(o.time_step) {
  state.x = model.mesh.nodes;
  state.v.assign(state.x.size(), Vec3::Zero());
  state.hinge_angle.assign(model.hinges.size(), 0.0);
  state.hinge_rate.assign(model.hinges.size(), 0.0);
  mass = fem::lumped_mass(model, {});
  for (const auto& f : model.body_forces) body_mass.push_back(fem::lumped_mass(model, f.regions));
  pressures.assign(model.pressures.size(), 0.0);
  expanded.resize(state.x.size()), product.resize(state.x.size());
  if (rest_length.active()) elastic.set_rest_length(rest_length);
  load = loads_at(state.x, 0);
  if (const auto cut = intersecting(state.x); !cut.empty())
    throw InputError("contact: surfaces cut each other at the start: " + cut +
                     "; the implicit solver keeps apart what is apart; hint: move the bodies or refine their meshes");
  keep();
}

std::vector<std::uint8_t> Implicit::Impl::moving(const Freedom& freedom) {
  std::vector<std::uint8_t> out(freedom.nodes());
  for (std::size_t i = 0; i < out.size(); ++i) out[i] = freedom.moves(i);
  return out;
}

/// Empty where no triangles cut each other, else which.
std::string Implicit::Impl::intersecting(const std::vector<Vec3>& at) {
  const Stopwatch watch(seconds[proof]);
  const auto cuts = contact::intersections(contact.sides(), contact.pairs(), at);
  if (cuts.empty()) return {};
  const auto& c = cuts.front();
  const auto& pair = contact.pairs()[std::size_t(c.pair)];
  const auto& side = contact.sides()[std::size_t(pair.a)];
  const Vec3 where = at[std::size_t(side.triangles[std::size_t(c.first)][0])];
  return fmt::format("{} and {}, facets {} and {} near ({:.1f}, {:.1f}, {:.1f}) mm, {}{} in all", side.name,
                     contact.sides()[std::size_t(pair.b)].name, c.first, c.second, 1e3 * where.x(), 1e3 * where.y(),
                     1e3 * where.z(), cuts.size(), cuts.size() < 20 ? "" : " or more");
}

void Implicit::Impl::keep() {
  state.rest_length = rest_length.rings();
  state.internal = {work.external, work.contact, work.damping, work.active, work.relaxation, step_length};
  const auto history = elastic.save();
  state.internal.insert(state.internal.end(), history.begin(), history.end());
}

void Implicit::Impl::restore(const fem::State& from) {
  if (from.x.size() != state.x.size() || from.v.size() != state.v.size() ||
      from.internal.size() != fixed_entries + elastic.history_size() ||
      from.rest_length.size() != state.rest_length.size() || from.hinge_angle.size() != state.hinge_angle.size())
    throw InputError(
        fmt::format("the state to restore is of another model or solver: {} nodes and {} internal values, "
                    "this one has {} and {}; hint: mesh and scenario must be those it was saved with",
                    from.x.size(), from.internal.size(), state.x.size(), fixed_entries + elastic.history_size()));
  state = from;
  const double* p = state.internal.data();
  work = {p[0], p[1], p[2], p[3], p[4]}, step_length = p[5];
  elastic.load(p + fixed_entries);
  rest_length.rings() = state.rest_length;
  if (rest_length.active()) elastic.set_rest_length(rest_length);
  load = loads_at(state.x, state.time);
}

Observables Implicit::Impl::observe() {
  Observables o;
  o.pressures = pressures;
  if (options.inertia) {
    for (std::size_t i = 0; i < state.v.size(); ++i) o.kinetic += 0.5 * mass[i] * state.v[i].squaredNorm();
    for (std::size_t h = 0; h < model.hinges.size(); ++h)
      o.kinetic += 0.5 * model.hinges[h].inertia * state.hinge_rate[h] * state.hinge_rate[h];
  }
  o.internal = elastic.stored(state.x) + tether_part(state.x);
  for (std::size_t h = 0; h < model.hinges.size(); ++h)
    o.internal += 0.5 * model.hinges[h].stiffness * state.hinge_angle[h] * state.hinge_angle[h];
  o.external_work = work.external, o.contact_work = work.contact, o.damping_work = work.damping;
  o.active_work = work.active, o.relaxation_work = work.relaxation;
  const auto volumes = elastic.volumes(state.x);
  o.min_J = volumes.min_J, o.inverted = volumes.inverted;
  o.contact_force.assign(state.x.size(), Vec3::Zero());
  contact.add_gradient(state.x, o.contact_force);
  for (Vec3& f : o.contact_force) f = -f;
  o.least_gap = std::numeric_limits<double>::infinity();
  for (const auto& n : contact.nearest(state.x, options.barrier_distance))
    o.least_gap = std::min(o.least_gap, n.distance);
  o.reaction = reactions();
  o.hinge_angle = state.hinge_angle;
  o.rest_length_mean = rest_length.mean();
  return o;
}

/// What the elements of a node at rest would need on its held axes, less the loads.
std::vector<Vec3> Implicit::Impl::reactions() {
  x = state.x;
  gradient();
  contact.add_gradient(x, g);
  const auto axes = fem::constrained_axes(model);
  std::vector<Vec3> out(x.size(), Vec3::Zero());
  for (std::size_t i = 0; i < out.size(); ++i)
    for (int k = 0; k < 3; ++k)
      if ((axes[i] >> k) & 1) out[i][k] = g[i][k] - load[i][k];
  return out;
}

Implicit::Implicit(const fem::Model& model, const ImplicitOptions& options)
    : impl_(std::make_unique<Impl>(model, options)) {}
Implicit::~Implicit() = default;

void Implicit::advance_to(double time) { impl_->advance_to(time); }
const fem::State& Implicit::state() const { return impl_->state; }
void Implicit::restore(const fem::State& state) { impl_->restore(state); }
Observables Implicit::observe() const { return impl_->observe(); }
ImplicitCounts Implicit::counts() const { return impl_->counts; }

std::vector<double> Implicit::least_distances(double reach) const {
  std::vector<double> out;
  for (const auto& n : impl_->contact.nearest(impl_->state.x, reach)) out.push_back(n.distance);
  return out;
}

std::vector<std::pair<std::string, double>> Implicit::timings() const {
  std::vector<std::pair<std::string, double>> out;
  for (int k = 0; k < Impl::stage_count; ++k) out.emplace_back(Impl::stage_names[k], impl_->seconds[k]);
  return out;
}

}  // namespace carus::solve
