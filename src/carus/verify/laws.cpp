// SPDX-License-Identifier: Apache-2.0
// Homogeneous states of each law on a shaken mesh, by both solvers: a uniform state has no discretisation error.
#include <algorithm>

#include "carus/verify/closed_forms.hpp"
#include "carus/verify/statics.hpp"
#include "carus/verify/suite.hpp"

namespace carus::verify {
namespace {

constexpr double shear = 20e3, side = 0.1, poisson = 0.45;  // [Pa], [m]
// Explicit: single-precision forces and what is left of the relaxation. Implicit: Newton's tolerance.
constexpr double explicit_tolerance = 1e-5, implicit_tolerance = 1e-7;

struct Law {
  material::Law law;
  const char* name;
  bool small;  ///< valid for small strain only: a tenth of a percent
};
constexpr Law laws[] = {{material::Law::neo_hooke, "neo-Hooke", false},
                        {material::Law::mooney_rivlin, "Mooney-Rivlin", false},
                        {material::Law::hooke_corotated, "Hooke, corotated", false},
                        {material::Law::hooke_small_strain, "Hooke, small strain", true}};

fem::Model cube(const Law& law) {
  auto mesh = mesh::shapes::box(Vec3::Zero(), Vec3::Constant(side), 3, 3, 3);
  mesh::shapes::shake(mesh, 0.2 * side / 3);
  return of(mesh, {soft(law.law, shear, poisson)});
}

void roller(fem::Model& m, int axis) {
  block(m, std::uint8_t(1 << axis), [axis](const Vec3& X) { return on(X[axis], 0); });
}
void pull(fem::Model& m, int axis, double stretch) {
  impose(
      m, std::uint8_t(1 << axis), [axis](const Vec3& X) { return on(X[axis], side); },
      [=](const Vec3&) -> Vec3 { return (stretch - 1) * side * Vec3::Unit(axis); });
}

/// Force per rest area on the face at `side` of an axis, by both solvers.
void add(std::vector<Check>& checks, const std::string& quantity, const fem::Model& m, int face, int component,
         double expected, double small_strain_loss) {
  const auto at_face = [face](const Vec3& X) { return on(X[face], side); };
  const double area = side * side;
  Check c{quantity, "Pa", "implicit", expected, 0, implicit_tolerance};
  c.obtained = sum(equilibrium(m, 5, side).reaction, m.mesh, at_face)[component] / area;
  checks.push_back(c);
  // The load runs over the first second; drag near twice the lowest frequency, pi sqrt(G/rho)/side.
  solve::Explicit s(m, real_time(2, 2e-4, 100));
  s.advance_to(2);
  c.solver = "explicit", c.tolerance = explicit_tolerance + small_strain_loss;
  c.obtained = sum(s.observe().reaction, m.mesh, at_face)[component] / area;
  checks.push_back(c);
}
/// At a strain of 0.1 % the strains themselves carry 1e-6 in single precision, times K/G of 10.
double loss(const Law& law) { return law.small ? 1e-3 : 0; }

}  // namespace

std::vector<Check> uniaxial() {
  std::vector<Check> checks;
  for (const Law& law : laws) {
    const double stretch = law.small ? 1.001 : 1.5;
    auto m = cube(law);
    for (int k = 0; k < 3; ++k) roller(m, k);
    pull(m, 2, stretch);
    const auto& material = m.regions[0].material;
    const double lateral = root([&](double b) { return principal_stress(material, {b, b, stretch})[0]; }, 0.3, 2);
    add(checks, law.name, m, 2, 2, principal_stress(material, {lateral, lateral, stretch})[2], loss(law));
  }
  return checks;
}

std::vector<Check> equibiaxial() {
  std::vector<Check> checks;
  for (const Law& law : laws) {
    const double stretch = law.small ? 1.001 : 1.3;
    auto m = cube(law);
    for (int k = 0; k < 3; ++k) roller(m, k);
    pull(m, 0, stretch);
    // The corner edge is pulled along both axes, by one motion each.
    pull(m, 1, stretch);
    const auto& material = m.regions[0].material;
    const double lateral = root([&](double b) { return principal_stress(material, {stretch, stretch, b})[2]; }, 0.3, 2);
    add(checks, law.name, m, 0, 0, principal_stress(material, {stretch, stretch, lateral})[0], loss(law));
  }
  return checks;
}

std::vector<Check> simple_shear() {
  std::vector<Check> checks;
  for (const Law& law : laws) {
    const double gamma = law.small ? 0.001 : 0.4;
    auto m = cube(law);
    impose(
        m, fem::all, [](const Vec3& X) { return (X.array() < 1e-9).any() || (X.array() > side - 1e-9).any(); },
        [=](const Vec3& X) -> Vec3 { return gamma * X.y() * Vec3::UnitX(); });
    const auto& material = m.regions[0].material;
    Mat3 F = Mat3::Identity();
    F(0, 1) = gamma;
    const double expected = law.small ? material.shear_modulus() * gamma : nominal_stress(material, F)(0, 1);
    // The face's own edges belong to its neighbours too; the traction on a cut is what the upper nodes carry: by
    // moments, sum of f_x y over all nodes is P_xy times the volume.
    const auto moment = [&](const std::vector<Vec3>& f) {
      double sum = 0;
      for (std::size_t i = 0; i < f.size(); ++i) sum += f[i].x() * m.mesh.nodes[i].y();
      return sum / (side * side * side);
    };
    const auto at_rest = equilibrium(m, 5, side);
    Check c{law.name, "Pa", "implicit", expected, moment(at_rest.reaction), implicit_tolerance};
    checks.push_back(c);
    if (law.law == material::Law::neo_hooke) {
      double lift = 0;  // sum f_y y = P_yy V: the Poynting effect
      for (std::size_t i = 0; i < at_rest.x.size(); ++i) lift += at_rest.reaction[i].y() * m.mesh.nodes[i].y();
      checks.push_back({"neo-Hooke, normal stress", "Pa", "implicit", nominal_stress(material, F)(1, 1),
                        lift / (side * side * side), implicit_tolerance});
    }
    solve::Explicit s(m, real_time(2, 2e-4, 100));
    s.advance_to(2);
    c.solver = "explicit", c.obtained = moment(s.observe().reaction), c.tolerance = explicit_tolerance + loss(law);
    checks.push_back(c);
  }
  return checks;
}

std::vector<Check> patch() {
  std::vector<Check> checks;
  Mat3 A;
  A << 1.12, 0.1, -0.05, 0.04, 0.95, 0.08, -0.06, 0.05, 1.03;
  for (const Law& law : laws) {
    for (const bool averaged : {false, true}) {
      auto m = cube(law);
      m.regions[0].material.average_nodal_pressure = averaged;
      impose(
          m, fem::all, [](const Vec3& X) { return (X.array() < 1e-9).any() || (X.array() > side - 1e-9).any(); },
          [&](const Vec3& X) -> Vec3 { return A * X - X; });
      const auto worst = [&](const std::vector<Vec3>& x) {
        double most = 0;
        for (std::size_t i = 0; i < x.size(); ++i) most = std::max(most, (x[i] - A * m.mesh.nodes[i]).norm());
        return most;
      };
      const std::string name = std::string(law.name) + (averaged ? ", nodal averages" : "") + ": distance";
      Check c{name, "m", "implicit", 0, worst(equilibrium(m, 4, side).x), 1e-7, side};
      checks.push_back(c);
      solve::Explicit s(m, real_time(2, 2e-4, 100));
      s.advance_to(2);
      // Single-precision forces: strains to about 1e-6; nodal averages round volumes too.
      c.solver = "explicit", c.obtained = worst(s.state().x), c.tolerance = averaged ? 1e-5 : 3e-6;
      checks.push_back(c);
    }
  }
  return checks;
}

}  // namespace carus::verify
