// SPDX-License-Identifier: Apache-2.0
// Large rotations: a twisted column and a cantilever under its own weight.
#include <algorithm>

#include "carus/verify/closed_forms.hpp"
#include "carus/verify/statics.hpp"
#include "carus/verify/suite.hpp"

namespace carus::verify {
namespace {

constexpr double shear = 20e3;  // [Pa]

/// A round column, n cells across, whose top turns by `angle` while both ends stay flat.
struct Column {
  static constexpr double radius = 0.01, length = 0.03, angle = pi / 2;
  fem::Model model;
  Column(int n, double ramp) {
    auto material = soft(material::Law::neo_hooke, shear, 0.499);
    material.average_nodal_pressure = true;
    const auto disk = [](const Vec3& q) -> Vec3 {
      const Vec3 p(2 * q.x() - 1, 2 * q.y() - 1, 0);
      const double square = p.cwiseAbs().maxCoeff(), circle = p.norm();
      return (circle > 0 ? Vec3(radius * square / circle * p) : p) + Vec3(0, 0, length * q.z());
    };
    model = of(mesh::shapes::grid(n, n, int(std::lround(n * length / (2 * radius))), disk), {material});
    block(model, fem::all, [](const Vec3& X) { return on(X.z(), 0); });
    fem::Motion turn;
    turn.nodes = nodes_where(model.mesh, [](const Vec3& X) { return on(X.z(), length); });
    turn.angle = [ramp](double t) { return angle * std::min(1.0, t / ramp); };
    model.motions = {turn};
  }
  struct Load {
    double torque, force;  ///< [N m], [N], on the turned end
  };
  [[nodiscard]] Load load(const Equilibrium& e) const {
    Load out{0, 0};
    for (const auto i : model.motions[0].nodes) {
      out.torque += e.x[i].cross(e.reaction[i]).z();
      out.force += e.reaction[i].z();
    }
    return out;
  }
};

/// q L^3/EI = load; the weight rises to its full value at t = ramp.
struct Beam {
  static constexpr double length = 0.2, height = 0.02, load = 5, E = 2 * shear;
  static double inertia() { return std::pow(height, 4) / 12; }
  static double per_length() { return load * E * inertia() / std::pow(length, 3); }
  fem::Model model;
  Beam(int n, double ramp) {
    const int along = int(std::lround(n * length / height));
    model = of(mesh::shapes::box({0, 0, -height / 2}, {length, height, height}, along, n, n),
               {soft(material::Law::neo_hooke, shear, 0.0)});
    block(model, fem::all, [](const Vec3& X) { return on(X.x(), 0); });
    const double weight = per_length() / (1000 * height * height);  // [m/s^2]
    model.body_forces = {{"weight", {}, [=](double t) { return Vec3(0, 0, -weight * std::min(1.0, t / ramp)); }}};
  }
  [[nodiscard]] Tip tip(const Equilibrium& e) const {
    Vec3 x = Vec3::Zero();
    const auto nodes = nodes_where(model.mesh, [](const Vec3& X) { return on(X.x(), length) && on(X.z(), 0); });
    for (const auto i : nodes) x += e.x[i] / double(nodes.size());
    return {x.x(), x.z()};
  }
};

}  // namespace

std::vector<Check> twisted_column() {
  constexpr double a = Column::radius, psi = Column::angle / Column::length, ramp = 0.02;
  const double torque = pi / 2 * shear * psi * std::pow(a, 4), force = -pi / 4 * shear * psi * psi * std::pow(a, 4);
  std::vector<double> torque_errors, force_errors;
  Column::Load t{0, 0}, coarse{0, 0};
  for (const int n : {4, 8, 16}) {
    // The lowest wave of shear turns at pi/L sqrt(G/rho) = 470 rad/s.
    const Column c(n, ramp);
    t = c.load(relaxed(c.model, 2.5 * ramp, 2.4e-5 / n, 700));
    torque_errors.push_back(std::abs(t.torque - torque)), force_errors.push_back(std::abs(t.force - force));
    if (n == 4) coarse = t;
  }
  const Column c(4, 1);
  const auto implicit = c.load(equilibrium(c.model, 8, a));
  // 16 elements across, K/G = 500 against incompressible theory. Against each other: single precision times K/G.
  return {{"torque", "N m", "explicit", torque, t.torque, 0.03, 0, observed_order(torque_errors), 1.5},
          {"axial force (Poynting)", "N", "explicit", force, t.force, 0.08, 0, observed_order(force_errors), 1.0},
          {"torque, coarsest mesh", "N m", "implicit against explicit", coarse.torque, implicit.torque, 2e-3},
          {"axial force, coarsest mesh", "N", "implicit against explicit", coarse.force, implicit.force, 2e-3,
           std::abs(force)}};
}

std::vector<Check> cantilever() {
  const Tip expected = elastica(Beam::length, Beam::E * Beam::inertia(), Beam::per_length());
  std::vector<double> errors;
  Tip tip{0, 0}, coarse{0, 0};
  for (const int n : {2, 4, 8}) {
    // Its lowest bending vibration, 3.516/L^2 sqrt(EI/(rho A)), turns at 3.2 rad/s; under load somewhat faster.
    const Beam b(n, 1);
    tip = b.tip(relaxed(b.model, 4.5, 7.2e-4 / n, 7));
    errors.push_back(std::abs(tip.z - expected.z));
    if (n == 2) coarse = tip;
  }
  const Beam b(2, 1);
  const Tip implicit = b.tip(equilibrium(b.model, 10, Beam::height));
  const double shortening = Beam::length - expected.x;
  // Linear elements bend too stiffly: 8 over the height. The beam's own shear is 0.8 %.
  return {{"deflection of the tip", "m", "explicit", expected.z, tip.z, 0.04, 0, observed_order(errors), 1.4},
          {"shortening of the tip", "m", "explicit", shortening, Beam::length - tip.x, 0.08},
          {"deflection, coarsest mesh", "m", "implicit against explicit", coarse.z, implicit.z, 2e-3}};
}

}  // namespace carus::verify
