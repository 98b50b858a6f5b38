// SPDX-License-Identifier: Apache-2.0
#include "carus/contact/potential.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "carus/contact/ccd.hpp"
#include "carus/contact/intersection.hpp"
#include "support/shapes.hpp"

namespace carus::contact {
namespace {

std::mt19937 dice(7);
double roll() { return 2.0 * double(dice()) / double(dice.max()) - 1; }
Vec3 anywhere() { return {roll(), roll(), roll()}; }

TEST(Barrier, DerivativesAndSmoothEnd) {
  const Barrier b{1e-3, 5e4};
  for (const double d : {1e-5, 2e-4, 7e-4, 9.9e-4}) {
    const double h = 1e-5 * d;
    EXPECT_NEAR((b.value(d + h) - b.value(d - h)) / (2 * h), b.first(d), 1e-5 * std::abs(b.first(d)) + 1e-6);
    EXPECT_NEAR((b.first(d + h) - b.first(d - h)) / (2 * h), b.second(d), 1e-4 * b.second(d) + 1);
    EXPECT_LT(b.first(d), 0);
    EXPECT_GT(b.second(d), 0);
  }
  const double near = 1e-3 * (1 - 1e-6);  // C2: all three vanish there
  EXPECT_LT(b.value(near), 1e-12);
  EXPECT_LT(-b.first(near), 1e-6);
  EXPECT_LT(b.second(near), 1e-5 * 5e4 / 1e-3);
}

TEST(Distance, NearestPointsAreNoFurtherThanAnySample) {
  for (int k = 0; k < 200; ++k) {
    const Corners x{anywhere(), anywhere(), anywhere(), anywhere()};
    const double edge = between(nearest_edge_edge(x), x).norm(), face = between(nearest_point_triangle(x), x).norm();
    double least_edge = 1e9, least_face = 1e9;
    for (int i = 0; i <= 40; ++i)
      for (int j = 0; j <= 40; ++j) {
        const double s = i / 40.0, t = j / 40.0;
        least_edge = std::min(least_edge, (x[0] + s * (x[1] - x[0]) - x[2] - t * (x[3] - x[2])).norm());
        if (s + t <= 1) least_face = std::min(least_face, (x[0] - x[1] - s * (x[2] - x[1]) - t * (x[3] - x[1])).norm());
      }
    EXPECT_LE(edge, least_edge + 1e-12);
    EXPECT_GE(edge, least_edge - 0.09);  // the samples' spacing on edges up to 3.5 long
    EXPECT_LE(face, least_face + 1e-12);
    EXPECT_GE(face, least_face - 0.09);
  }
}

TEST(ConservativeStep, StopsShortOfTheCollisionAndNearIt) {
  // A point falls on a triangle 1 below; edges that cross meet after half of the way.
  const Corners face{Vec3(0.2, 0.2, 1), Vec3(0, 0, 0), Vec3(1, 0, 0), Vec3(0, 1, 0)};
  const Corners fall{Vec3(0, 0, -4), Vec3::Zero(), Vec3::Zero(), Vec3::Zero()};
  const double t = conservative_step(face, fall, false, 1);
  EXPECT_LE(t, 0.25 * 0.9 + 1e-9);  // a tenth of the distance is left
  EXPECT_GE(t, 0.25 * 0.8);
  const Corners edges{Vec3(-1, 0, 1), Vec3(1, 0, 1), Vec3(0, -1, 0), Vec3(0, 1, 0)};
  const Corners meet{Vec3(0, 0, -1), Vec3(0, 0, -1), Vec3(0, 0, 1), Vec3(0, 0, 1)};
  const double s = conservative_step(edges, meet, true, 1);
  EXPECT_LE(s, 0.45 + 1e-9);
  EXPECT_GE(s, 0.4);
  // What moves together or away is free.
  EXPECT_EQ(conservative_step(edges, {meet[0], meet[0], meet[0], meet[0]}, true, 1), 1);
  EXPECT_EQ(conservative_step(face, {Vec3(0, 0, 5), Vec3::Zero(), Vec3::Zero(), Vec3::Zero()}, false, 1), 1);
}

TEST(ConservativeStep, NeverPassesThrough) {
  int hits = 0;
  for (int k = 0; k < 3000; ++k) {
    const bool edges = k % 2 == 0;
    const Corners x{anywhere(), anywhere(), anywhere(), anywhere()},
        p{2 * anywhere(), 2 * anywhere(), 2 * anywhere(), 2 * anywhere()};
    const auto distance = [&](double t) {
      Corners y;
      for (int i = 0; i < 4; ++i) y[i] = x[i] + t * p[i];
      return between(edges ? nearest_edge_edge(y) : nearest_point_triangle(y), y).norm();
    };
    const double t = conservative_step(x, p, edges, 1);
    ASSERT_GT(t, 0);
    hits += t < 1;
    for (int i = 0; i <= 50; ++i) EXPECT_GT(distance(t * i / 50), 0.099 * distance(0) * 0.9) << k;
  }
  EXPECT_GT(hits, 100);  // there was something to stop at
}

TEST(TriangleTree, FindsWhatBruteForceFinds) {
  const auto mesh = shapes::ball(Vec3::Zero(), 0.03, 6);
  const auto skin = mesh::boundary(mesh);
  TriangleTree tree(skin, mesh.nodes);
  auto x = mesh.nodes;
  for (Vec3& p : x) p += 0.01 * anywhere();
  tree.refit(skin, x, x);
  for (int k = 0; k < 50; ++k) {
    TriangleTree::Box query(0.03 * anywhere());
    query.extend(query.min() + Vec3(0.008, 0.004, 0.01));
    std::vector<int> found, expected;
    tree.for_each(query, [&](std::int32_t t) { found.push_back(t); });
    for (std::size_t t = 0; t < skin.size(); ++t) {
      TriangleTree::Box box;
      for (const auto n : skin[t]) box.extend(x[n]);
      if (box.intersects(query)) expected.push_back(int(t));
    }
    std::sort(found.begin(), found.end());
    EXPECT_EQ(found, expected);
  }
}

/// Two balls a little apart, and one of them against itself.
struct Balls {
  mesh::TetMesh mesh =
      shapes::join(shapes::ball(Vec3::Zero(), 0.02, 5, 0), shapes::ball({0.003, 0.002, 0.0402}, 0.02, 6, 1));
  std::vector<Side> sides;
  std::vector<Touching> pairs{{0, 1, 0.3}, {0, 0, 0}};
  Balls() {
    for (int k = 0; k < 2; ++k)
      sides.push_back({k ? "b" : "a", mesh::boundary(mesh, [k](std::int32_t l) { return l == k; })});
  }
  BarrierPotential potential() const {
    return {sides, pairs, mesh.nodes, std::vector<std::uint8_t>(mesh.nodes.size(), 1), {2e-3, 5e4}};
  }
};

TEST(BarrierPotential, GradientIsTheDerivativeOfTheEnergy) {
  const Balls balls;
  auto potential = balls.potential();
  auto x = balls.mesh.nodes;
  for (Vec3& p : x) p += 1e-4 * anywhere();
  potential.begin_step(balls.mesh.nodes, 1e-4);
  std::vector<Vec3> u(x.size()), g(x.size(), Vec3::Zero());
  for (Vec3& v : u) v = anywhere();
  const auto energy = [&](double h) {
    auto y = x;
    for (std::size_t i = 0; i < y.size(); ++i) y[i] += h * u[i];
    return potential.energy(y) + potential.friction_energy(y);
  };
  ASSERT_GT(potential.energy(x), 0);
  ASSERT_GT(potential.friction_energy(x), potential.friction_energy(balls.mesh.nodes));
  potential.add_gradient(x, g);
  potential.add_friction_gradient(x, g);
  double slope = 0;
  for (std::size_t i = 0; i < g.size(); ++i) slope += g[i].dot(u[i]);
  ASSERT_GT(std::abs(slope), 1e-3);
  const auto error = [&](double h) { return std::abs((energy(h) - energy(-h)) / (2 * h) - slope); };
  EXPECT_LT(error(1e-8), 1e-5 * std::abs(slope));
  EXPECT_NEAR(std::log(error(4e-6) / error(1e-6)) / std::log(4.0), 2,
              0.6);  // C1 friction and distances: not quite clean
  Vec3 sum = Vec3::Zero();
  for (const Vec3& f : g) sum += f;
  EXPECT_LT(sum.norm(), 1e-9);
}

TEST(BarrierPotential, HessianPushesAlongTheNormalsAndIsPositive) {
  const Balls balls;
  auto potential = balls.potential();
  potential.linearise(balls.mesh.nodes);
  ASSERT_GT(potential.active(), 10u);
  // Bringing the balls nearer along their line: the derivative of the total force, but for the turning of the normals.
  std::vector<Vec3> u(balls.mesh.nodes.size(), Vec3::Zero()), Hu = u, a = u, b = u;
  const Vec3 line = Vec3(0.003, 0.002, 0.0402).normalized();
  const auto second = mesh::nodes_of(balls.sides[1].triangles);
  for (const auto n : second) u[n] = -line;
  potential.add_product(u, Hu);
  double product = 0;
  for (std::size_t i = 0; i < u.size(); ++i) product += u[i].dot(Hu[i]);
  const double h = 1e-7;
  auto x = balls.mesh.nodes;
  for (const auto n : second) x[n] -= h * line;
  const double e1 = potential.energy(x);
  for (const auto n : second) x[n] += 2 * h * line;
  const double e2 = potential.energy(x), e0 = potential.energy(balls.mesh.nodes);
  const double exact = (e1 + e2 - 2 * e0) / (h * h);
  EXPECT_GT(product, 0);
  EXPECT_NEAR(product, exact, 0.3 * exact);  // the normals turn where facets meet obliquely
}

TEST(BarrierPotential, StopsBodiesThatFlyAtEachOther) {
  const Balls balls;
  auto potential = balls.potential();
  std::vector<Vec3> p(balls.mesh.nodes.size(), Vec3::Zero());
  for (const auto n : mesh::nodes_of(balls.sides[1].triangles)) p[n] = Vec3(0, 0, -0.005);
  const double t = potential.conservative_step(balls.mesh.nodes, p);
  EXPECT_GT(t, 0.001);
  EXPECT_LT(t, 0.5);
  auto x = balls.mesh.nodes;
  for (std::size_t i = 0; i < x.size(); ++i) x[i] += t * p[i];
  EXPECT_TRUE(intersections(balls.sides, balls.pairs, x).empty());
  for (std::size_t i = 0; i < x.size(); ++i) x[i] += (1 - t) * p[i];
  EXPECT_FALSE(intersections(balls.sides, balls.pairs, x).empty());
}

TEST(Orientation, IsExactWhereRoundingIsNot) {
  // Coplanar but for the last bit, in a plane whose equation does not fit in doubles.
  const Vec3 a(0.1, 0.2, 0.3), b(0.7, 0.1, 0.9), c(0.4, 0.8, 0.35);
  const Vec3 middle = 0.25 * a + 0.25 * b + 0.5 * c;
  int signs[3] = {0, 0, 0};
  for (int k = -2; k <= 2; ++k) {
    Vec3 p = middle;
    for (int i = 0; i < std::abs(k); ++i) p.z() = std::nextafter(p.z(), k * 1e3);
    const int s = orientation(a, b, c, p);
    EXPECT_EQ(s, -orientation(b, a, c, p));
    EXPECT_EQ(s, orientation(b, c, a, p));
    ++signs[s + 1];
  }
  EXPECT_GT(signs[0], 0);
  EXPECT_GT(signs[2], 0);
  EXPECT_EQ(orientation(a, b, c, a), 0);
}

TEST(Intersect, SegmentsAndTriangles) {
  const Vec3 a(0, 0, 0), b(1, 0, 0), c(0, 1, 0);
  EXPECT_TRUE(intersect({0.2, 0.2, -1}, {0.2, 0.2, 1}, a, b, c));
  EXPECT_FALSE(intersect({0.8, 0.8, -1}, {0.8, 0.8, 1}, a, b, c));
  EXPECT_FALSE(intersect({0.2, 0.2, 1e-300}, {0.2, 0.2, 1}, a, b, c));
  EXPECT_TRUE(intersect({0.2, 0.2, 0}, {0.2, 0.2, 1}, a, b, c));  // touches
  EXPECT_TRUE(intersect({-1, 0.2, 0}, {2, 0.2, 0}, a, b, c));     // in the plane, across
  EXPECT_TRUE(intersect({0.1, 0.2, 0}, {0.2, 0.2, 0}, a, b, c));  // in the plane, inside
  EXPECT_FALSE(intersect({-1, 0.2, 0}, {-0.1, 0.2, 0}, a, b, c));
  EXPECT_FALSE(intersect({2, 0, 0}, {3, 0, 0}, a, b, c));  // on the line of an edge, beyond it
}

}  // namespace
}  // namespace carus::contact
