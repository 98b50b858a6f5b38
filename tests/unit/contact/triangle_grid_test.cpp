// SPDX-License-Identifier: Apache-2.0
#include "carus/contact/triangle_grid.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <random>

#include "carus/mesh/closest_point.hpp"

namespace carus::contact {
namespace {

/// Every triangle within reach against all triangles; sizes over three orders of magnitude.
TEST(TriangleGrid, ReturnsAllWithinReach) {
  std::mt19937 random(3);
  std::uniform_real_distribution<double> uniform(-1, 1);
  const auto point = [&](double size) -> Vec3 {
    return size * Vec3(uniform(random), uniform(random), uniform(random));
  };
  for (const double reach : {0.001, 0.01, 0.2}) {
    std::vector<Vec3> x;
    mesh::Triangles triangles;
    for (int i = 0; i < 300; ++i) {
      const Vec3 centre = Vec3(0.2, -0.1, 0.05) + point(0.1);
      const double size = std::pow(10.0, uniform(random) - 2);
      for (int k = 0; k < 3; ++k) x.push_back(centre + point(size));
      triangles.push_back({3 * i, 3 * i + 1, 3 * i + 2});
    }
    TriangleGrid grid;
    grid.build(x, triangles, reach);
    std::size_t near_ones = 0, offered = 0;
    for (int q = 0; q < 500; ++q) {
      const Vec3 p = Vec3(0.2, -0.1, 0.05) + point(0.3);  // many outside the grid too
      std::vector<std::int32_t> found;
      const double reach2 = reach * reach;
      grid.for_each_near(p, Vec3::Zero(), reach2, [&](std::int32_t t) { found.push_back(t); });
      std::sort(found.begin(), found.end());
      offered += found.size();
      for (std::int32_t t = 0; t < std::int32_t(triangles.size()); ++t) {
        const Vec3 &a = x[triangles[t][0]], &b = x[triangles[t][1]], &c = x[triangles[t][2]];
        const Vec3 w = mesh::closest_point_weights(p, a, b, c);
        if ((p - (w[0] * a + w[1] * b + w[2] * c)).norm() > reach) continue;
        ++near_ones;
        EXPECT_TRUE(std::binary_search(found.begin(), found.end(), t)) << reach;
      }
    }
    EXPECT_GT(near_ones, 0u);
    EXPECT_GE(offered, near_ones);
  }
}

TEST(TriangleGrid, EmptyFindsNothing) {
  TriangleGrid grid;
  grid.build({}, {}, 0.01);
  grid.for_each_near(Vec3::Zero(), Vec3::Zero(), 1.0, [](std::int32_t) { FAIL(); });
}

/// A search that narrows finds the nearest, from near and from afar.
TEST(TriangleGrid, NarrowingSearchFindsTheNearest) {
  std::mt19937 random(5);
  std::uniform_real_distribution<double> uniform(-1, 1);
  const auto point = [&](double size) -> Vec3 {
    return size * Vec3(uniform(random), uniform(random), uniform(random));
  };
  std::vector<Vec3> x;
  mesh::Triangles triangles;
  for (int i = 0; i < 400; ++i) {
    const Vec3 centre = point(0.1);
    for (int k = 0; k < 3; ++k) x.push_back(centre + point(0.01));
    triangles.push_back({3 * i, 3 * i + 1, 3 * i + 2});
  }
  TriangleGrid grid;
  grid.build(x, triangles, 0.005);
  for (int q = 0; q < 300; ++q) {
    const Vec3 p = point(0.2);
    const auto squared = [&](std::int32_t t) {
      const Vec3 &a = x[triangles[t][0]], &b = x[triangles[t][1]], &c = x[triangles[t][2]];
      const Vec3 w = mesh::closest_point_weights(p, a, b, c);
      return (p - (w[0] * a + w[1] * b + w[2] * c)).squaredNorm();
    };
    double exact = 1, found = 1;
    for (std::int32_t t = 0; t < std::int32_t(triangles.size()); ++t) exact = std::min(exact, squared(t));
    grid.for_each_near(p, Vec3::Zero(), found, [&](std::int32_t t) { found = std::min(found, squared(t)); });
    EXPECT_EQ(found, exact);
  }
}

}  // namespace
}  // namespace carus::contact
