// SPDX-License-Identifier: Apache-2.0
#include <Eigen/LU>
#include <cmath>

#include "carus/core/stopwatch.hpp"
#include "carus/fem/constraints.hpp"
#include "carus/fem/pressure.hpp"
#include "carus/solve/implicit_impl.hpp"

namespace carus::solve {

std::vector<Vec3> Implicit::Impl::loads_at(const std::vector<Vec3>& at, double t) {
  const Stopwatch watch(seconds[loads]);
  std::vector<Vec3> f(at.size(), Vec3::Zero());
  for (std::size_t l = 0; l < model.pressures.size(); ++l) {
    pressures[l] = model.pressures[l].pressure(t);
    if (pressures[l] != 0) fem::add_pressure_forces(model.pressures[l], pressures[l], at, f);
  }
  fem::add_body_forces(model, body_mass, t, f);
  return f;
}

/// Per mass: of drag and inertia.
double Implicit::Impl::inertia_factor() const {
  return (options.drag > 0 ? options.drag / dt : 0) + (options.inertia ? 1 / (dt * dt) : 0);
}

double Implicit::Impl::hinge_factor(const fem::Hinge& h) const {
  return h.stiffness + h.damping / dt + (options.inertia ? h.inertia / (dt * dt) : 0);
}

double Implicit::Impl::tether_part(const std::vector<Vec3>& at) const {
  double sum = 0;
  for (const auto& t : model.tethers) {
    const double out = t.direction.dot(at[t.node] - model.mesh.nodes[t.node]);
    sum += 0.5 * t.stiffness * out * out;
  }
  return sum;
}

double Implicit::Impl::motion_part(const std::vector<Vec3>& at, const std::vector<double>& turned) const {
  double sum = parallel::sum_chunks(at.size(), unknown_chunk, [&](std::size_t begin, std::size_t end) {
    double part = 0;
    for (std::size_t i = begin; i < end; ++i) {
      const Vec3 d = at[i] - x0[i];
      part += 0.5 * mass[i] * options.drag / dt * d.squaredNorm();
      if (options.inertia) part += 0.5 * mass[i] / (dt * dt) * (d - dt * state.v[i]).squaredNorm();
    }
    return part;
  });
  for (std::size_t h = 0; h < model.hinges.size(); ++h) {
    const auto& hinge = model.hinges[h];
    const double d = turned[h] - angle0[h];
    sum += 0.5 * hinge.stiffness * turned[h] * turned[h] + 0.5 * hinge.damping / dt * d * d;
    if (options.inertia) sum += 0.5 * hinge.inertia * std::pow(d / dt - state.hinge_rate[h], 2);
  }
  return sum;
}

double Implicit::Impl::potential(const std::vector<Vec3>& at, const std::vector<double>& turned) {
  const double free = elastic.energy(at) + tether_part(at) + motion_part(at, turned);
  return std::isfinite(free) ? free + contact.energy(at) + contact.friction_energy(at) : free;
}

/// dE/dx [N] of all that has a potential, per node.
void Implicit::Impl::gradient() {
  const Stopwatch watch(seconds[elements]);
  g.assign(x.size(), Vec3::Zero());
  elastic.add_gradient(x, g);
  for (const auto& t : model.tethers)
    g[t.node] += t.stiffness * t.direction.dot(x[t.node] - model.mesh.nodes[t.node]) * t.direction;
}

void Implicit::Impl::add_contact_gradient() {
  const Stopwatch watch(seconds[contact_forces]);
  contact.add_gradient(x, g);
  contact.add_friction_gradient(x, g);
}

void Implicit::Impl::add_motion_gradient() {
  for (std::size_t i = 0; i < x.size(); ++i) {
    const Vec3 d = x[i] - x0[i];
    g[i] += mass[i] * options.drag / dt * d;
    if (options.inertia) g[i] += mass[i] / (dt * dt) * (d - dt * state.v[i]);
  }
}

double Implicit::Impl::hinge_moment(std::size_t h) const {
  const auto& hinge = model.hinges[h];
  const double d = angle[h] - angle0[h];
  return hinge.stiffness * angle[h] + hinge.damping / dt * d +
         (options.inertia ? hinge.inertia / dt * (d / dt - state.hinge_rate[h]) : 0);
}

void Implicit::Impl::linearise() {
  const Stopwatch watch(seconds[assembly]);
  elastic.linearise(x);
  contact.linearise(x);
  diagonal.resize(x.size());
  elastic.diagonal(diagonal);
  contact.add_diagonal(diagonal);
  const double factor = inertia_factor();
  for (std::size_t i = 0; i < x.size(); ++i) diagonal[i].diagonal().array() += mass[i] * factor;
  for (const auto& t : model.tethers) diagonal[t.node] += t.stiffness * t.direction * t.direction.transpose();
  freedom.reduce_diagonal(diagonal, x, preconditioner);
  for (std::size_t h = 0; h < model.hinges.size(); ++h)
    preconditioner[freedom.nodes() + h](0, 0) += hinge_factor(model.hinges[h]);
  freedom.fill_blocked(preconditioner);
  for (Mat3& m : preconditioner) m = m.inverse().eval();
}

/// y = H u over the nodes.
void Implicit::Impl::multiply_nodes(const std::vector<Vec3>& v, std::vector<Vec3>& y) const {
  elastic.multiply(v, y);
  contact.add_product(v, y);
  const double factor = inertia_factor();
  parallel::for_chunks(v.size(), unknown_chunk, [&](std::size_t begin, std::size_t end, std::size_t) {
    for (std::size_t i = begin; i < end; ++i) y[i] += mass[i] * factor * v[i];
  });
  for (const auto& t : model.tethers) y[t.node] += t.stiffness * t.direction.dot(v[t.node]) * t.direction;
  for (std::size_t l = 0; l < model.pressures.size(); ++l)
    if (pressures[l] != 0) fem::add_pressure_stiffness(model.pressures[l], pressures[l], x, v, y);
}

void Implicit::Impl::multiply(const Unknowns& q, Unknowns& y) const {
  freedom.expand(q, x, expanded);
  multiply_nodes(expanded, product);
  freedom.reduce(product, x, y);
  for (std::size_t h = 0; h < model.hinges.size(); ++h)
    y[freedom.nodes() + h].x() += hinge_factor(model.hinges[h]) * q[freedom.nodes() + h].x();
}

}  // namespace carus::solve
