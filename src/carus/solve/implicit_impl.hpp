// SPDX-License-Identifier: Apache-2.0
// What the parts of the implicit solver share: implicit_potential.cpp is what a step makes smallest, implicit_step.cpp
// how, implicit.cpp shows it to others.
#pragma once

#include "carus/contact/potential.hpp"
#include "carus/core/parallel.hpp"
#include "carus/fem/elastic.hpp"
#include "carus/fem/retraction.hpp"
#include "carus/solve/freedom.hpp"
#include "carus/solve/implicit.hpp"
#include "carus/solve/pcg.hpp"

namespace carus::solve {

struct Implicit::Impl {
  enum Stage { elements, assembly, linear, line_search, contact_forces, collision, loads, proof, stage_count };
  static constexpr const char* stage_names[stage_count] = {
      "elements", "assembly", "linear solve", "line search", "contact forces", "collision detection", "loads", "proof"};

  struct Work {
    double external = 0, contact = 0, damping = 0, active = 0, relaxation = 0;
  };
  /// Why a step did not come about; empty: it did.
  using Refusal = std::string;

  const fem::Model& model;
  ImplicitOptions options;
  parallel::Threads threads;
  Freedom freedom;
  fem::Elastic elastic;
  fem::RestLength rest_length;
  contact::BarrierPotential contact;
  std::vector<double> mass;                    // [kg] per node, lumped
  std::vector<std::vector<double>> body_mass;  // per body force
  fem::State state;
  Work work;
  double step_length;   // [s] that the next step would like
  double growth = 1.5;  // of it, after an accepted step
  std::vector<double> pressures;
  ImplicitCounts counts;
  NewtonIteration last{};
  double seconds[stage_count] = {};

  // Of the step under way.
  double dt = 0, t1 = 0;
  std::vector<Vec3> x0, x, u;
  std::vector<double> angle0, angle;
  std::vector<Vec3> load;  // at x
  std::vector<Vec3> g;
  Unknowns residual, direction;
  std::vector<Mat3> diagonal, preconditioner;
  PcgWork pcg_work;
  mutable std::vector<Vec3> expanded, product;

  Impl(const fem::Model& m, const ImplicitOptions& o);
  static std::vector<std::uint8_t> moving(const Freedom& freedom);
  std::string intersecting(const std::vector<Vec3>& at);

  // implicit_potential.cpp: the potential of a step
  std::vector<Vec3> loads_at(const std::vector<Vec3>& at, double t);
  [[nodiscard]] double inertia_factor() const;
  [[nodiscard]] double hinge_factor(const fem::Hinge& h) const;
  [[nodiscard]] double tether_part(const std::vector<Vec3>& at) const;
  [[nodiscard]] double motion_part(const std::vector<Vec3>& at, const std::vector<double>& turned) const;
  double potential(const std::vector<Vec3>& at, const std::vector<double>& turned);
  void gradient();
  void add_contact_gradient();
  void add_motion_gradient();
  [[nodiscard]] double hinge_moment(std::size_t h) const;

  // and its second derivatives
  void linearise();
  void multiply_nodes(const std::vector<Vec3>& v, std::vector<Vec3>& y) const;
  void multiply(const Unknowns& q, Unknowns& y) const;

  // implicit_step.cpp: Newton's method
  [[nodiscard]] bool imposed_motion(std::vector<Vec3>& out) const;
  void solve_direction(const std::vector<Vec3>* given);
  void move(double a, const std::vector<Vec3>* given, std::vector<Vec3>& to, std::vector<double>& turned) const;
  Refusal search_line(const std::vector<Vec3>* given, double& a);
  double clear_way(const std::vector<Vec3>* given);
  void extrapolate();
  [[nodiscard]] double work_between(const std::vector<Vec3>& next, const std::vector<Vec3>& new_load) const;
  Refusal minimise();

  // and the step around it
  Refusal step(double length);
  bool too_long();
  void accept();
  void advance_to(double time);

  // implicit.cpp: state that a checkpoint carries, what is seen from outside
  static constexpr std::size_t fixed_entries = 6;
  void keep();
  void restore(const fem::State& from);
  Observables observe();
  std::vector<Vec3> reactions();
};

}  // namespace carus::solve
