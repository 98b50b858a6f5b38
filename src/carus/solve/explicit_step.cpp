// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>
#include <numeric>

#include "carus/core/error.hpp"
#include "carus/core/stopwatch.hpp"
#include "carus/fem/constraints.hpp"
#include "carus/fem/pressure.hpp"
#include "carus/solve/energy.hpp"
#include "carus/solve/explicit_impl.hpp"

namespace carus::solve {

namespace {

constexpr int loads_every = 4;            // steps: surfaces turn slowly against the step
constexpr double retraction_every = 0.5;  // [s of labour]: its time constants are seconds
constexpr int judge_pace_every = 64;      // steps: velocities have followed the last change by then
constexpr int look_at_energy_every = 4 * judge_pace_every;
constexpr int sample_contact_every =
    7;  // steps, for the mean contact force between two observations; no multiple of another rhythm

}  // namespace

void Explicit::Impl::apply_loads(double t) {
  const Stopwatch watch(seconds[loads]);
  std::fill(external_force.begin(), external_force.end(), Vec3::Zero());
  for (std::size_t l = 0; l < model.pressures.size(); ++l) {
    pressures[l] = model.pressures[l].pressure(t);
    if (pressures[l] != 0) fem::add_pressure_forces(model.pressures[l], pressures[l], state.x, external_force);
  }
  fem::add_body_forces(model, body_mass, t, external_force);
}

/// Sets the stress-free shape of the retracting wall: F_e = F F_a^-1 = Ds (B F_a^-1); det F_a = 1 keeps the volume.
void Explicit::Impl::set_rest_shape() {
  parallel::for_chunks(retracting.size(), 512, [&](std::size_t b, std::size_t e, std::size_t) {
    for (std::size_t i = b; i < e; ++i) {
      const auto [block, batch, lane] = retracting[i];
      const Mat3 B = retracting_inverse_edges[i] * inverse_active_strain(model.retraction, i, rest_length.of(i));
      for (int k = 0; k < 9; ++k) blocks[block].batches[batch].B[k][lane] = float(B(k / 3, k % 3));
    }
  });
}

void Explicit::Impl::retract(double t) {
  const Stopwatch watch(seconds[loads]);
  const auto before = rest_length.rings();
  rest_length.advance(state.x, t, t - retracted_at);
  retracted_at = t;
  if (rest_length.rings() == before) return;
  const double energy = retracting_energy();
  set_rest_shape();
  work.active += retracting_energy() - energy;
}

double Explicit::Impl::retracting_energy() const {
  return parallel::sum_chunks(retracting.size(), 512, [&](std::size_t b, std::size_t e) {
    double sum = 0;
    for (std::size_t i = b; i < e; ++i) {
      const auto [block, batch, lane] = retracting[i];
      sum += element_energy(model, blocks[block].batches[batch], lane, state.x) -
             element_relaxed(model, blocks[block], std::size_t(batch), lane, state.x);
    }
    return sum;
  });
}

void Explicit::Impl::gather(fem::Block& b) const {
  for (std::size_t l = 0; l < b.nodes.size(); ++l) {
    const Vec3& p = state.x[b.nodes[l]];
    b.x[l] = {{float(p.x()), float(p.y()), float(p.z()), 0.f}};
  }
}

double Explicit::Impl::relax(fem::Block& b) const {
  double energy = 0;
  for (std::size_t r = 0; r < b.runs.size(); ++r) {
    const auto& run = b.runs[r];
    if (materials[run.region].prony_terms == 0) continue;
    energy += fem::kernel().relax(b.batches.data() + run.begin, run.end - run.begin, materials[run.region], b.x.data(),
                                  b.history.data() + b.history_begin[r]);
  }
  return energy;
}

void Explicit::Impl::element_forces() {
  const Stopwatch watch(seconds[elements]);
  const auto& kernel = fem::kernel();
  const double since = state.time - relaxed_at;
  const bool relaxes = relax_every > 0 && since > 0 && since + dt * scale > relax_every;
  if (relaxes) {
    for (std::size_t r = 0; r < materials.size(); ++r) set_relaxation(materials[r], model.regions[r], since);
    relaxed_at = state.time;
  }
  parallel::for_chunks(blocks.size(), 1, [&](std::size_t i, std::size_t, std::size_t) {
    gather(blocks[i]);
    if (relaxes) relaxation[i] = relax(blocks[i]);
    nodal_pressure->add_volumes(blocks[i]);
  });
  if (relaxes) work.relaxation = std::accumulate(relaxation.begin(), relaxation.end(), work.relaxation);
  nodal_pressure->update(blocks);
  parallel::for_chunks(blocks.size(), 1, [&](std::size_t i, std::size_t, std::size_t) {
    fem::Block& b = blocks[i];
    std::fill(b.f.begin(), b.f.end(), fem::Float4{{0, 0, 0, 0}});
    reports[i] = {};
    for (std::size_t r = 0; r < b.runs.size(); ++r) {
      const auto& run = b.runs[r];
      const auto report =
          kernel.forces(b.batches.data() + run.begin, run.end - run.begin, materials[run.region], b.x.data(),
                        b.f.data(), b.pressure_begin[r] < 0 ? nullptr : b.pressure.data() + b.pressure_begin[r],
                        b.history.data() + b.history_begin[r]);
      reports[i].inverted += report.inverted;
      reports[i].min_J = std::min(reports[i].min_J, report.min_J);
      if (report.worst_element >= 0) reports[i].worst_element = report.worst_element;
    }
  });
}

/// No pressure changes noticeably in the next `span` [s of labour]. Imposed motions always do; body forces are weight.
bool Explicit::Impl::loads_stand(double span) const {
  constexpr double noticeable = 0.01;
  return model.motions.empty() &&
         std::all_of(model.pressures.begin(), model.pressures.end(), [&](const fem::PressureLoad& load) {
           const double now = load.pressure(state.time), then = load.pressure(state.time + span);
           return std::abs(then - now) <= noticeable * std::max(std::abs(now), std::abs(then));
         });
}

/// After the elements, whose pressures the stored energy wants; so a resumed run judges as an uninterrupted one.
void Explicit::Impl::judge_pace() {
  const Stopwatch watch(seconds[loads]);
  if (state.step % look_at_energy_every == 0) internal_energy = stored();
  if (pace.judge(kinetic(), internal_energy, loads_stand(2 * judge_pace_every * dt * scale))) take_pace();
}

// Nodes that nothing touches move at once; the others wait for the contact solve in between.
void Explicit::Impl::find_contacts() {
  const Stopwatch watch(seconds[contact_search]);
  if (!contact->detect(state.x, dt, max_speed)) return;
  for (const auto n : touched) traits[n] &= std::uint8_t(~touching);
  touched.clear();
  const auto touch = [&](std::int32_t n) {
    if (traits[n] & touching) return;
    traits[n] |= touching;
    touched.push_back(n);
  };
  std::for_each(led.begin(), led.end(), touch);
  const auto touch_free = [&](std::int32_t n) {
    if (!(traits[n] & fixed)) touch(n);
  };
  for (const auto& c : contact->constraints()) {
    touch_free(c.node);
    std::for_each(c.facet.begin(), c.facet.end(), touch_free);
  }
  std::sort(touched.begin(), touched.end());
}

/// v* = (m v + dt f) / (m + dt drag m0): drag implicit, on the unscaled mass m0.
[[gnu::always_inline]] inline Vec3 Explicit::Impl::predicted_velocity(std::size_t i) const {
  Vec3 f = internal_force(i);
  if (traits[i] & loaded) f += external_force[i];
  if (traits[i] & tethered) f += tether_force(i);
  if (!(traits[i] & held)) return carry[i] * state.v[i] + pull[i] * f;
  const Vec3 momentum = masses.scaled[i] * state.v[i] + dt * f;
  const Vec3& blocked = inverse_mass_blocked[i];
  return inverse_mass[i].cwiseProduct(momentum) - blocked.dot(momentum) * blocked;
}

/// Velocities without contact; what nothing touches is moved as well.
void Explicit::Impl::predict() {
  const Stopwatch watch(seconds[nodes]);
  parallel::for_chunks(state.x.size(), node_chunk, [&](std::size_t b, std::size_t e, std::size_t c) {
    NodeSums s;
    for (std::size_t i = b; i < e; ++i) {
      if ((traits[i] & (fixed | touching)) == fixed) continue;
      const Vec3 before = state.v[i], free = traits[i] & fixed ? before : predicted_velocity(i);
      state.v[i] = free;
      if (traits[i] & touching) {
        v_before[i] = before, v_free[i] = free;
      } else {
        move_node(i, before, free, s);
      }
    }
    sums[c] = s;
  });
}

/// What acts on a tied node acts on its facet.
void Explicit::Impl::carry_ties() {
  for (const auto& tie : model.ties) {
    const auto i = std::size_t(tie.node);
    const Vec3 f = internal_force(i) + external_force[i] + tether_force(i);
    for (int k = 0; k < 3; ++k) {
      const auto n = tie.facet[k];
      const Vec3 impulse = dt * tie.weights[k] * f;
      state.v[n] +=
          inverse_mass[n].cwiseProduct(impulse) - inverse_mass_blocked[n].dot(impulse) * inverse_mass_blocked[n];
      v_free[n] = state.v[n];
    }
  }
}

/// Imposed velocities, v = (x(t + dt) - x)/dt, and the work of what imposes them: r = m dv/dt + drag m0 v - f.
void Explicit::Impl::impose_motions() {
  const double t = state.time + dt * scale;
  for (const auto& motion : model.motions) {
    for (const auto n : motion.nodes) {
      const Vec3 wanted = (fem::placed(motion, model.mesh.nodes[n], t) - state.x[n]) / dt;
      const Vec3 f = internal_force(std::size_t(n)) + external_force[n] + tether_force(std::size_t(n));
      Vec3& v = state.v[n];
      for (int k = 0; k < 3; ++k) {
        if (!((motion.axes >> k) & 1)) continue;
        v[k] = v_free[n][k] = wanted[k];
        const double r =
            masses.scaled[n] * (v[k] - v_before[n][k]) / dt + options.drag / scale * masses.unscaled[n] * v[k] - f[k];
        work.external += dt * r * 0.5 * (v[k] + v_before[n][k]);
      }
    }
  }
}

void Explicit::Impl::follow_ties() {
  for (const auto& tie : model.ties) {
    Vec3 v = Vec3::Zero();
    for (int k = 0; k < 3; ++k) v += tie.weights[k] * state.v[tie.facet[k]];
    state.v[tie.node] = v_free[tie.node] = v;
  }
}

void Explicit::Impl::solve_contact() {
  const Stopwatch watch(seconds[contact_solve]);
  turn_hinges_freely();
  contact->solve(state.v, state.hinge_rate);
  contact->part_penetrated(state.v, lift);
  for (std::size_t h = 0; h < model.hinges.size(); ++h) {
    const double mean = 0.5 * (state.hinge_rate[h] + rate_before[h]);
    work.contact += dragged_inertia(model.hinges[h]) * (state.hinge_rate[h] - rate_free[h]) * mean;
    work.damping += dt * model.hinges[h].damping / scale * state.hinge_rate[h] * mean;
  }
  if (state.step % sample_contact_every == 0) {
    ++contact_samples;
    for (const auto& c : contact->constraints()) {
      const Vec3 j = c.impulse * c.n + c.slip;
      contact_impulse[c.node] += j;
      for (int k = 0; k < 3; ++k) contact_impulse[c.facet[k]] -= c.w[k] * j;
    }
  }
}

/// I w' = -k a - c w, implicit in both: stable for any stiffness and damping.
void Explicit::Impl::turn_hinges_freely() {
  for (std::size_t h = 0; h < model.hinges.size(); ++h) {
    const auto& hinge = model.hinges[h];
    rate_before[h] = state.hinge_rate[h];
    rate_free[h] = state.hinge_rate[h] =
        (hinge.inertia * rate_before[h] - dt * hinge.stiffness * state.hinge_angle[h]) / dragged_inertia(hinge);
  }
}

/// Every force works along the mean velocity of the step, contact included; so the works add up to the change of
/// kinetic energy. Measured before the contact solve, a resting contact would seem to take what the load only seems
/// to give.
[[gnu::always_inline]] inline void Explicit::Impl::book_work(std::size_t i, const Vec3& before, NodeSums& s) const {
  const Vec3 mean = 0.5 * (state.v[i] + before);
  s.damping += drag_mass[i] * state.v[i].dot(mean);
  if (traits[i] & loaded) s.external += dt * external_force[i].dot(mean);
}

[[gnu::always_inline]] inline void Explicit::Impl::move_node(std::size_t i, const Vec3& before, const Vec3& free,
                                                             NodeSums& s) {
  const double cap2 = options.max_node_speed * options.max_node_speed;
  Vec3& v = state.v[i];
  double v2 = v.squaredNorm();
  if (v2 > cap2) v *= std::sqrt(cap2 / v2), v2 = cap2;
  book_work(i, before, s);
  if (v != free) s.contact += dragged_mass(i) * (v - free).dot(0.5 * (v + before));  // the cap's, too
  s.max_speed2 = std::max(s.max_speed2, v2);
  state.x[i] += dt * v;
}

/// A displacement without momentum. What it does against the forces on the node (all of them: m dv + dt drag m0 v*) is
/// contact's work.
[[gnu::always_inline]] inline void Explicit::Impl::lift_node(std::size_t i, NodeSums& s) {
  Vec3& u = lift[i];
  if (u.isZero(0)) return;
  s.contact -= u.dot(dragged_mass(i) * v_free[i] - masses.scaled[i] * v_before[i]);
  if (traits[i] & loaded) s.external += dt * external_force[i].dot(u);
  s.max_speed2 = std::max(s.max_speed2, (state.v[i] + u).squaredNorm());
  state.x[i] += dt * u;
  u.setZero();
}

void Explicit::Impl::move_touched() {
  const Stopwatch watch(seconds[nodes]);
  parallel::for_chunks(touched.size(), node_chunk, [&](std::size_t b, std::size_t e, std::size_t c) {
    NodeSums s;
    for (std::size_t k = b; k < e; ++k) {
      const auto i = std::size_t(touched[k]);
      move_node(i, v_before[i], v_free[i], s);
      lift_node(i, s);
    }
    touched_sums[c] = s;
  });
  turn_hinges();
  double speed2 = hinge_speed * hinge_speed;
  const auto add = [&](const NodeSums& s) {
    work.external += s.external, work.damping += s.damping, work.contact += s.contact;
    speed2 = std::max(speed2, s.max_speed2);
  };
  std::for_each(sums.begin(), sums.end(), add);
  std::for_each_n(touched_sums.begin(), (touched.size() + node_chunk - 1) / node_chunk, add);
  max_speed = std::sqrt(speed2);
  contact->moved(dt * max_speed);
  ++state.step;
  state.time += dt * scale;
}

void Explicit::Impl::turn_hinges() {
  hinge_speed = 0;
  for (std::size_t h = 0; h < model.hinges.size(); ++h) {
    const auto& hinge = model.hinges[h];
    state.hinge_angle[h] += dt * state.hinge_rate[h];
    const Eigen::AngleAxisd turn(state.hinge_angle[h], hinge.axis);
    for (const auto n : hinge.nodes) {
      const Vec3 r = turn * (model.mesh.nodes[n] - hinge.point);
      state.x[n] = hinge.point + r;
      hinge_speed = std::max(hinge_speed, r.norm() * std::abs(state.hinge_rate[h]));
    }
  }
}

void Explicit::Impl::step() {
  const double t = state.time;
  if (rest_length.active() && t - retracted_at >= retraction_every) retract(t);
  if (loads_due || state.step % loads_every == 0) apply_loads(t);
  loads_due = false;
  element_forces();
  check();
  if (pace.varies() && state.step % judge_pace_every == 0) judge_pace();
  find_contacts();
  predict();
  carry_ties();
  impose_motions();
  solve_contact();
  follow_ties();
  move_touched();
}

void Explicit::Impl::check() {
  for (const auto& r : reports) {
    if (r.inverted == 0 && std::isfinite(r.min_J)) continue;
    const auto e = r.worst_element;
    const std::string organ = e < 0 ? "?" : model.regions[model.mesh.labels[e]].name;
    const auto finite = [&](auto n) { return state.x[n].allFinite(); };
    const bool inversion = e >= 0 && std::all_of(model.mesh.tets[e].begin(), model.mesh.tets[e].end(), finite);
    const std::string what =
        fmt::format("{} of element {} ({}) at step {}, {:.1f} s of labour",
                    inversion ? "inversion" : "non-finite state", e, organ, state.step, state.time);
    state = good, work = good_work;
    restore_private();
    throw NumericalFailure(what + "; the state kept is that of " + fmt::format("{:.1f} s", state.time));
  }
}

}  // namespace carus::solve
