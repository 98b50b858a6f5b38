// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "carus/contact/intersection.hpp"
#include "carus/core/error.hpp"
#include "carus/solve/implicit.hpp"
#include "support/models.hpp"

namespace carus::solve {
namespace {

constexpr double shear = 20e3;  // [Pa]

bool cut(const fem::Model& m, const std::vector<Vec3>& x) {
  std::vector<contact::Side> sides;
  std::vector<contact::Touching> pairs;
  for (const auto& s : m.contact_surfaces) sides.push_back({s.name, s.triangles});
  for (const auto& p : m.contact_pairs) pairs.push_back({p.a, p.b, p.friction});
  return !contact::intersections(sides, pairs, x).empty();
}

/// A small block 1 mm above a broad one that is fixed; `down` is the acceleration of the small one's body.
fem::Model two_blocks(double friction, const Vec3& down) {
  const auto base = shapes::box({-0.03, -0.03, -0.01}, {0.06, 0.06, 0.01}, 4, 4, 1, 0);
  const auto block = shapes::box({-0.011, -0.009, 0.0004}, {0.02, 0.02, 0.01}, 3, 3, 2, 1);
  auto m = models::of(shapes::join(base, block), {models::soft(material::Law::neo_hooke, shear, 0.3),
                                                  models::soft(material::Law::neo_hooke, shear, 0.3)});
  models::block(m, fem::all, [](const Vec3& X) { return X.z() < 1e-9; });
  m.body_forces.push_back({"weight", {1}, [down](double) { return down; }});
  m.contact_surfaces = {models::skin(m.mesh, "base", 0), models::skin(m.mesh, "block", 1)};
  m.contact_pairs = {{0, 1, friction}};
  return m;
}

ImplicitOptions slow(double drag) {
  ImplicitOptions o;
  o.time_step = 0.05, o.least_time_step = 1e-4;
  o.drag = drag;
  o.newton_tolerance = 1e-8, o.linear_tolerance = 1e-2;
  o.barrier_distance = 3e-4, o.barrier_pressure = 1e3;
  o.friction_speed = 1e-5;
  return o;
}

double mean_x(const fem::Model& m, const std::vector<Vec3>& x, std::size_t first) {
  double sum = 0;
  for (std::size_t i = first; i < x.size(); ++i) sum += x[i].x() - m.mesh.nodes[i].x();
  return sum / double(x.size() - first);
}

constexpr std::size_t base_nodes = 5 * 5 * 2;

TEST(ImplicitContact, ARestingBlockIsBorneAndNothingCuts) {
  const auto m = two_blocks(0, {0, 0, -10});
  auto o = slow(200);
  Implicit s(m, o);
  for (int k = 1; k <= 10; ++k) {
    s.advance_to(0.1 * k);
    EXPECT_FALSE(cut(m, s.state().x));
    EXPECT_GT(s.observe().least_gap, 0);
  }
  const auto seen = s.observe();
  Vec3 on_block = Vec3::Zero(), on_base = Vec3::Zero();
  for (std::size_t i = 0; i < m.mesh.nodes.size(); ++i) (i < base_nodes ? on_base : on_block) += seen.contact_force[i];
  const double weight = 1000 * 4e-6 * 10;
  EXPECT_NEAR(on_block.z(), weight, 0.01 * weight);  // what drag still bears after a second
  EXPECT_LT((on_block + on_base).norm(), 1e-9);
  EXPECT_LT(seen.least_gap, 3e-4);  // and it does rest on the other
}

TEST(ImplicitContact, FrictionHoldsBelowItsAngleAndGivesWayAbove) {
  // Down a slope of tangent 0.3 with mu 0.5: held but for creep below the friction speed. With mu 0.1 it slides, and
  // drag sets the speed: drag v = g (sin - mu cos).
  const Vec3 down(3, 0, -10);
  for (const double mu : {0.5, 0.1}) {
    const auto m = two_blocks(mu, down);
    auto o = slow(100);
    Implicit s(m, o);
    s.advance_to(0.5);  // settled
    const double before = mean_x(m, s.state().x, base_nodes);
    s.advance_to(0.8);
    const double speed = (mean_x(m, s.state().x, base_nodes) - before) / 0.3;
    if (mu > 0.3)
      EXPECT_LT(std::abs(speed), 1e-5);
    else
      EXPECT_NEAR(speed, (3 - mu * 10) / 100, 0.02 * speed);  // rocking onto its front edge moves the middle a little
  }
}

TEST(ImplicitContact, ABlockDrivenHardDoesNotPassThrough) {
  auto m = two_blocks(0, {0, 0, 0});
  fem::Motion press;
  press.name = "press";
  for (std::size_t i = base_nodes; i < m.mesh.nodes.size(); ++i)
    if (m.mesh.nodes[i].z() > 0.0104 - 1e-9) press.nodes.push_back(std::int32_t(i));
  press.displacement = [](double t) { return Vec3(0, 0, -0.005 * t); };
  m.motions.push_back(press);
  auto o = slow(0);
  o.time_step = 0.25;
  Implicit s(m, o);
  s.advance_to(1);
  EXPECT_FALSE(cut(m, s.state().x));
  const auto seen = s.observe();
  EXPECT_EQ(seen.inverted, 0);
  double pressed = 0;
  for (const auto n : press.nodes) pressed -= seen.reaction[n].z();
  Vec3 borne = Vec3::Zero();
  for (std::size_t i = base_nodes; i < m.mesh.nodes.size(); ++i) borne += seen.contact_force[i];
  EXPECT_GT(pressed, 1);
  EXPECT_NEAR(pressed, borne.z(), 1e-4 * pressed);
}

TEST(ImplicitContact, AStepIsSolvedHoweverLittleOfACorrectionWasFree) {
  // Thrown down hard onto a thin barrier: most of the first corrections is not free of collisions.
  const auto m = two_blocks(0, {0, 0, -2000});
  auto o = slow(100);
  o.barrier_distance = 2e-6;
  o.newton_tolerance = 1e-5;
  NewtonIteration last{};
  double least_clear = 1;
  o.watch = [&](const NewtonIteration& n) { last = n, least_clear = std::min(least_clear, n.clear); };
  Implicit s(m, o);
  for (int k = 1; k <= 10; ++k) {
    s.advance_to(0.05 * k);
    EXPECT_LE(last.length, o.newton_tolerance) << "after " << 0.05 * k << " s";
  }
  EXPECT_LT(least_clear, 0.1);
}

TEST(ImplicitContact, CuttingAtTheStartIsRefusedWithThePlace) {
  auto m = two_blocks(0, {0, 0, -10});
  for (std::size_t i = base_nodes; i < m.mesh.nodes.size(); ++i) m.mesh.nodes[i].z() -= 0.001;
  try {
    Implicit s(m, slow(100));
    FAIL() << "took surfaces that cut each other";
  } catch (const InputError& error) {
    const std::string what = error.what();
    EXPECT_NE(what.find("base and block"), std::string::npos) << what;
    EXPECT_NE(what.find("mm"), std::string::npos) << what;
  }
}

}  // namespace
}  // namespace carus::solve
