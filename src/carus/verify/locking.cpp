// SPDX-License-Identifier: Apache-2.0
// Volumetric locking of linear tetrahedra, with and without average nodal pressure, on refined meshes.
#include <fmt/format.h>

#include <algorithm>

#include "carus/verify/closed_forms.hpp"
#include "carus/verify/statics.hpp"
#include "carus/verify/suite.hpp"

namespace carus::verify {
namespace {

constexpr double shear = 20e3;  // [Pa]
constexpr double none_asked = std::numeric_limits<double>::infinity();

/// Obtained values on refined meshes, as one check: the finest, with the order seen.
Check refined(const std::string& quantity, const std::string& unit, double expected,
              const std::vector<double>& obtained, double scale = 0) {
  Check c{quantity, unit, "implicit", expected, obtained.back()};
  c.scale = scale;
  std::vector<double> errors;
  for (const double o : obtained) errors.push_back(std::abs(o - expected));
  c.order = observed_order(errors);
  return c;
}

std::string named(double poisson, bool averaged) {
  return fmt::format("nu {:g}, {}", poisson, averaged ? "average nodal pressure" : "plain");
}

struct Sphere {
  static constexpr double inner = 0.03, outer = 0.06, grown = 0.036;
  fem::Model model;
  /// The pressure rises to its full value at t = ramp.
  Sphere(int cells, bool averaged, double ramp) {
    auto material = soft(material::Law::neo_hooke, shear, 0.499);
    material.average_nodal_pressure = averaged;
    model = of(mesh::shapes::sphere_octant(inner, outer, cells, 2 * cells), {material});
    for (int k = 0; k < 3; ++k) block(model, std::uint8_t(1 << k), [k](const Vec3& X) { return on(X[k], 0); });
    fem::PressureLoad load;
    load.surface = facets(model.mesh, [](const Vec3& X) { return on(X.norm(), inner); });
    const double pressure = sphere_pressure(inner, outer, shear, grown);
    load.pressure = [=](double t) { return pressure * std::min(1.0, t / ramp); };
    model.pressures = {load};
  }
  /// Of the ball that the inner surface encloses.
  [[nodiscard]] double inner_radius(const std::vector<Vec3>& x) const {
    const auto enclosed = [&](const std::vector<Vec3>& at) {
      double volume = 0;
      for (const auto& t : model.pressures[0].surface) volume -= at[t[0]].dot(at[t[1]].cross(at[t[2]])) / 6;
      return volume;
    };
    return inner * std::cbrt(enclosed(x) / enclosed(model.mesh.nodes));
  }
};

/// Volumetric waves do 100 m/s; mass scaling of the slivers at the corner where the grid closes is harmless at rest.
double radius_by_explicit(int cells, bool averaged) {
  const Sphere s(cells, averaged, 0.05);
  return s.inner_radius(relaxed(s.model, 0.15, 6e-5 / cells, 200).x);
}

/// Half of a block bent to the curvature kappa in plane strain: its end section x = L turns, u_x = -kappa L z.
double bending_moment(int n, double poisson, bool averaged, double kappa) {
  constexpr double L = 0.08, h = 0.02;
  auto material = soft(material::Law::neo_hooke, shear, poisson);
  material.average_nodal_pressure = averaged;
  const double w = h / n;
  auto m = of(mesh::shapes::box({0, 0, -h / 2}, {L, w, h}, 4 * n, 1, n), {material});
  block(m, fem::y, [](const Vec3&) { return true; });
  block(m, fem::x, [](const Vec3& X) { return on(X.x(), 0); });
  block(m, fem::z, [](const Vec3& X) { return on(X.x(), 0) && on(X.z(), 0); });
  const auto end = [](const Vec3& X) { return on(X.x(), L); };
  impose(m, fem::x, end, [=](const Vec3& X) -> Vec3 { return -kappa * L * X.z() * Vec3::UnitX(); });
  const auto reaction = equilibrium(m, 1, 1e-3 * h).reaction;
  double moment = 0;
  for (const auto i : nodes_where(m.mesh, end)) moment += reaction[i].x() * m.mesh.nodes[i].z();
  return moment / w;
}

/// Vertical stiffness per thickness of Cook's membrane whose loaded edge moves up as one.
double cook_stiffness(int n, double poisson, bool averaged) {
  constexpr double mm = 1e-3, u = 1e-4 * mm;
  auto material = soft(material::Law::hooke_small_strain, shear, poisson);
  material.average_nodal_pressure = averaged;
  const double w = 16 * mm / n;
  auto mesh = mesh::shapes::grid(n, 1, n, [&](const Vec3& q) {
    const double x = 48 * q.x(), low = 44 * q.x(), high = 44 + 16 * q.x();
    return Vec3(x * mm, w * q.y(), (low + q.z() * (high - low)) * mm);
  });
  auto m = of(std::move(mesh), {material});
  block(m, fem::y, [](const Vec3&) { return true; });
  block(m, fem::x | fem::z, [](const Vec3& X) { return on(X.x(), 0); });
  const auto edge = [=](const Vec3& X) { return on(X.x(), 48 * mm); };
  impose(m, fem::z, edge, [=](const Vec3&) -> Vec3 { return u * Vec3::UnitZ(); });
  return sum(equilibrium(m, 1, u).reaction, m.mesh, edge).z() / (u * w);
}

}  // namespace

std::vector<Check> thick_sphere() {
  constexpr double dilatation = Sphere::grown - Sphere::inner;
  std::vector<Check> checks;
  double coarse = 0;
  for (const bool averaged : {false, true}) {
    std::vector<double> radius;
    for (const int cells : {2, 4, 8}) radius.push_back(radius_by_explicit(cells, averaged));
    auto c = refined(averaged ? "inner radius, average nodal pressure" : "inner radius, plain", "m", Sphere::grown,
                     radius, dilatation);
    // 8 elements through the wall, K/G = 500 against incompressible theory. Plain tets lock: from far off, slowly.
    c.solver = "explicit", c.tolerance = averaged ? 0.03 : none_asked, c.least_order = averaged ? 1.6 : 0.3;
    checks.push_back(c);
    coarse = radius[0];
  }
  const Sphere s(2, true, 1);
  // The explicit solver's rest and single precision, times K/G.
  checks.push_back({"inner radius, average nodal pressure, coarsest mesh", "m", "implicit against explicit", coarse,
                    s.inner_radius(equilibrium(s.model, 10, Sphere::inner).x), 1e-3, dilatation});
  return checks;
}

std::vector<Check> bending_block() {
  constexpr double h = 0.02, kappa = 0.05;  // strains up to 5e-4: small-strain theory holds to that
  std::vector<Check> checks;
  for (const double poisson : {0.3, 0.49, 0.499}) {
    const double E = 2 * shear * (1 + poisson);
    const double expected = -E / (1 - poisson * poisson) * kappa * h * h * h / 12;
    for (const bool averaged : {false, true}) {
      std::vector<double> moment;
      for (const int n : {4, 8, 16}) moment.push_back(bending_moment(n, poisson, averaged, kappa));
      auto c = refined("moment, " + named(poisson, averaged), "N", expected, moment);
      // 16 elements over the height; nu = 0.3 does not lock, plain tets near 1/2 do.
      const bool locks = !averaged && poisson > 0.4;
      c.tolerance = locks ? none_asked : 0.05, c.least_order = locks ? 0.3 : 1.5;
      checks.push_back(c);
    }
  }
  return checks;
}

std::vector<Check> cook_membrane() {
  // bench/ccx/cook.py: CalculiX 2.20, 64 x 64 bricks of 20 nodes with reduced integration, G = 20 kPa.
  struct Reference {
    double poisson, stiffness;  // [Pa]
  };
  constexpr Reference references[] = {{0.3, 2403.65}, {0.49, 3231.38}, {0.499, 3289.00}};
  std::vector<Check> checks;
  for (const auto& [poisson, stiffness] : references) {
    for (const bool averaged : {false, true}) {
      std::vector<double> obtained;
      for (const int n : {8, 16, 32}) obtained.push_back(cook_stiffness(n, poisson, averaged));
      auto c = refined("stiffness per thickness, " + named(poisson, averaged), "Pa", stiffness, obtained);
      const bool locks = !averaged && poisson > 0.4;
      // A singular corner at the clamp: below second order.
      c.tolerance = locks ? none_asked : 0.04, c.least_order = locks ? 0.3 : 0.9;
      checks.push_back(c);
    }
  }
  return checks;
}

}  // namespace carus::verify
