// SPDX-License-Identifier: Apache-2.0
// Contact of elastic bodies against closed forms.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "carus/observe/penetration.hpp"
#include "carus/solve/mass.hpp"
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
    if (m.mesh.labels[e] != label) continue;
    for (const auto n : m.mesh.tets[e]) in[std::size_t(n)] = true;
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
  auto m = models::of(
      shapes::join(shapes::box({0, 0, 0}, {a, a, h}, 5, 5, 3, 0), shapes::box({0, 0, h}, {a, a, h}, 7, 6, 3, 1)),
      {soft, soft});
  models::block(m, fem::x, [](const Vec3& X) { return on(X.x(), 0); });
  models::block(m, fem::y, [](const Vec3& X) { return on(X.y(), 0); });
  models::block(m, fem::z, [](const Vec3& X) { return on(X.z(), 0); });
  m.contact_surfaces = {face(m.mesh, "lower", 0, h), face(m.mesh, "upper", 1, h)};
  m.contact_pairs = {{0, 1, 0}};
  m.pressures = {press(m.mesh, 2 * h, pressure, 0.1)};
  solve::Explicit s(m, models::real_time(1, 1e-4, 60));
  s.advance_to(0.9);
  s.advance_to(1);  // the force is the mean over this stretch
  double worst = 0;
  for (std::size_t e = 0; e < m.mesh.tets.size(); ++e) {
    // First Piola stress is the dead load per rest area; here: Cauchy times the area's growth.
    const Mat3 F = models::deformation_gradient(m.mesh, e, s.state().x);
    const double P = (F.determinant() * models::neo_hooke_stress(m, e, s.state().x) * F.inverse().transpose())(2, 2);
    const double area = F(0, 0) * F(1, 1);  // the follower load grows with the face
    worst = std::max(worst, std::abs(P / area / pressure + 1));
  }
  const auto exact = observe::PenetrationCheck(m, 1e-3).check(s.state().x)[0];
  std::printf("contact patch: stress within %.2f %%, gap %.4f mm, exact search %.4f mm\n", 100 * worst,
              s.observe().least_gap * 1e3, exact.least_gap * 1e3);
  // Node-to-facet both ways is over-determined: each node carries its own share, not that of its facets. Measured below
  // 2 %.
  EXPECT_LT(worst, 0.04);
  EXPECT_GT(s.observe().least_gap, -1e-5);
  EXPECT_GT(exact.least_gap, -1e-5);
  const Vec3 corner = s.state().x.back();  // the loaded face has grown sideways
  const double load = pressure * corner.x() * corner.y();
  EXPECT_NEAR(force_on(m, s.observe(), 1).z(), load, 0.002 * load);  // static; every seventh step is sampled
}

/// Elastic ball between rigid plates, its lower half: mid-plane on rollers, plate moved up by delta.
/// Hertz: a^3 = 3 F R/(4 E*), delta = a^2/R; the finite ball's own compression: Tatara 1991, J. Eng. Mater. Technol.
/// 113, 285: delta = 3 (1 - nu^2) F/(4 E a) - F/(pi E) (2 (1 + nu) R^2/(a^2 + 4 R^2)^1.5 + (1 - nu^2)/(a^2 + 4
/// R^2)^0.5).
TEST(Hertz, BallOnRigidPlane) {
  constexpr double R = 0.03, gap = 2e-5, nu = 0.3;
  constexpr int n = 24;
  const auto ball = shapes::grid(
      n, n, n / 2,
      [](const Vec3& u) -> Vec3 {
        const auto graded = [](double q) {
          return std::copysign(std::pow(std::abs(q), 1.5), q);
        };  // fine towards the pole
        const Vec3 q(graded(2 * u.x() - 1), graded(2 * u.y() - 1), -std::pow(1 - u.z(), 0.8));
        const double cube = q.cwiseAbs().maxCoeff(), sphere = q.norm();
        return sphere > 0 ? Vec3(R * cube / sphere * q) : q;
      },
      0);
  const auto soft = models::soft(material::Law::hooke_corotated, shear, nu);
  auto m = models::of(shapes::join(ball, shapes::box({-0.02, -0.02, -R - gap - 0.01}, {0.04, 0.04, 0.01}, 7, 7, 1, 1)),
                      {soft, soft});
  m.regions[1].rigid = true;
  models::block(m, fem::z, [](const Vec3& X) { return on(X.z(), 0); });
  models::block(m, fem::x, [](const Vec3& X) { return on(X.z(), 0) && on(X.x(), 0); });
  models::block(m, fem::y, [](const Vec3& X) { return on(X.z(), 0) && on(X.y(), 0); });
  fem::ContactSurface lower{"ball", {}};
  for (const auto& t : mesh::boundary(m.mesh, [](int l) { return l == 0; })) {
    if (!std::all_of(t.begin(), t.end(), [&](auto i) { return on(m.mesh.nodes[i].z(), 0); }))
      lower.triangles.push_back(t);
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
    return 0.75 * (1 - nu * nu) * F / (E * a) -
           F / (pi * E) * (2 * (1 + nu) * R * R / std::pow(d2, 1.5) + (1 - nu * nu) / std::sqrt(d2));
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
    std::printf("Hertz: approach %.3f mm, force %.4f N, theory %.4f N (%+.1f %%), contact radius %.2f mm\n",
                delta * 1e3, F, lo, 100 * (F / lo - 1), 1e3 * std::cbrt(0.75 * F * R * (1 - nu * nu) / E));
    // Three to four elements across the contact radius, and small-strain theory at a/R = 0.2.
    EXPECT_NEAR(F, lo, 0.08 * lo);
  }
  EXPECT_GT(s.observe().least_gap, -1e-5);
}

constexpr double slider_side = 0.04, slider_height = 0.02, slider_pressure = 500;  // [m], [m], [Pa]

/// Mean displacement and speed, along x, of a block pressed on a rigid plate.
struct Slide {
  double displacement, speed;
};

/// `ratio` = sideways push over normal force.
Slide slide(double mu, double ratio, double start_speed, double duration) {
  constexpr double a = slider_side, h = slider_height, p = slider_pressure;
  const auto stiff = models::soft(material::Law::neo_hooke, 10 * shear, 0.3);
  auto m = models::of(shapes::join(shapes::box({0, 0, 0}, {a, a, h}, 4, 4, 2, 0),
                                   shapes::box({-0.1, -0.02, -0.01}, {0.3, 0.08, 0.01}, 15, 4, 1, 1)),
                      {stiff, stiff});
  m.regions[1].rigid = true;
  m.contact_surfaces = {face(m.mesh, "block", 0, 0), face(m.mesh, "plate", 1, 0)};
  m.contact_pairs = {{0, 1, mu}};
  m.pressures = {press(m.mesh, h, p, 1e-3)};
  // The push acts on the lower face, where friction does, so that there is no moment; a directed suction q on a face
  // that looks down pulls by q/2 along x and by q/2 down.
  fem::PressureLoad push;
  push.surface = m.contact_surfaces[0].triangles;
  push.directed = true, push.direction = Vec3(1, 0, -1).normalized();
  const double q = 2 * p * ratio / (1 - ratio);
  push.pressure = [=](double t) { return -q * std::min(1.0, t / 0.02); };
  m.pressures.push_back(push);
  solve::Explicit s(m, models::real_time(duration, 4e-5));
  constexpr std::size_t block_nodes = 5 * 5 * 3;
  models::set(s, [&](fem::State& st) {
    for (std::size_t i = 0; i < block_nodes; ++i) st.v[i] = Vec3(start_speed, 0, 0);
  });
  s.advance_to(duration);
  Slide out{0, 0};
  const auto weight = solve::scaled_masses(m, s.step_report().time_step, 0.5).scaled;
  double mass = 0;
  for (std::size_t i = 0; i < block_nodes; ++i) mass += weight[i];
  for (std::size_t i = 0; i < block_nodes; ++i) {
    out.displacement += weight[i] / mass * (s.state().x[i].x() - m.mesh.nodes[i].x());
    out.speed += weight[i] / mass * s.state().v[i].x();
  }
  return out;
}

TEST(Friction, SticksBelowTheCoefficient) {
  const auto held = slide(0.4, 0.32, 0, 0.4);
  std::printf("friction below mu: %.4f mm in 0.4 s, %.2e m/s\n", held.displacement * 1e3, held.speed);
  // A free block would go 0.19 m. What moves is the elastic give (T h/G a^2 < 0.01 mm) and creep of the velocity-level
  // law.
  EXPECT_LT(std::abs(held.displacement), 5e-4);
  EXPECT_LT(std::abs(held.speed), 5e-3);
}

TEST(Friction, SlidesAboveTheCoefficient) {
  constexpr double mu = 0.3, ratio = 0.5, duration = 0.2, ramp = 0.02;
  const auto moved = slide(mu, ratio, 0, duration);
  // a = (T - mu N)/m with N = p A/(1 - ratio); the ramp slides only above T = mu N, at most the whole ramp late.
  const double N = slider_pressure / (1 - ratio), acceleration = (ratio - mu) * N / (1000 * slider_height);
  std::printf("friction above mu: %.3f m/s, theory %.3f..%.3f\n", moved.speed, acceleration * (duration - ramp),
              acceleration * duration);
  EXPECT_GT(moved.speed, 0.98 * acceleration * (duration - ramp));
  EXPECT_LT(moved.speed, 1.02 * acceleration * duration);
}

TEST(Friction, Decelerates) {
  constexpr double mu = 0.3, start = 1.5, duration = 0.1;
  const auto moved = slide(mu, 0, start, duration);
  const double expected = start - mu * slider_pressure / (1000 * slider_height) * duration;  // 7.5 m/s^2
  std::printf("friction alone: %.3f m/s, theory %.3f\n", moved.speed, expected);
  EXPECT_NEAR(moved.speed, expected, 0.03 * (start - expected));  // the pressure's ramp of 1 ms and the block's ringing
}

TEST(Friction, NoneWithoutCoefficient) {
  const auto moved = slide(0, 0, 1.5, 0.1);
  EXPECT_NEAR(moved.speed, 1.5, 1e-5);  // momentum along a flat plate: single-precision rounding over 2500 steps
}

/// A block presses on a rigid plate that turns about its edge: spring moment = moment of the contact forces, and these
/// carry the load.
TEST(Hinge, TurnsToItsStaticAngle) {
  constexpr double a = 0.06, h = 0.03, pressure = 1000, stiffness = 2.2;
  const auto soft = models::soft(material::Law::neo_hooke, shear, 0.3);
  auto m = models::of(shapes::join(shapes::box({0.01, 0.01, 0}, {a, a, h}, 5, 5, 3, 0),
                                   shapes::box({0, 0, -0.01}, {0.1, 0.08, 0.01}, 8, 7, 1, 1)),
                      {soft, soft});
  m.regions[1].rigid = true;
  models::block(m, fem::x | fem::y, [](const Vec3& X) {
    return X.z() > -1e-9 && X.x() > 0.0099 && X.x() < 0.0701 && X.y() > 0.0099 && X.y() < 0.0701 && on(X.z(), h);
  });
  fem::Hinge hinge;
  hinge.name = "plate", hinge.point = Vec3::Zero(), hinge.axis = Vec3::UnitY();
  hinge.stiffness = stiffness, hinge.damping = 0.02, hinge.inertia = 1e-4;
  const std::size_t first = 6 * 6 * 4;
  for (std::size_t i = first; i < m.mesh.nodes.size(); ++i) hinge.nodes.push_back(std::int32_t(i));
  m.hinges = {hinge};
  m.contact_surfaces = {face(m.mesh, "block", 0, 0), face(m.mesh, "plate", 1, 0)};
  m.contact_pairs = {{0, 1, 0}};
  m.pressures = {press(m.mesh, h, pressure, 0.1)};
  m.pressures[0].directed = true, m.pressures[0].direction = Vec3(0, 0, -1);
  solve::Explicit s(m, models::real_time(1.2, 1e-4, 60));
  s.advance_to(1.1);
  s.advance_to(1.2);
  const auto o = s.observe();
  double moment = 0, down = 0;
  for (std::size_t i = first; i < m.mesh.nodes.size(); ++i) {
    moment += hinge.axis.dot(s.state().x[i].cross(o.contact_force[i])), down -= o.contact_force[i].z();
  }
  std::printf("hinge: %.3f deg, moment %.5f N m, spring %.5f N m, load %.4f N of %.4f\n", o.hinge_angle[0] * 180 / pi,
              moment, stiffness * o.hinge_angle[0], down, pressure * a * a);
  EXPECT_GT(o.hinge_angle[0], 0.02);
  EXPECT_NEAR(down, pressure * a * a, 0.01 * pressure * a * a);  // static; the force is sampled every eighth step
  EXPECT_NEAR(stiffness * o.hinge_angle[0], moment, 0.01 * moment);
  // Centre of the block is 0.04 m off the axis; the tilt moves the centre of pressure by less than a tenth of that.
  EXPECT_NEAR(moment, pressure * a * a * 0.04, 0.1 * moment);
  EXPECT_GT(o.least_gap, -1e-5);
  const auto energy_in = o.external_work + o.contact_work - o.damping_work;
  EXPECT_NEAR(o.kinetic + o.internal, energy_in, 0.01 * o.external_work);
}

/// A sheet folds on itself under a follower pressure: its wings clap together and are pressed, but do not pass.
TEST(SelfContact, FoldingSheetDoesNotPass) {
  constexpr double length = 0.16, thick = 0.004;
  auto m = models::of(shapes::box({-length / 2, 0, 0}, {length, 0.016, thick}, 48, 4, 1),
                      {models::soft(material::Law::neo_hooke, shear, 0.4)});
  models::block(m, fem::all, [](const Vec3& X) { return std::abs(X.x()) < 0.0035 && on(X.z(), 0); });
  m.contact_surfaces = {{"inner side", models::facets(m.mesh, [](const Vec3& X) { return on(X.z(), thick); })}};
  m.contact_pairs = {{0, 0, 0}};
  m.pressures = {press(m.mesh, 0, 15, 0.1)};
  m.pressures[0].pressure = [](double t) {
    return 50 * std::min(1.0, t / 0.3) + 150 * std::max(0.0, t - 0.7);
  };  // folds, then presses
  solve::Explicit s(m, models::real_time(1.2, 1e-4, 30));
  const observe::PenetrationCheck check(m, 1e-3);
  double deepest = 0, contact_gap = 0;  // contact_gap is the solver's own, on the smooth surface
  for (int k = 1; k <= 24; ++k) {
    s.advance_to(0.05 * k);
    deepest = std::min(deepest, check.check(s.state().x)[0].least_gap);
    contact_gap = std::min(contact_gap, s.observe().least_gap);
  }
  double widest = 0, force = 0;
  for (std::size_t i = 0; i < s.state().x.size(); ++i) {
    widest = std::max(widest, std::abs(s.state().x[i].x()));
    force += s.observe().contact_force[i].cwiseAbs().x();
  }
  std::printf("fold: half width %.1f of %.1f mm, contact forces %.3f N, deepest %.4f mm (exact), %.4f mm (solver)\n",
              widest * 1e3, length * 500, force, deepest * 1e3, contact_gap * 1e3);
  EXPECT_LT(widest, 0.35 * length);  // it folded
  EXPECT_GT(force, 0.05);            // and presses on itself
  EXPECT_GT(deepest, -2e-4);         // what a birth allows; the fold snaps through at 1 m/s
}

}  // namespace
}  // namespace carus
