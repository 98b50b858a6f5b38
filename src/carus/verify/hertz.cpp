// SPDX-License-Identifier: Apache-2.0
// Elastic balls pressed on a rigid plane and on each other, by the explicit solver.
#include <algorithm>
#include <cmath>

#include "carus/verify/closed_forms.hpp"
#include "carus/verify/contact_scenes.hpp"
#include "carus/verify/suite.hpp"

namespace carus::verify {
namespace {

constexpr double shear = 20e3, nu = 0.3, R = 0.03, gap = 2e-5;  // [Pa], -, [m], [m]

/// Lower half of a ball, n cells across, fine towards the pole.
mesh::TetMesh half_ball(int n, int label) {
  return mesh::shapes::grid(
      n, n, n / 2,
      [](const Vec3& u) -> Vec3 {
        const auto graded = [](double q) { return std::copysign(std::pow(std::abs(q), 1.5), q); };
        const Vec3 q(graded(2 * u.x() - 1), graded(2 * u.y() - 1), -std::pow(1 - u.z(), 0.8));
        const double cube = q.cwiseAbs().maxCoeff(), sphere = q.norm();
        return sphere > 0 ? Vec3(R * cube / sphere * q) : q;
      },
      label);
}

/// The round side of a half ball of one label, whose flat side is at z.
fem::ContactSurface round_side(const mesh::TetMesh& mesh, const char* name, int label, double z) {
  fem::ContactSurface s{name, {}};
  for (const auto& t : mesh::boundary(mesh, [label](int l) { return l == label; })) {
    if (!std::all_of(t.begin(), t.end(), [&](auto i) { return on(mesh.nodes[i].z(), z); })) s.triangles.push_back(t);
  }
  return s;
}

/// The flat side at z slides on rollers and does not drift.
void hold(fem::Model& m, double z) {
  block(m, fem::z, [z](const Vec3& X) { return on(X.z(), z); });
  block(m, fem::x, [z](const Vec3& X) { return on(X.z(), z) && on(X.x(), 0); });
  block(m, fem::y, [z](const Vec3& X) { return on(X.z(), z) && on(X.y(), 0); });
}

/// Up by `depth` beyond the gap within 0.06 s, then at rest; relaxes until 0.2 s.
fem::Motion rise(std::vector<std::int32_t> nodes, std::uint8_t axes, double depth) {
  fem::Motion m;
  m.nodes = std::move(nodes), m.axes = axes;
  m.displacement = [depth](double t) -> Vec3 { return (gap + depth) * std::min(1.0, t / 0.06) * Vec3::UnitZ(); };
  return m;
}

/// Mean force on the nodes of label 0 over the last hundredth of a second.
double pressed_force(const fem::Model& m, int n) {
  solve::Explicit s(m, real_time(0.2, 1.2e-3 / n, 150));
  s.advance_to(0.19);
  s.advance_to(0.2);
  return force_on(m, s.observe(), 0).z();
}

double force_on_plane(int n, double depth) {
  const auto soft_ball = soft(material::Law::hooke_corotated, shear, nu);
  auto m = of(mesh::shapes::join(half_ball(n, 0),
                                 mesh::shapes::box({-0.02, -0.02, -R - gap - 0.01}, {0.04, 0.04, 0.01}, 7, 7, 1, 1)),
              {soft_ball, soft_ball});
  m.regions[1].rigid = true;
  hold(m, 0);
  m.contact_surfaces = {round_side(m.mesh, "ball", 0, 0), flat_face(m.mesh, "plane", 1, -R - gap)};
  m.contact_pairs = {{0, 1, 0}};
  m.motions = {rise(nodes_where(m.mesh, [](const Vec3& X) { return X.z() < -R - gap / 2; }), fem::all, depth)};
  return pressed_force(m, n);
}

double force_between(int n, double depth, double ratio) {
  auto lower = half_ball(n - 4, 1);  // meshes that do not match
  constexpr double below = -2 * R - gap;
  for (Vec3& x : lower.nodes) x = {x.x(), x.y(), below - x.z()};
  for (auto& t : lower.tets) std::swap(t[2], t[3]);  // mirrored
  auto m = of(mesh::shapes::join(half_ball(n, 0), lower), {soft(material::Law::hooke_corotated, shear, nu),
                                                           soft(material::Law::hooke_corotated, ratio * shear, nu)});
  hold(m, 0);
  block(m, fem::x, [](const Vec3& X) { return on(X.z(), below) && on(X.x(), 0); });
  block(m, fem::y, [](const Vec3& X) { return on(X.z(), below) && on(X.y(), 0); });
  m.contact_surfaces = {round_side(m.mesh, "upper", 0, 0), round_side(m.mesh, "lower", 1, below)};
  m.contact_pairs = {{0, 1, 0}};
  m.motions = {rise(nodes_where(m.mesh, [](const Vec3& X) { return on(X.z(), below); }), fem::z, depth)};
  return pressed_force(m, n);
}

}  // namespace

std::vector<Check> hertz_plane() {
  constexpr double depth = 1.2e-3;
  const double E = soft(material::Law::hooke_corotated, shear, nu).youngs_modulus;
  const double expected = hertz_force(depth, R, E, nu);
  std::vector<double> errors;
  double force = 0;
  for (const int n : {16, 32}) {
    force = force_on_plane(n, depth);
    errors.push_back(std::abs(force - expected));
  }
  // Five elements across the contact radius at the finest; small-strain theory at a/R = 0.2.
  return {{"force at an approach of 1.2 mm", "N", "explicit", expected, force, 0.03, 0, observed_order(errors)}};
}

std::vector<Check> hertz_spheres() {
  constexpr double depth = 2e-3, ratio = 2;
  const double E = soft(material::Law::hooke_corotated, shear, nu).youngs_modulus;
  const double expected =
      root([&](double F) { return hertz_approach_of_two(F, R, E, ratio * E, nu) - depth; }, 0, E * R * R);
  return {{"force at an approach of 2 mm", "N", "explicit", expected, force_between(28, depth, ratio), 0.04}};
}

}  // namespace carus::verify
