// SPDX-License-Identifier: Apache-2.0
// Large rotations: a twisted column and a cantilever under its own weight.
#include <algorithm>

#include "carus/verify/closed_forms.hpp"
#include "carus/verify/statics.hpp"
#include "carus/verify/suite.hpp"

namespace carus::verify {
namespace {

constexpr double shear = 20e3;  // [Pa]

struct Torsion {
  double torque, force;  ///< [N m], [N], on the turned end
};

/// A round column, n cells across, whose top turns by `angle` while both ends stay flat.
Torsion twist(int n, double radius, double length, double angle) {
  auto material = soft(material::Law::neo_hooke, shear, 0.499);
  material.average_nodal_pressure = true;
  const auto disk = [&](const Vec3& q) -> Vec3 {
    const Vec3 p(2 * q.x() - 1, 2 * q.y() - 1, 0);
    const double square = p.cwiseAbs().maxCoeff(), circle = p.norm();
    const Vec3 flat = circle > 0 ? Vec3(radius * square / circle * p) : p;
    return flat + Vec3(0, 0, length * q.z());
  };
  auto m = of(mesh::shapes::grid(n, n, int(std::lround(n * length / (2 * radius))), disk), {material});
  block(m, fem::all, [](const Vec3& X) { return on(X.z(), 0); });
  fem::Motion turn;
  turn.nodes = nodes_where(m.mesh, [=](const Vec3& X) { return on(X.z(), length); });
  turn.angle = [angle](double t) { return angle * std::min(1.0, t); };
  m.motions = {turn};
  const auto e = equilibrium(m, 8, radius);
  Torsion out{0, 0};
  for (const auto i : m.motions[0].nodes) {
    out.torque += e.x[i].cross(e.reaction[i]).z();
    out.force += e.reaction[i].z();
  }
  return out;
}

Tip bend(int n, double length, double height, double weight) {
  const auto material = soft(material::Law::neo_hooke, shear, 0.0);
  const int along = int(std::lround(n * length / (2 * height)));
  auto m = of(mesh::shapes::box({0, 0, -height / 2}, {length, height, height}, along, n, n), {material});
  block(m, fem::all, [](const Vec3& X) { return on(X.x(), 0); });
  m.body_forces = {{"weight", {}, [weight](double t) { return Vec3(0, 0, -weight * std::min(1.0, t)); }}};
  const auto e = equilibrium(m, 10, height);
  Vec3 tip = Vec3::Zero();
  const auto nodes = nodes_where(m.mesh, [=](const Vec3& X) { return on(X.x(), length) && on(X.z(), 0); });
  for (const auto i : nodes) tip += e.x[i] / double(nodes.size());
  return {tip.x(), tip.z()};
}

}  // namespace

std::vector<Check> twisted_column() {
  constexpr double a = 0.01, length = 0.03, angle = pi / 2;
  const double psi = angle / length;
  std::vector<double> torque_errors, force_errors;
  Torsion t{0, 0};
  const double torque = pi / 2 * shear * psi * std::pow(a, 4), force = -pi / 4 * shear * psi * psi * std::pow(a, 4);
  for (const int n : {4, 8, 16}) {
    t = twist(n, a, length, angle);
    torque_errors.push_back(std::abs(t.torque - torque)), force_errors.push_back(std::abs(t.force - force));
  }
  // 16 elements across, K/G = 500 against incompressible theory.
  return {{"torque", "N m", "implicit", torque, t.torque, 0.03, 0, observed_order(torque_errors), 1.5},
          {"axial force (Poynting)", "N", "implicit", force, t.force, 0.08, 0, observed_order(force_errors), 1.0}};
}

std::vector<Check> cantilever() {
  constexpr double length = 0.2, height = 0.01, load = 5;  // q L^3/EI
  const double E = 2 * shear, I = std::pow(height, 4) / 12, q = load * E * I / std::pow(length, 3);
  const double weight = q / (1000 * height * height);  // [m/s^2]
  const Tip expected = elastica(length, E * I, q);
  std::vector<double> errors;
  Tip tip{0, 0};
  for (const int n : {2, 4, 8}) {
    tip = bend(n, length, height, weight);
    errors.push_back(std::abs(tip.z - expected.z));
  }
  // Linear elements bend too stiffly: 8 over the height. The beam's own shear is 0.2 %.
  return {{"deflection of the tip", "m", "implicit", expected.z, tip.z, 0.04, 0, observed_order(errors), 1.5},
          {"shortening of the tip", "m", "implicit", length - expected.x, length - tip.x, 0.06}};
}

}  // namespace carus::verify
