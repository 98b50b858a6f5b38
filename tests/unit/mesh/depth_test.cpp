// SPDX-License-Identifier: Apache-2.0
#include "carus/mesh/depth.hpp"

#include <gtest/gtest.h>

#include "carus/mesh/shapes.hpp"

namespace carus::mesh {
namespace {

TEST(Depth, ABoxWhoseEndStandsInAnother) {
  const auto all = [](std::int32_t) { return true; };
  const auto block = shapes::box({0, 0, 0}, {0.1, 0.1, 0.1}, 5, 5, 5);
  const auto bar = shapes::box({0.04, 0.05, 0.093}, {0.01, 0.01, 0.05}, 1, 1, 2);
  const auto d = deepest(bar, all, block, all);
  EXPECT_NEAR(d.depth, 0.007, 1e-12);
  EXPECT_NEAR(d.where.z(), 0.093, 1e-12);
  EXPECT_NEAR(deepest(block, all, bar, all).depth, 0, 1e-12);  // two of its nodes lie on the edges of the bar
}

TEST(Depth, OnlyWhatIsSelectedCounts) {
  const auto all = [](std::int32_t) { return true; };
  auto block = shapes::box({0, 0, 0}, {0.1, 0.1, 0.1}, 10, 10, 10);
  for (std::size_t e = 0; e < block.tets.size(); ++e) {
    Vec3 centre = Vec3::Zero();
    for (const auto i : block.tets[e]) centre += block.nodes[i] / 4;
    block.labels[e] = centre.z() > 0.05 ? 1 : 0;
  }
  const auto bar = shapes::box({0.042, 0.042, 0.013}, {0.01, 0.01, 0.02}, 1, 1, 1, 7);
  EXPECT_EQ(deepest(bar, all, block, [](std::int32_t l) { return l == 1; }).depth, 0);
  EXPECT_NEAR(deepest(bar, all, block, [](std::int32_t l) { return l == 0; }).depth, 0.017, 1e-12);
  EXPECT_EQ(deepest(
                bar, [](std::int32_t l) { return l == 1; }, block, all)
                .depth,
            0);
}

}  // namespace
}  // namespace carus::mesh
