// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>
#include <limits>

#include "carus/fem/constraints.hpp"
#include "carus/solve/energy.hpp"
#include "carus/solve/explicit_impl.hpp"

namespace carus::solve {

namespace {

constexpr int block_count = 16;  // more than any machine we expect has cores for one birth; part of the result
constexpr double updates_per_tau = 200;

}  // namespace

Explicit::Impl::Impl(const fem::Model& m, const ExplicitOptions& o)
    : model(m),
      options(o),
      threads(o.threads),
      pace(o.pace),
      mean_scale(o.labour_duration / o.pseudo_duration),
      scale(mean_scale),
      rest_length(m) {
  total_steps = std::int64_t(std::ceil(o.pseudo_duration / o.time_step));
  dt = o.pseudo_duration / double(total_steps);
  masses = scaled_masses(model, dt, o.safety);
  for (const auto& b : model.body_forces) body_mass.push_back(fem::lumped_mass(model, b.regions));
  move_mass_of_ties();
  start_state();
  constrained = fem::constrained_axes(model);
  make_inverse_masses();
  describe_nodes();
  gather_tethers();
  make_elements();
  make_contact();
  keep();
}

void Explicit::Impl::start_state() {
  state.x = model.mesh.nodes;
  state.labour_per_pseudo = scale;
  state.v.assign(state.x.size(), Vec3::Zero());
  state.hinge_angle.assign(model.hinges.size(), 0.0);
  state.hinge_rate.assign(model.hinges.size(), 0.0);
  external_force.assign(state.x.size(), Vec3::Zero());
  contact_impulse.assign(state.x.size(), Vec3::Zero());
  v_before = v_free = lift = state.v;
  rate_before = rate_free = state.hinge_rate;
  sums.resize((state.x.size() + node_chunk - 1) / node_chunk);
  touched_sums.resize(sums.size());
  pressures.assign(model.pressures.size(), 0.0);
}

/// T^T M T of x_s = sum w_k x_k, its rows summed: momentum is exact, and the critical step only grows.
void Explicit::Impl::move_mass_of_ties() {
  for (const auto& tie : model.ties) {
    for (auto* m : {&masses.scaled, &masses.unscaled}) {
      for (int k = 0; k < 3; ++k) (*m)[tie.facet[k]] += tie.weights[k] * (*m)[tie.node];
      (*m)[tie.node] = 0;
    }
  }
}

/// Drag in pseudo-time follows the pace, and with it all masses that carry it.
void Explicit::Impl::make_inverse_masses() {
  const std::size_t n = state.x.size();
  drag_mass.resize(n);
  for (std::size_t i = 0; i < n; ++i) drag_mass[i] = dt * options.drag / scale * masses.unscaled[i];
  inverse_mass.assign(n, Vec3::Zero());
  inverse_mass_blocked.assign(n, Vec3::Zero());
  carry.assign(n, 0), pull.assign(n, 0);
  for (std::size_t i = 0; i < n; ++i) {
    if (masses.scaled[i] <= 0) continue;  // nodes of rigid parts only
    for (int k = 0; k < 3; ++k) inverse_mass[i][k] = (constrained[i] >> k) & 1 ? 0 : 1 / dragged_mass(i);
    carry[i] = masses.scaled[i] / dragged_mass(i), pull[i] = dt / dragged_mass(i);
    if (!model.blocked_direction.empty() && constrained[i] == fem::Blocked::none)
      inverse_mass_blocked[i] = model.blocked_direction[i] / std::sqrt(dragged_mass(i));
  }
  for (const auto& h : model.hinges) {
    for (const auto i : h.nodes) inverse_mass[i].setZero(), inverse_mass_blocked[i].setZero();
  }
}

void Explicit::Impl::describe_nodes() {
  const std::size_t n = state.x.size();
  traits.assign(n, 0);
  for (std::size_t i = 0; i < n; ++i) {
    if (inverse_mass[i].isZero()) {
      traits[i] = fixed;
      continue;
    }
    if (!inverse_mass_blocked[i].isZero() || inverse_mass[i].minCoeff() == 0) traits[i] = held;
  }
  for (const auto& load : model.pressures) {
    for (const auto& t : load.surface)
      for (const auto node : t) traits[node] |= loaded;
  }
  if (!model.body_forces.empty())
    for (auto& t : traits) t |= loaded;
  for (const auto& motion : model.motions) led.insert(led.end(), motion.nodes.begin(), motion.nodes.end());
  for (const auto& tie : model.ties) {
    led.push_back(tie.node);
    led.insert(led.end(), tie.facet.begin(), tie.facet.end());
  }
}

void Explicit::Impl::gather_tethers() {
  tether_of.assign(state.x.size(), -1);
  for (const auto& t : model.tethers) {
    auto& index = tether_of[t.node];
    if (index < 0) index = std::int32_t(tethers.size()), tethers.push_back(Mat3::Zero());
    tethers[std::size_t(index)] += t.stiffness * t.direction * t.direction.transpose();
    traits[t.node] |= tethered;
  }
}

void Explicit::Impl::make_materials() {
  double least = std::numeric_limits<double>::infinity();
  for (const auto& r : model.regions) {
    materials.push_back(kernel_material(r));
    for (const auto& branch : r.material.prony) least = std::min(least, branch.tau);
  }
  if (std::isfinite(least)) relax_every = least / updates_per_tau;
}

void Explicit::Impl::make_elements() {
  blocks = fem::make_blocks(model, block_count);
  reports.resize(blocks.size()), relaxation.resize(blocks.size());
  nodal_pressure = std::make_unique<fem::NodalPressure>(model, blocks);
  make_materials();
  std::vector<std::int32_t> count(state.x.size() + 1, 0);
  for (const auto& b : blocks) {
    for (const auto n : b.nodes) ++count[std::size_t(n) + 1];
  }
  for (std::size_t i = 1; i < count.size(); ++i) count[i] += count[i - 1];
  share_begin = count;
  shares.resize(std::size_t(count.back()));
  for (std::size_t b = 0; b < blocks.size(); ++b) {
    for (std::size_t l = 0; l < blocks[b].nodes.size(); ++l) {
      shares[std::size_t(count[blocks[b].nodes[l]]++)] = &blocks[b].f[l];
    }
  }
  find_retracting();
}

void Explicit::Impl::find_retracting() {
  if (!rest_length.active()) return;
  std::vector<std::int32_t> index(model.mesh.tets.size(), -1);
  const auto& list = model.retraction.elements;
  for (std::size_t i = 0; i < list.size(); ++i) index[list[i]] = std::int32_t(i);
  retracting.assign(list.size(), {-1, -1, -1});
  for (std::size_t b = 0; b < blocks.size(); ++b) {
    for (std::size_t q = 0; q < blocks[b].batches.size(); ++q) {
      for (int l = 0; l < fem::lanes; ++l) {
        const auto& batch = blocks[b].batches[q];
        const auto i = index[batch.element[l]];
        if (i >= 0 && batch.volume[l] > 0) retracting[i] = {std::int32_t(b), std::int32_t(q), l};
      }
    }
  }
  for (const auto e : list) retracting_inverse_edges.push_back(fem::inverse_edges(model.mesh, std::size_t(e)));
  set_rest_shape();  // as a restored run does, rounding included
}

std::vector<double> Explicit::Impl::hinge_inverse_inertias() const {
  std::vector<double> inverse;
  for (const auto& h : model.hinges) inverse.push_back(1 / dragged_inertia(h));
  return inverse;
}

/// All that depends on the time scaling. Velocities stay: a change of pace is no impulse.
void Explicit::Impl::take_pace() {
  scale = state.labour_per_pseudo = mean_scale * pace.factor();
  make_inverse_masses();
  contact->weigh(inverse_mass, inverse_mass_blocked, hinge_inverse_inertias());
}

void Explicit::Impl::make_contact() {
  std::vector<contact::Surface> surfaces;
  for (const auto& s : model.contact_surfaces) surfaces.emplace_back(s.name, s.triangles, model.mesh.nodes);
  std::vector<contact::Pair> pairs;
  for (const auto& p : model.contact_pairs) pairs.push_back({p.a, p.b, p.friction});
  std::vector<std::int16_t> hinge_of(state.x.size(), -1);
  std::vector<contact::HingeBody> hinges;
  const auto inertias = hinge_inverse_inertias();
  for (std::size_t h = 0; h < model.hinges.size(); ++h) {
    for (const auto n : model.hinges[h].nodes) hinge_of[n] = std::int16_t(h);
    hinges.push_back({model.hinges[h].point, model.hinges[h].axis, inertias[h]});
  }
  contact::Options o;
  o.sweeps = options.contact_sweeps;
  o.correction_speed = options.contact_correction;
  o.reach = 2 * options.contact_search;
  contact = std::make_unique<contact::Contact>(std::move(surfaces), std::move(pairs), model.mesh.nodes, inverse_mass,
                                               inverse_mass_blocked, std::move(hinge_of), std::move(hinges), o);
}

}  // namespace carus::solve
