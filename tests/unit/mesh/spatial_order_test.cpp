// SPDX-License-Identifier: Apache-2.0
#include "carus/mesh/spatial_order.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <random>
#include <vector>

namespace {

using carus::Vec3;
using carus::mesh::TetMesh;

/// Random tets of label 0 to 2 on shuffled lattice points.
TetMesh shuffled() {
  TetMesh m;
  for (int i = 0; i < 12; ++i)
    for (int j = 0; j < 12; ++j)
      for (int k = 0; k < 12; ++k) m.nodes.emplace_back(i, j, k);
  std::mt19937 random(5);
  std::shuffle(m.nodes.begin(), m.nodes.end(), random);
  std::map<std::array<int, 3>, std::int32_t> at;
  for (std::size_t n = 0; n < m.nodes.size(); ++n)
    at[{int(m.nodes[n].x()), int(m.nodes[n].y()), int(m.nodes[n].z())}] = std::int32_t(n);
  for (const auto& [p, n] : at) {
    const auto [i, j, k] = p;
    if (i == 11 || j == 11 || k == 11) continue;
    m.tets.push_back({n, at[{i + 1, j, k}], at[{i, j + 1, k}], at[{i, j, k + 1}]});
    m.labels.push_back((i + 2 * j) % 3);
  }
  std::shuffle(m.tets.begin(), m.tets.end(), random);  // labels now say nothing but how many there are
  return m;
}

double mean_index_distance(const TetMesh& m) {
  double sum = 0;
  for (const auto& t : m.tets)
    for (int k = 1; k < 4; ++k) sum += std::abs(t[k] - t[0]);
  return sum / (3 * double(m.tets.size()));
}

/// Corner positions and label of every tet, in an order of their own.
auto shape(const TetMesh& m) {
  std::multimap<std::vector<double>, int> tets;
  for (std::size_t e = 0; e < m.tets.size(); ++e) {
    std::vector<double> corners;
    for (const auto n : m.tets[e]) corners.insert(corners.end(), m.nodes[n].data(), m.nodes[n].data() + 3);
    tets.emplace(corners, m.labels[e]);
  }
  return tets;
}

}  // namespace

TEST(SpatialOrder, LeavesTheMeshAsItIs) {
  const TetMesh before = shuffled();
  TetMesh after = before;
  carus::mesh::order_spatially(after);
  EXPECT_EQ(shape(after), shape(before));
}

TEST(SpatialOrder, BringsNeighboursTogetherInMemory) {
  TetMesh m = shuffled();
  const double before = mean_index_distance(m);
  carus::mesh::order_spatially(m);
  EXPECT_GT(before, 500);  // of 1728 nodes, a third at random
  EXPECT_LT(mean_index_distance(m), before / 4);
}

TEST(SpatialOrder, EqualPointsKeepTheirOrder) {
  EXPECT_EQ(carus::mesh::z_order({Vec3(1, 0, 0), Vec3(0, 0, 0), Vec3(1, 0, 0), Vec3(0, 0, 0)}),
            (std::vector<std::int32_t>{1, 3, 0, 2}));
  EXPECT_EQ(carus::mesh::z_order({Vec3(1, 2, 3), Vec3(1, 2, 3)}), (std::vector<std::int32_t>{0, 1}));
  EXPECT_TRUE(carus::mesh::z_order({}).empty());
}
