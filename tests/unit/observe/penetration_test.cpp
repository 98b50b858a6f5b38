// SPDX-License-Identifier: Apache-2.0
#include "carus/observe/penetration.hpp"

#include <gtest/gtest.h>

#include <random>

#include "blocks.hpp"

namespace carus::observe {
namespace {

/// Two boxes a gap apart along z; the same boxes then pressed into each other.
fem::Model two_boxes(double gap) {
  fem::Model m;
  test::add_box(m, "a", "low", {-0.02, -0.02, -0.04}, {0.02, 0.02, 0}, 4);
  test::add_box(m, "b", "high", {-0.0133, -0.0121, gap}, {0.0147, 0.0151, 0.03 + gap}, 3);
  m.contact_pairs = {{0, 1}};
  return m;
}

TEST(PenetrationCheck, GapAndDepthOfFlatBoxesAreExact) {
  for (const double gap : {0.003, 0.0002, -0.0002, -0.0017, -0.006}) {
    const auto m = two_boxes(gap);
    const auto p = PenetrationCheck(m, 0.004).check(m.mesh.nodes).front();
    EXPECT_NEAR(p.least_gap, gap, 1e-15) << gap;
    EXPECT_EQ(p.penetrated, gap < 0 ? 16 + 9 : 0)
        << gap;  // 4 x 4 lower nodes of the upper box, 3 x 3 upper ones of the lower
  }
}

TEST(PenetrationCheck, BeyondTheSearchNothingIsFound) {
  const auto m = two_boxes(0.009);
  const auto p = PenetrationCheck(m, 0.004).check(m.mesh.nodes).front();
  EXPECT_EQ(p.least_gap, 0.004);
  EXPECT_EQ(p.node, -1);
}

TEST(PenetrationCheck, AgreesWithPlainBruteForce) {
  auto m = two_boxes(0.001);
  std::mt19937 random(3);
  std::uniform_real_distribution<double> jolt(-0.0004, 0.0004);
  for (auto& x : m.mesh.nodes) x += Vec3(jolt(random), jolt(random), jolt(random));
  const double brute =
      mesh::least_gap(m.mesh.nodes, m.contact_surfaces[0].triangles, m.mesh.nodes, m.contact_surfaces[1].triangles);
  const auto p = PenetrationCheck(m, 0.004).check(m.mesh.nodes).front();
  ASSERT_EQ(p.penetrated, 0);
  EXPECT_NEAR(p.least_gap, brute, 1e-15);
}

TEST(PenetrationCheck, SelfContactIsSeenOnlyWhereTheBodyRunsIntoItself) {
  fem::Model m;
  test::add_box(m, "strip", "wall", {0, 0, 0}, {0.1, 0.01, 0.001}, 12);
  m.contact_pairs = {{0, 0}};
  const PenetrationCheck check(m, 0.002);
  EXPECT_EQ(check.check(m.mesh.nodes).front().penetrated, 0);
  // Rolled up by a full turn and a bit: the ends overlap.
  auto x = m.mesh.nodes;
  for (auto& p : x) {
    const double turn = p.x() / 0.1 * 2.2 * pi, r = 0.015 + p.z();
    p = {r * std::cos(turn), p.y(), r * std::sin(turn)};
  }
  const auto overlap = check.check(x).front();
  EXPECT_GT(overlap.penetrated, 0);
  EXPECT_LT(overlap.least_gap, 0);
  EXPECT_GT(overlap.least_gap, -0.001);  // the strip's thickness
}

TEST(PenetrationCheck, TheSmoothGapForgivesWhatFacetsCutOff) {
  // A shaft of radius 20 mm that just fits its bore: facets of 16 sides stand off the circle by up to 0.38 mm, turned
  // by half a side. In the second case the ring begins a little before the shaft, whose end's rim is then nearer to the
  // ring's flat face than to its bore.
  for (const double begin : {-0.03, -1e-4}) {
    fem::Model m;
    test::add_box(m, "shaft", "shaft", {0, -0.02, -0.02}, {0.04, 0.02, 0.02}, 4);
    test::add_box(m, "ring", "ring", {begin, 0, 0}, {0.07, 1, 1}, 16);
    const double side = 2 * pi / 16;
    constexpr int shaft_nodes = 5 * 5 * 5;
    for (std::size_t i = 0; i < m.mesh.nodes.size(); ++i) {
      Vec3& x = m.mesh.nodes[i];
      if (i < std::size_t(shaft_nodes)) {  // square to disc: rings of the square become circles
        const double r = std::max(std::abs(x.y()), std::abs(x.z()));
        if (r > 0) {
          const double quarter = pi / 4, turn = std::abs(x.y()) >= std::abs(x.z())
                                                    ? (x.y() > 0 ? 0 : pi) + quarter * x.z() / x.y()
                                                    : (x.z() > 0 ? pi / 2 : -pi / 2) - quarter * x.y() / x.z();
          x = {x.x(), r * std::cos(turn), r * std::sin(turn)};
        }
      } else {
        const double r = 0.02 + 0.01 * x.z(), turn = -side * (16 * x.y() + 0.5);  // (x, turn, r) right-handed
        x = {x.x(), r * std::cos(turn), r * std::sin(turn)};
      }
    }
    // The ring is closed by using the nodes at its start for those at its end.
    for (auto& t : m.mesh.tets) {
      for (auto& n : t) {
        if (n >= shaft_nodes && (n - shaft_nodes) / 17 % 17 == 16) n -= 16 * 17;
      }
    }
    m.contact_surfaces[1].triangles = mesh::boundary(m.mesh, [](std::int32_t label) { return label == 1; });
    m.contact_pairs = {{0, 1}};
    const auto p = PenetrationCheck(m, 0.004).check(m.mesh.nodes).front();
    EXPECT_NEAR(p.least_gap, -0.02 * (1 - std::cos(side / 2)), 2e-6);
    // A seventh of that: the sagitta is that of a parabola, not of a circle.
    EXPECT_NEAR(p.least_smooth_gap, 0, 0.00006);
  }
}

}  // namespace
}  // namespace carus::observe
