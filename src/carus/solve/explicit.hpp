// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>
#include <memory>
#include <string>

#include "carus/fem/model.hpp"
#include "carus/solve/pace.hpp"

namespace carus::solve {

/// Numerics of the explicit solver. All are declared in the scenario and reported with the result.
struct ExplicitOptions {
  double labour_duration = 1920;  ///< [s]
  double pseudo_duration = 2;     ///< [s] that the labour is mapped to at pace 1 (time scaling = labour/pseudo)
  PaceOptions pace;
  double time_step = 2.5e-5;   ///< [s of pseudo-time] target; elements that need less get mass added
  double safety = 0.5;         ///< fraction of the critical step
  double drag = 2e4;           ///< [1/s of labour] force = -drag * m * v_labour, on unscaled mass
  double max_node_speed = 10;  ///< [m/s of pseudo-time] cap after the contact solve
  int contact_sweeps = 3;
  double contact_search = 0.004;  ///< [m] distance inside which a pair is followed
  double contact_correction = 1;  ///< [m/s of pseudo-time] at most, outward, where penetrated
  int threads = 0;                ///< 0: all
};

/// What a step knows beyond the state, for measurements and the energy balance.
struct Observables {
  std::vector<double> pressures;  ///< [Pa], one per Model::pressures
  double kinetic = 0;             ///< [J]
  double internal = 0;            ///< elastic, by the instantaneous stiffness [J]
  double external_work = 0, contact_work = 0, damping_work = 0, active_work = 0;  ///< [J] since the start
  double relaxation_work = 0;  ///< since the start: what `internal` counts and relaxation did not let be put in [J]
  double least_gap = 0;        ///< [m] over all contacts, negative is penetration
  double min_J = 1;
  int inverted = 0;
  std::vector<Vec3> contact_force;  ///< per node [N], the latest step's impulses over dt
  std::vector<Vec3> reaction;       ///< per node [N], what holds it on its constrained axes, inertia left out; else 0
  std::vector<double> hinge_angle;  ///< [rad]
  double rest_length_mean = 1;      ///< retraction
};

/// Stable step, masses and the organ that limits them.
struct StepReport {
  double time_step;               ///< [s of pseudo-time]
  double unscaled_critical_step;  ///< [s]
  std::string limiting_region;
  double mass_scaled_fraction;  ///< added mass over model mass
};

/// Total-Lagrangian central differences with impulse contact. Results do not depend on the number of threads.
class Explicit {
 public:
  Explicit(const fem::Model& model, const ExplicitOptions& options);
  ~Explicit();
  [[nodiscard]] StepReport step_report() const;
  [[nodiscard]] std::int64_t steps() const;  ///< of the whole labour at pace 1
  /// Advance to `time` [s of labour], or throw NumericalFailure with the organ and element; the state stays the last
  /// good one.
  void advance_to(double time);
  [[nodiscard]] const fem::State& state() const;
  void restore(const fem::State& state);  ///< continues to bit-identical results
  [[nodiscard]] Observables observe() const;
  /// Seconds spent by stage: elements, contact search, contact solve, nodes, loads.
  [[nodiscard]] std::vector<std::pair<std::string, double>> timings() const;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace carus::solve
