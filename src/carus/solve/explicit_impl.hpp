// SPDX-License-Identifier: Apache-2.0
// What the parts of the explicit solver share: explicit_setup.cpp makes it, explicit_step.cpp moves it on, explicit.cpp
// shows it to others.
#pragma once

#include <array>

#include "carus/contact/contact.hpp"
#include "carus/core/parallel.hpp"
#include "carus/fem/element_block.hpp"
#include "carus/fem/nodal_pressure.hpp"
#include "carus/fem/retraction.hpp"
#include "carus/solve/explicit.hpp"
#include "carus/solve/mass.hpp"

namespace carus::solve {

struct Explicit::Impl {
  static constexpr std::size_t node_chunk = 1024;
  enum Stage { elements, contact_search, contact_solve, nodes, loads, stage_count };
  static constexpr const char* stage_names[stage_count] = {"elements", "contact search", "contact solve", "nodes",
                                                           "loads"};

  struct Work {
    double external = 0, contact = 0, damping = 0, active = 0;
    double relaxation = 0;  ///< less what relaxation has taken of the stress now, over the strain now
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
    tethered = 16,
  };

  const fem::Model& model;
  ExplicitOptions options;
  parallel::Threads threads;
  Pace pace;
  double mean_scale;  // labour time over pseudo time, at pace 1
  double scale;       // the same, now
  double dt;
  std::int64_t total_steps;
  Masses masses;
  // Of the mass with its implicit drag, m + dt drag m0, which follows the pace: M^-1 = D - b b^T. D per axis, 0 where
  // blocked; b = t/sqrt(m) takes away a blocked direction t, 0 where there is none.
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
  std::vector<std::int32_t> tether_of;         // per node, valid where tethered
  std::vector<Mat3> tethers;                   // per tethered node: sum k d d^T [N/m]
  std::vector<std::uint8_t> traits;            // per node, Trait bits
  std::vector<double> carry, pull;             // per free node: v* = carry v + pull f, drag included
  std::vector<double> drag_mass;               // per node: what drag takes from momentum in a step, over velocity [kg]
  std::vector<std::int32_t> led;               // nodes that ties or imposed motions move
  std::vector<std::int32_t> touched;           // those, and nodes in constraints of contact
  std::vector<Vec3> v_before, v_free;          // of those: at the start of a step, and predicted without contact
  std::vector<Vec3> lift;                      // of those: out of penetrations, in this step alone; else zero
  std::vector<double> rate_before, rate_free;  // of the hinges
  int contact_samples = 0;
  std::vector<NodeSums> sums, touched_sums;  // per chunk
  std::vector<fem::KernelReport> reports;
  double relax_every = 0;  // [s of labour], at most: the least relaxation time in many parts; 0: nothing relaxes
  std::vector<double> relaxation;  // per block, of the last update [J]
  std::vector<double> pressures;
  double max_speed = 0, hinge_speed = 0;
  double relaxed_at = 0;       // [s of labour]
  double retracted_at = 0;     // [s of labour]
  double internal_energy = 0;  // at the last look, for the pace
  bool loads_due = true;       // after every stop, so that a resumed run does what an uninterrupted one does
  double seconds[stage_count] = {};

  Impl(const fem::Model& m, const ExplicitOptions& o);

  // explicit_setup.cpp
  void start_state();
  void move_mass_of_ties();
  void make_inverse_masses();
  void describe_nodes();
  void gather_tethers();
  void make_materials();
  void take_pace();
  [[nodiscard]] std::vector<double> hinge_inverse_inertias() const;
  void make_elements();
  void find_retracting();
  void make_contact();
  /// What an impulse meets within a step. Contact must see it too: with the bare mass, a resting contact would carry
  /// 1/(1 + dt drag) of the load.
  double dragged_mass(std::size_t i) const { return masses.scaled[i] + drag_mass[i]; }
  double dragged_inertia(const fem::Hinge& h) const {
    return h.inertia + dt * h.damping / scale + dt * dt * h.stiffness;
  }

  // explicit_step.cpp, in the order of execution
  void apply_loads(double t);
  void set_rest_shape();
  void retract(double t);
  [[nodiscard]] double retracting_energy() const;
  void gather(fem::Block& b) const;
  double relax(fem::Block& b) const;
  void element_forces();
  [[nodiscard]] bool loads_stand(double span) const;
  void judge_pace();
  void find_contacts();
  [[nodiscard]] Vec3 internal_force(std::size_t i) const {
    Vec3 f = Vec3::Zero();
    for (std::int32_t q = share_begin[i]; q < share_begin[i + 1]; ++q) {
      const float* g = shares[std::size_t(q)]->v;
      f += Vec3(g[0], g[1], g[2]);
    }
    return f;
  }
  /// Of the springs now. They are no load that may be looked up every few steps: a spring that answers late feeds what
  /// swings on it.
  [[nodiscard]] Vec3 tether_force(std::size_t i) const {
    if (!(traits[i] & tethered)) return Vec3::Zero();
    return tethers[std::size_t(tether_of[i])] * (model.mesh.nodes[i] - state.x[i]);
  }
  [[nodiscard]] Vec3 predicted_velocity(std::size_t i) const;
  void predict();
  void carry_ties();
  void impose_motions();
  void follow_ties();
  void solve_contact();
  void turn_hinges_freely();
  void book_work(std::size_t i, const Vec3& before, NodeSums& s) const;
  void move_node(std::size_t i, const Vec3& before, const Vec3& free, NodeSums& s);
  void lift_node(std::size_t i, NodeSums& s);
  void move_touched();
  void turn_hinges();
  void step();
  void check();

  // explicit.cpp
  [[nodiscard]] std::vector<Vec3> reactions(const std::vector<Vec3>& contact_force) const;
  [[nodiscard]] double kinetic() const;
  [[nodiscard]] double stored() const;
  void keep();
  void restore_private();
};

}  // namespace carus::solve
