// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "carus/fem/model.hpp"
#include "carus/solve/explicit.hpp"

namespace carus::solve {

/// One Newton iteration, for those who watch the convergence.
struct NewtonIteration {
  double time, dt;  ///< [s of labour]
  int iteration;
  double length;        ///< [m] that the correction would move a node at most
  double clear, taken;  ///< share of it that is free of collisions, and that was taken
  double slope;         ///< [J] of the potential along it
  int linear;           ///< iterations of the conjugate gradients
};

/// Numerics of the implicit solver. All are declared in the scenario and reported with the result.
struct ImplicitOptions {
  double time_step = 4.8;          ///< [s of labour] longest step
  double least_time_step = 0.01;   ///< [s of labour] below it the solver gives up
  double step_tolerance = 0;       ///< [m] error of a step, estimated, at most; 0: steps shorten for convergence only
  double newton_tolerance = 2e-5;  ///< [m] a step is solved when the last correction moved no node further
  int max_iterations = 60;         ///< Newton iterations of a step
  double linear_tolerance = 0.1;   ///< PCG: reduction of the residual in each Newton iteration
  int max_linear_iterations = 5000;
  double drag = 2e4;               ///< [1/s of labour] force = -drag * m * v_labour; 0: none
  bool inertia = false;            ///< false: static or quasi-static
  double barrier_distance = 3e-4;  ///< [m] surfaces nearer than this repel
  double barrier_pressure = 5e4;   ///< [Pa] scale of the repulsion: what they feel at about half of that distance
  double friction_speed = 1e-4;    ///< [m/s of labour] slip above which friction is full
  int threads = 0;                 ///< 0: all
  std::function<void(const NewtonIteration&)> watch;  ///< may be empty
};

/// What the solver has had to do since its construction.
struct ImplicitCounts {
  std::int64_t steps = 0, rejected = 0, newton = 0, linear = 0, line_search = 0;
};

/// Backward Euler on an incremental potential, minimised by projected Newton with inexact PCG. With x_n the last state,
/// a step minimises
///
///     E(x) + B(x) + drag M0 |x - x_n|^2/(2 dt) + M0 |x - x_n - dt v_n|^2/(2 dt^2) - (work of the loads),
///
/// E elastic, tethers and hinges, B the contact barrier with lagged friction. Follower pressures enter by their forces;
/// the line search takes their work along its path. No accepted step holds an inverted element or surfaces that cut
/// each other: the line search never lets them, and contact::intersections proves it of each step. Results do not
/// depend on the number of threads.
class Implicit {
 public:
  Implicit(const fem::Model& model, const ImplicitOptions& options);
  ~Implicit();
  /// Advance to `time` [s of labour] in steps of at most options.time_step that end there, or throw NumericalFailure
  /// with the reason; the state stays the last good one.
  void advance_to(double time);
  [[nodiscard]] const fem::State& state() const;
  void restore(const fem::State& state);  ///< continues to bit-identical results
  [[nodiscard]] Observables observe() const;
  [[nodiscard]] ImplicitCounts counts() const;
  /// Least distance of each contact pair [m], within `reach`; infinite where there is none.
  [[nodiscard]] std::vector<double> least_distances(double reach) const;
  /// Seconds spent by stage.
  [[nodiscard]] std::vector<std::pair<std::string, double>> timings() const;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace carus::solve
