// SPDX-License-Identifier: Apache-2.0
#include "carus/solve/explicit.hpp"

#include <algorithm>
#include <chrono>
#include <cmath>

#include "carus/contact/contact.hpp"
#include "carus/core/error.hpp"
#include "carus/core/parallel.hpp"
#include "carus/fem/constraints.hpp"
#include "carus/fem/element_block.hpp"
#include "carus/fem/nodal_pressure.hpp"
#include "carus/fem/pressure.hpp"
#include "carus/fem/retraction.hpp"
#include "carus/solve/energy.hpp"
#include "carus/solve/mass.hpp"

namespace carus::solve {

namespace {

constexpr int block_count = 16;  // more than any machine we expect has cores for one birth; part of the result
constexpr std::size_t node_chunk = 1024;
constexpr int loads_every = 4;  // steps: surfaces turn slowly against the step
constexpr int sample_contact_every =
    7;  // steps, for the mean contact force between two observations; no multiple of another rhythm

enum Stage { elements, contact_search, contact_solve, nodes, loads, stage_count };
constexpr const char* stage_names[stage_count] = {"elements", "contact search", "contact solve", "nodes", "loads"};

class Stopwatch {
 public:
  explicit Stopwatch(double& sum) : sum_(sum), start_(std::chrono::steady_clock::now()) {}
  ~Stopwatch() { sum_ += std::chrono::duration<double>(std::chrono::steady_clock::now() - start_).count(); }
  Stopwatch(const Stopwatch&) = delete;
  Stopwatch& operator=(const Stopwatch&) = delete;

 private:
  double& sum_;
  std::chrono::steady_clock::time_point start_;
};

struct Work {
  double external = 0, contact = 0, damping = 0, active = 0;
};

/// What a pass over a chunk of nodes leaves behind.
struct NodeSums {
  double external = 0, damping = 0, contact = 0, max_speed2 = 0;
};

/// What a node's step needs to know of it.
enum Trait : std::uint8_t {
  fixed = 1,     ///< of rigid parts: does not move, or with a hinge
  held = 2,      ///< cannot move along some directions
  loaded = 4,    ///< an external force acts on it
  touching = 8,  ///< in a constraint of contact, or led: moves after the contact solve only
};

}  // namespace

struct Explicit::Impl {
  const fem::Model& model;
  ExplicitOptions options;
  parallel::Threads threads;
  double scale;  // labour time over pseudo time
  double dt;
  std::int64_t total_steps;
  Masses masses;
  // Of the mass with its implicit drag, m + dt drag m0: M^-1 = D - b b^T. D per axis, 0 where blocked; b = t/sqrt(m)
  // takes away a blocked direction t, 0 where there is none.
  std::vector<Vec3> inverse_mass, inverse_mass_blocked;
  std::vector<std::uint8_t> constrained;       // per node, Blocked bits
  std::vector<std::vector<double>> body_mass;  // per body force
  std::vector<fem::Block> blocks;
  std::vector<fem::KernelMaterial> materials;
  std::vector<std::int32_t> share_begin;  // node -> the forces of its copies in the blocks
  std::vector<const fem::Float4*> shares;
  std::unique_ptr<fem::NodalPressure> nodal_pressure;
  fem::RestLength rest_length;
  std::vector<std::array<std::int32_t, 3>> retracting;  // per retracting element: block, batch, lane
  std::vector<Mat3> retracting_inverse_edges;
  std::unique_ptr<contact::Contact> contact;
  fem::State state, good;
  Work work, good_work;
  std::vector<Vec3> external_force, contact_impulse;
  std::vector<std::uint8_t> traits;            // per node, Trait bits
  std::vector<double> carry, pull;             // per free node: v* = carry v + pull f, drag included
  std::vector<double> drag_mass;               // per node: what drag takes from momentum in a step, over velocity [kg]
  std::vector<std::int32_t> led;       // nodes that ties or imposed motions move
  std::vector<std::int32_t> touched;   // those, and nodes in constraints of contact
  std::vector<Vec3> v_before, v_free;          // of those: at the start of a step, and predicted without contact
  std::vector<double> rate_before, rate_free;  // of the hinges
  int contact_samples = 0;
  std::vector<NodeSums> sums, touched_sums;  // per chunk
  std::vector<fem::KernelReport> reports;
  std::vector<double> pressures;
  double max_speed = 0, hinge_speed = 0;
  int retraction_every = 1;
  bool loads_due = true;  // after every stop, so that a resumed run does what an uninterrupted one does
  double seconds[stage_count] = {};

  Impl(const fem::Model& m, const ExplicitOptions& o)
      : model(m), options(o), threads(o.threads), scale(o.labour_duration / o.pseudo_duration), rest_length(m) {
    total_steps = std::int64_t(std::ceil(o.pseudo_duration / o.time_step));
    dt = o.pseudo_duration / double(total_steps);
    masses = scaled_masses(model, dt, o.safety);
    for (const auto& b : model.body_forces) body_mass.push_back(fem::lumped_mass(model, b.regions));
    move_mass_of_ties();
    for (const double m0 : masses.unscaled) drag_mass.push_back(dt * o.drag / scale * m0);
    start_state();
    make_inverse_masses();
    make_elements();
    make_contact();
    // The rest length moves with time constants of seconds of labour: every half second is often enough.
    retraction_every = std::max(1, int(0.5 / (dt * scale)));
    keep();
  }

  void start_state() {
    state.x = model.mesh.nodes;
    state.v.assign(state.x.size(), Vec3::Zero());
    state.hinge_angle.assign(model.hinges.size(), 0.0);
    state.hinge_rate.assign(model.hinges.size(), 0.0);
    external_force.assign(state.x.size(), Vec3::Zero());
    contact_impulse.assign(state.x.size(), Vec3::Zero());
    v_before = v_free = state.v;
    rate_before = rate_free = state.hinge_rate;
    sums.resize((state.x.size() + node_chunk - 1) / node_chunk);
    touched_sums.resize(sums.size());
    pressures.assign(model.pressures.size(), 0.0);
  }

  /// What an impulse meets within a step. Contact must see it too: with the bare mass, a resting contact would carry
  /// 1/(1 + dt drag) of the load.
  double dragged_mass(std::size_t i) const { return masses.scaled[i] + drag_mass[i]; }
  double dragged_inertia(const fem::Hinge& h) const {
    return h.inertia + dt * h.damping / scale + dt * dt * h.stiffness;
  }

  /// T^T M T of x_s = sum w_k x_k, its rows summed: momentum is exact, and the critical step only grows.
  void move_mass_of_ties() {
    for (const auto& tie : model.ties) {
      for (auto* m : {&masses.scaled, &masses.unscaled}) {
        for (int k = 0; k < 3; ++k) (*m)[tie.facet[k]] += tie.weights[k] * (*m)[tie.node];
        (*m)[tie.node] = 0;
      }
    }
  }

  void make_inverse_masses() {
    constrained = fem::constrained_axes(model);
    inverse_mass.assign(state.x.size(), Vec3::Zero());
    inverse_mass_blocked.assign(state.x.size(), Vec3::Zero());
    for (std::size_t i = 0; i < inverse_mass.size(); ++i) {
      if (masses.scaled[i] <= 0) continue;  // nodes of rigid parts only
      for (int k = 0; k < 3; ++k) inverse_mass[i][k] = (constrained[i] >> k) & 1 ? 0 : 1 / dragged_mass(i);
      if (!model.blocked_direction.empty() && constrained[i] == fem::Blocked::none)
        inverse_mass_blocked[i] = model.blocked_direction[i] / std::sqrt(dragged_mass(i));
    }
    for (const auto& h : model.hinges) {
      for (const auto n : h.nodes) inverse_mass[n].setZero(), inverse_mass_blocked[n].setZero();
    }
    describe_nodes();
  }

  void describe_nodes() {
    const std::size_t n = state.x.size();
    traits.assign(n, 0), carry.assign(n, 0), pull.assign(n, 0);
    for (std::size_t i = 0; i < n; ++i) {
      if (inverse_mass[i].isZero()) {
        traits[i] = fixed;
        continue;
      }
      carry[i] = masses.scaled[i] / dragged_mass(i), pull[i] = dt / dragged_mass(i);
      if (!inverse_mass_blocked[i].isZero() || inverse_mass[i].minCoeff() == 0) traits[i] = held;
    }
    for (const auto& load : model.pressures) {
      for (const auto& t : load.surface)
        for (const auto node : t) traits[node] |= loaded;
    }
    for (const auto& t : model.tethers) traits[t.node] |= loaded;
    if (!model.body_forces.empty())
      for (auto& t : traits) t |= loaded;
    for (const auto& motion : model.motions) led.insert(led.end(), motion.nodes.begin(), motion.nodes.end());
    for (const auto& tie : model.ties) {
      led.push_back(tie.node);
      led.insert(led.end(), tie.facet.begin(), tie.facet.end());
    }
  }

  void make_elements() {
    blocks = fem::make_blocks(model, block_count);
    reports.resize(blocks.size());
    nodal_pressure = std::make_unique<fem::NodalPressure>(model, blocks);
    for (const auto& r : model.regions) materials.push_back(kernel_material(r, dt * scale));
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

  void find_retracting() {
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

  void make_contact() {
    std::vector<contact::Surface> surfaces;
    for (const auto& s : model.contact_surfaces) surfaces.emplace_back(s.name, s.triangles, model.mesh.nodes);
    std::vector<contact::Pair> pairs;
    for (const auto& p : model.contact_pairs) pairs.push_back({p.a, p.b, p.friction});
    std::vector<std::int16_t> hinge_of(state.x.size(), -1);
    std::vector<contact::HingeBody> hinges;
    for (std::size_t h = 0; h < model.hinges.size(); ++h) {
      for (const auto n : model.hinges[h].nodes) hinge_of[n] = std::int16_t(h);
      hinges.push_back({model.hinges[h].point, model.hinges[h].axis, 1 / dragged_inertia(model.hinges[h])});
    }
    contact::Options o;
    o.sweeps = options.contact_sweeps;
    o.correction_speed = options.contact_correction;
    o.reach = 2 * options.contact_search;
    contact = std::make_unique<contact::Contact>(std::move(surfaces), std::move(pairs), model.mesh.nodes, inverse_mass,
                                                 inverse_mass_blocked, std::move(hinge_of), std::move(hinges), o);
  }

  // ---- one step, in the order of execution ----

  void apply_loads(double t) {
    const Stopwatch watch(seconds[loads]);
    std::fill(external_force.begin(), external_force.end(), Vec3::Zero());
    for (std::size_t l = 0; l < model.pressures.size(); ++l) {
      pressures[l] = model.pressures[l].pressure(t);
      if (pressures[l] != 0) fem::add_pressure_forces(model.pressures[l], pressures[l], state.x, external_force);
    }
    for (const auto& tether : model.tethers) {
      const double out = tether.direction.dot(state.x[tether.node] - model.mesh.nodes[tether.node]);
      external_force[tether.node] -= tether.stiffness * out * tether.direction;
    }
    fem::add_body_forces(model, body_mass, t, external_force);
  }

  /// Sets the stress-free shape of the retracting wall: F_e = F F_a^-1 = Ds (B F_a^-1); det F_a = 1 keeps the volume.
  void set_rest_shape() {
    parallel::for_chunks(retracting.size(), 512, [&](std::size_t b, std::size_t e, std::size_t) {
      for (std::size_t i = b; i < e; ++i) {
        const auto [block, batch, lane] = retracting[i];
        const Mat3 B = retracting_inverse_edges[i] * inverse_active_strain(model.retraction, i, rest_length.of(i));
        for (int k = 0; k < 9; ++k) blocks[block].batches[batch].B[k][lane] = float(B(k / 3, k % 3));
      }
    });
  }

  void retract(double t) {
    const Stopwatch watch(seconds[loads]);
    const auto before = rest_length.rings();
    rest_length.advance(state.x, t, retraction_every * dt * scale);
    if (rest_length.rings() == before) return;
    const double energy = retracting_energy();
    set_rest_shape();
    work.active += retracting_energy() - energy;
  }

  double retracting_energy() const {
    return parallel::sum_chunks(retracting.size(), 512, [&](std::size_t b, std::size_t e) {
      double sum = 0;
      for (std::size_t i = b; i < e; ++i) {
        const auto [block, batch, lane] = retracting[i];
        sum += element_energy(model, blocks[block].batches[batch], lane, state.x);
      }
      return sum;
    });
  }

  void gather(fem::Block& b) const {
    for (std::size_t l = 0; l < b.nodes.size(); ++l) {
      const Vec3& p = state.x[b.nodes[l]];
      b.x[l] = {{float(p.x()), float(p.y()), float(p.z()), 0.f}};
    }
  }

  void element_forces() {
    const Stopwatch watch(seconds[elements]);
    const auto& kernel = fem::kernel();
    parallel::for_chunks(blocks.size(), 1, [&](std::size_t i, std::size_t, std::size_t) {
      gather(blocks[i]);
      nodal_pressure->add_volumes(blocks[i]);
    });
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

  // Nodes that nothing touches move at once; the others wait for the contact solve in between.

  void find_contacts() {
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

  Vec3 internal_force(std::size_t i) const {
    Vec3 f = Vec3::Zero();
    for (std::int32_t q = share_begin[i]; q < share_begin[i + 1]; ++q) {
      const float* g = shares[std::size_t(q)]->v;
      f += Vec3(g[0], g[1], g[2]);
    }
    return f;
  }

  /// v* = (m v + dt f) / (m + dt drag m0): drag implicit, on the unscaled mass m0.
  Vec3 predicted_velocity(std::size_t i) const {
    Vec3 f = internal_force(i);
    if (traits[i] & loaded) f += external_force[i];
    if (!(traits[i] & held)) return carry[i] * state.v[i] + pull[i] * f;
    const Vec3 momentum = masses.scaled[i] * state.v[i] + dt * f;
    const Vec3& blocked = inverse_mass_blocked[i];
    return inverse_mass[i].cwiseProduct(momentum) - blocked.dot(momentum) * blocked;
  }

  /// Velocities without contact; what nothing touches is moved as well.
  void predict() {
    const Stopwatch watch(seconds[nodes]);
    parallel::for_chunks(state.x.size(), node_chunk, [&](std::size_t b, std::size_t e, std::size_t c) {
      NodeSums& s = sums[c] = {};
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
    });
  }

  /// What acts on a tied node acts on its facet.
  void carry_ties() {
    for (const auto& tie : model.ties) {
      const Vec3 f = internal_force(std::size_t(tie.node)) + external_force[tie.node];
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
  void impose_motions() {
    const double t = double(state.step + 1) * dt * scale;
    for (const auto& motion : model.motions) {
      for (const auto n : motion.nodes) {
        const Vec3 wanted = (fem::placed(motion, model.mesh.nodes[n], t) - state.x[n]) / dt;
        const Vec3 f = internal_force(std::size_t(n)) + external_force[n];
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

  void follow_ties() {
    for (const auto& tie : model.ties) {
      Vec3 v = Vec3::Zero();
      for (int k = 0; k < 3; ++k) v += tie.weights[k] * state.v[tie.facet[k]];
      state.v[tie.node] = v_free[tie.node] = v;
    }
  }

  /// Static: inertia is left out.
  std::vector<Vec3> reactions(const std::vector<Vec3>& contact_force) const {
    std::vector<Vec3> f(state.x.size());
    for (std::size_t i = 0; i < f.size(); ++i) f[i] = internal_force(i) + external_force[i] + contact_force[i];
    for (const auto& tie : model.ties) {
      for (int k = 0; k < 3; ++k) f[tie.facet[k]] += tie.weights[k] * f[tie.node];
      f[tie.node].setZero();
    }
    for (std::size_t i = 0; i < f.size(); ++i) {
      for (int k = 0; k < 3; ++k) f[i][k] = (constrained[i] >> k) & 1 ? -f[i][k] : 0;
    }
    return f;
  }

  void solve_contact() {
    const Stopwatch watch(seconds[contact_solve]);
    turn_hinges_freely();
    contact->solve(state.v, state.hinge_rate);
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

  double hinge_kinetic() const {
    double sum = 0;
    for (std::size_t h = 0; h < model.hinges.size(); ++h)
      sum += 0.5 * model.hinges[h].inertia * state.hinge_rate[h] * state.hinge_rate[h];
    return sum;
  }

  /// I w' = -k a - c w, implicit in both: stable for any stiffness and damping.
  void turn_hinges_freely() {
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
  void book_work(std::size_t i, const Vec3& before, NodeSums& s) const {
    const Vec3 mean = 0.5 * (state.v[i] + before);
    s.damping += drag_mass[i] * state.v[i].dot(mean);
    if (traits[i] & loaded) s.external += dt * external_force[i].dot(mean);
  }

  void move_node(std::size_t i, const Vec3& before, const Vec3& free, NodeSums& s) {
    const double cap2 = options.max_node_speed * options.max_node_speed;
    Vec3& v = state.v[i];
    double v2 = v.squaredNorm();
    if (v2 > cap2) v *= std::sqrt(cap2 / v2), v2 = cap2;
    book_work(i, before, s);
    if (v != free) s.contact += dragged_mass(i) * (v - free).dot(0.5 * (v + before));  // the cap's, too
    s.max_speed2 = std::max(s.max_speed2, v2);
    state.x[i] += dt * v;
  }

  void move_touched() {
    const Stopwatch watch(seconds[nodes]);
    parallel::for_chunks(touched.size(), node_chunk, [&](std::size_t b, std::size_t e, std::size_t c) {
      NodeSums& s = touched_sums[c] = {};
      for (std::size_t k = b; k < e; ++k) {
        const auto i = std::size_t(touched[k]);
        move_node(i, v_before[i], v_free[i], s);
      }
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
    state.time = double(state.step) * dt * scale;
  }

  void turn_hinges() {
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

  void step() {
    const double t = double(state.step) * dt * scale;
    if (rest_length.active() && state.step % retraction_every == 0) retract(t);
    if (loads_due || state.step % loads_every == 0) apply_loads(t);
    loads_due = false;
    element_forces();
    check();
    find_contacts();
    predict();
    carry_ties();
    impose_motions();
    solve_contact();
    follow_ties();
    move_touched();
  }

  void check() {
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

  // ---- state that a checkpoint carries ----

  void keep() {
    state.rest_length = rest_length.rings();
    state.internal = {work.external, work.contact, work.damping, work.active, max_speed};
    contact->pause(state.x);
    const auto partners = contact->save();
    state.internal.insert(state.internal.end(), partners.begin(), partners.end());
    for (const auto& b : blocks) {
      for (const auto& h : b.history) {
        for (const auto& row : h.s_iso) state.internal.insert(state.internal.end(), row, row + fem::lanes);
        for (const auto& row : h.h) state.internal.insert(state.internal.end(), row, row + fem::lanes);
      }
    }
    good = state, good_work = work;
    loads_due = true;
  }

  void restore_private() {
    const double* p = state.internal.data();
    work = {p[0], p[1], p[2], p[3]}, max_speed = p[4];
    p += 5;
    contact->load(p, state.x);
    p += contact->save().size();
    for (auto& b : blocks) {
      for (auto& h : b.history) {
        for (auto& row : h.s_iso)
          for (float& v : row) v = float(*p++);
        for (auto& row : h.h)
          for (float& v : row) v = float(*p++);
      }
    }
    rest_length.rings() = state.rest_length;
    set_rest_shape();
    loads_due = true;
  }
};

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
  const auto last = std::min(s.total_steps, std::int64_t(std::llround(time / (s.dt * s.scale))));
  s.contact_samples = 0;
  std::fill(s.contact_impulse.begin(), s.contact_impulse.end(), Vec3::Zero());
  while (s.state.step < last) s.step();
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
  for (std::size_t i = 0; i < s.state.v.size(); ++i) o.kinetic += 0.5 * s.masses.scaled[i] * s.state.v[i].squaredNorm();
  o.kinetic += s.hinge_kinetic();
  o.internal = stored_energy(s.model, s.blocks, s.state) + s.nodal_pressure->energy();
  // The tethers are among the external forces, but what they take is stored.
  o.external_work = s.work.external + tether_energy(s.model, s.state), o.contact_work = s.work.contact,
  o.damping_work = s.work.damping;
  o.active_work = s.work.active;
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
  for (int k = 0; k < stage_count; ++k) out.emplace_back(stage_names[k], impl_->seconds[k]);
  return out;
}

}  // namespace carus::solve
