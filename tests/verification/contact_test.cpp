// SPDX-License-Identifier: Apache-2.0
// Contact of elastic bodies against closed forms.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "carus/observe/penetration.hpp"
#include "carus/solve/mass.hpp"
#include "carus/verify/contact_scenes.hpp"
#include "support/models.hpp"

namespace carus {
namespace {

constexpr double shear = 20e3;  // [Pa]

bool on(double a, double b) { return std::abs(a - b) < 1e-9; }

using verify::flat_face;
using verify::press;

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
  m.contact_surfaces = {flat_face(m.mesh, "block", 0, 0), flat_face(m.mesh, "plate", 1, 0)};
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
  m.contact_surfaces = {flat_face(m.mesh, "block", 0, 0), flat_face(m.mesh, "plate", 1, 0)};
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
