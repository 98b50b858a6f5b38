// SPDX-License-Identifier: Apache-2.0
// Contact of elastic bodies against closed forms.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "carus/observe/penetration.hpp"
#include "support/models.hpp"

namespace carus {
namespace {

constexpr double shear = 20e3;  // [Pa]

bool on(double a, double b) { return std::abs(a - b) < 1e-9; }

/// The flat part of a body's surface at z: whole boxes have edges, which the smooth gap takes for curvature.
fem::ContactSurface face(const mesh::TetMesh& mesh, const char* name, int label, double z) {
  fem::ContactSurface s{name, {}};
  for (const auto& t : mesh::boundary(mesh, [label](int l) { return l == label; })) {
    if (std::all_of(t.begin(), t.end(), [&](auto n) { return on(mesh.nodes[n].z(), z); })) s.triangles.push_back(t);
  }
  return s;
}

fem::PressureLoad press(const mesh::TetMesh& mesh, double z, double pressure, double ramp) {
  fem::PressureLoad load;
  load.surface = models::facets(mesh, [z](const Vec3& X) { return on(X.z(), z); });
  load.pressure = [=](double t) { return pressure * std::min(1.0, t / ramp); };
  return load;
}

/// Sum of the contact forces on the nodes of one label [N].
Vec3 force_on(const fem::Model& m, const solve::Observables& o, int label) {
  std::vector<bool> in(m.mesh.nodes.size(), false);
  for (std::size_t e = 0; e < m.mesh.tets.size(); ++e) {
    if (m.mesh.labels[e] == label) for (const auto n : m.mesh.tets[e]) in[std::size_t(n)] = true;
  }
  Vec3 sum = Vec3::Zero();
  for (std::size_t i = 0; i < in.size(); ++i) {
    if (in[i]) sum += o.contact_force[i];
  }
  return sum;
}

/// Two blocks whose nodes do not meet, under uniform pressure: the stress is the same everywhere.
TEST(ContactPatch, StackedBlocksCarryAUniformStress) {
  constexpr double a = 0.06, h = 0.03, pressure = 2e3;
  const auto soft = models::soft(material::Law::neo_hooke, shear, 0.3);
  auto m = models::of(shapes::join(shapes::box({0, 0, 0}, {a, a, h}, 5, 5, 3, 0), shapes::box({0, 0, h}, {a, a, h}, 7, 6, 3, 1)), {soft, soft});
  models::block(m, fem::x, [](const Vec3& X) { return on(X.x(), 0); });
  models::block(m, fem::y, [](const Vec3& X) { return on(X.y(), 0); });
  models::block(m, fem::z, [](const Vec3& X) { return on(X.z(), 0); });
  m.contact_surfaces = {face(m.mesh, "lower", 0, h), face(m.mesh, "upper", 1, h)};
  m.contact_pairs = {{0, 1, 0}};
  m.pressures = {press(m.mesh, 2 * h, pressure, 0.1)};
  solve::Explicit s(m, models::real_time(1, 1e-4, 60));
  s.advance_to(1);
  double worst = 0;
  for (std::size_t e = 0; e < m.mesh.tets.size(); ++e) {
    // First Piola stress is the dead load per rest area; here: Cauchy times the area's growth.
    const Mat3 F = models::deformation_gradient(m.mesh, e, s.state().x);
    const double P = (F.determinant() * models::neo_hooke_stress(m, e, s.state().x) * F.inverse().transpose())(2, 2);
    const double area = F(0, 0) * F(1, 1);  // the follower load grows with the face
    worst = std::max(worst, std::abs(P / area / pressure + 1));
  }
  const auto exact = observe::PenetrationCheck(m, 1e-3).check(s.state().x)[0];
  std::printf("contact patch: stress within %.2f %%, gap %.4f mm, exact search %.4f mm\n", 100 * worst, s.observe().least_gap * 1e3,
              exact.least_gap * 1e3);
  // Node-to-facet both ways is over-determined: each node carries its own share, not that of its facets. Measured below 2 %.
  EXPECT_LT(worst, 0.04);
  EXPECT_GT(s.observe().least_gap, -1e-5);
  EXPECT_GT(exact.least_gap, -1e-5);
  EXPECT_NEAR(force_on(m, s.observe(), 1).z(), pressure * a * a, 0.03 * pressure * a * a);  // area grows by nu p/E
}

/// Elastic ball between rigid plates, its lower half: mid-plane on rollers, plate moved up by delta.
/// Hertz: a^3 = 3 F R/(4 E*), delta = a^2/R; the finite ball's own compression: Tatara 1991, J. Eng. Mater. Technol. 113, 285:
/// delta = 3 (1 - nu^2) F/(4 E a) - F/(pi E) (2 (1 + nu) R^2/(a^2 + 4 R^2)^1.5 + (1 - nu^2)/(a^2 + 4 R^2)^0.5).
TEST(Hertz, BallOnRigidPlane) {
  constexpr double R = 0.03, gap = 2e-5, nu = 0.3;
  constexpr int n = 24;
  const auto ball = shapes::grid(n, n, n / 2, [](const Vec3& u) -> Vec3 {
    const auto graded = [](double q) { return std::copysign(std::pow(std::abs(q), 1.5), q); };  // fine towards the pole
    const Vec3 q(graded(2 * u.x() - 1), graded(2 * u.y() - 1), -std::pow(1 - u.z(), 0.8));
    const double cube = q.cwiseAbs().maxCoeff(), sphere = q.norm();
    return sphere > 0 ? Vec3(R * cube / sphere * q) : q;
  }, 0);
  const auto soft = models::soft(material::Law::hooke_corotated, shear, nu);
  auto m = models::of(shapes::join(ball, shapes::box({-0.02, -0.02, -R - gap - 0.01}, {0.04, 0.04, 0.01}, 7, 7, 1, 1)), {soft, soft});
  m.regions[1].rigid = true;
  models::block(m, fem::z, [](const Vec3& X) { return on(X.z(), 0); });
  models::block(m, fem::x, [](const Vec3& X) { return on(X.z(), 0) && on(X.x(), 0); });
  models::block(m, fem::y, [](const Vec3& X) { return on(X.z(), 0) && on(X.y(), 0); });
  fem::ContactSurface lower{"ball", {}};
  for (const auto& t : mesh::boundary(m.mesh, [](int l) { return l == 0; })) {
    if (!std::all_of(t.begin(), t.end(), [&](auto i) { return on(m.mesh.nodes[i].z(), 0); })) lower.triangles.push_back(t);
  }
  m.contact_surfaces = {lower, face(m.mesh, "plane", 1, -R - gap)};
  m.contact_pairs = {{0, 1, 0}};
  solve::Explicit s(m, models::real_time(0.4, 5e-5, 150));
  const auto plate_speed = [&](double v) {
    models::set(s, [&](fem::State& st) {
      for (std::size_t i = ball.nodes.size(); i < st.v.size(); ++i) st.v[i] = Vec3(0, 0, v);
    });
  };
  const double E = soft.youngs_modulus;
  const auto approach = [&](double F) {
    const double a = std::cbrt(0.75 * F * R * (1 - nu * nu) / E), d2 = a * a + 4 * R * R;
    return 0.75 * (1 - nu * nu) * F / (E * a) - F / (pi * E) * (2 * (1 + nu) * R * R / std::pow(d2, 1.5) + (1 - nu * nu) / std::sqrt(d2));
  };
  double time = 0;
  for (const double step : {6e-4, 6e-4}) {
    plate_speed(step / 0.03);
    s.advance_to(time += 0.03);
    plate_speed(0);
    s.advance_to(time += 0.07);
    s.advance_to(time += 0.01);  // the force is the mean over this stretch
    const double delta = s.state().x.back().z() - m.mesh.nodes.back().z() - gap;
    const double F = force_on(m, s.observe(), 0).z();
    double lo = 0, hi = 10;
    for (int i = 0; i < 60; ++i) (approach(0.5 * (lo + hi)) < delta ? lo : hi) = 0.5 * (lo + hi);
    std::printf("Hertz: approach %.3f mm, force %.4f N, theory %.4f N (%+.1f %%), contact radius %.2f mm\n", delta * 1e3, F, lo,
                100 * (F / lo - 1), 1e3 * std::cbrt(0.75 * F * R * (1 - nu * nu) / E));
    // Three to four elements across the contact radius, and small-strain theory at a/R = 0.2.
    EXPECT_NEAR(F, lo, 0.08 * lo);
  }
  EXPECT_GT(s.observe().least_gap, -1e-5);
}

/// A block on a rigid plate with friction; it is pressed on by p and pushed sideways by a directed load.
struct Slide {
  double displacement, speed;
};
Slide slide(double mu, double push_over_normal, double start_speed, double duration) {
  constexpr double a = 0.04, h = 0.02, p = 500;
  const auto stiff = models::soft(material::Law::neo_hooke, 10 * shear, 0.3);
  auto m = models::of(shapes::join(shapes::box({0, 0, 0}, {a, a, h}, 4, 4, 2, 0), shapes::box({-0.1, -0.02, -0.01}, {0.3, 0.08, 0.01}, 15, 4, 1, 1)),
                      {stiff, stiff});
  m.regions[1].rigid = true;
  m.contact_surfaces = {face(m.mesh, "block", 0, 0), face(m.mesh, "plate", 1, 0)};
  m.contact_pairs = {{0, 1, mu}};
  m.pressures = {press(m.mesh, h, p, 1e-9)};
  // The push acts on the lower face, where friction does: no moment.
  fem::PressureLoad push;
  for (const auto& t : m.contact_surfaces[0].triangles) push.surface.push_back(t);
  push.directed = true, push.direction = Vec3(1, 0, -1).normalized();
  push.pressure = [=](double t) { return -2 * p * push_over_normal * std::min(1.0, t / 0.02); };
  m.pressures.push_back(push);
  solve::Explicit s(m, models::real_time(duration, 4e-5));
  models::set(s, [&](fem::State& st) {
    for (std::size_t i = 0; i < 5 * 5 * 3; ++i) st.v[i] = Vec3(start_speed, 0, 0);
  });
  s.advance_to(duration);
  Slide out{0, 0};
  for (std::size_t i = 0; i < 5 * 5 * 3; ++i) {
    out.displacement += (s.state().x[i].x() - m.mesh.nodes[i].x()) / 75;
    out.speed += s.state().v[i].x() / 75;
  }
  return out;
}

}  // namespace
}  // namespace carus
