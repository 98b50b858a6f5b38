// SPDX-License-Identifier: Apache-2.0
#include "carus/mesh/tet_mesh.hpp"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <cmath>

#include "carus/mesh/closest_point.hpp"

namespace carus::mesh {
namespace {

/// A unit cube of five tets; the middle one has label 2, the corners 1.
TetMesh cube() {
  TetMesh m;
  for (int i = 0; i < 8; ++i) m.nodes.emplace_back(i & 1, (i >> 1) & 1, (i >> 2) & 1);
  m.tets = {{0, 1, 2, 4}, {3, 2, 1, 7}, {5, 4, 7, 1}, {6, 7, 4, 2}, {1, 7, 2, 4}};
  m.labels = {1, 1, 1, 1, 2};
  for (std::size_t e = 0; e < m.tets.size(); ++e)
    if (volume(m, e) < 0) std::swap(m.tets[e][2], m.tets[e][3]);
  return m;
}

double enclosed(const TetMesh& m, const Triangles& s) {
  double v = 0;  // divergence theorem: positive only if outward oriented
  for (const auto& t : s) v += m.nodes[t[0]].dot(m.nodes[t[1]].cross(m.nodes[t[2]])) / 6;
  return v;
}

TEST(Boundary, EnclosesItsTetsOutward) {
  const auto m = cube();
  double total = 0;
  for (std::size_t e = 0; e < m.tets.size(); ++e) total += volume(m, e);
  EXPECT_NEAR(total, 1, 1e-14);
  EXPECT_EQ(boundary(m).size(), 12u);
  EXPECT_NEAR(enclosed(m, boundary(m)), 1, 1e-14);
  const auto middle = boundary(m, [](std::int32_t l) { return l == 2; });
  EXPECT_EQ(middle.size(), 4u);
  EXPECT_NEAR(enclosed(m, middle), volume(m, 4), 1e-14);
  EXPECT_EQ(nodes_of(middle).size(), 4u);
}

TEST(Quality, OfTheRegularTet) {
  TetMesh m{{{1, 1, 1}, {1, -1, -1}, {-1, 1, -1}, {-1, -1, 1}}, {{0, 1, 2, 3}}, {1}};
  if (volume(m, 0) < 0) std::swap(m.tets[0][0], m.tets[0][1]);
  const auto q = quality(m, 0);
  const double dihedral = std::acos(1.0 / 3) * 180 / pi, edge = std::sqrt(8.0);
  EXPECT_NEAR(q.min_dihedral_deg, dihedral, 1e-10);
  EXPECT_NEAR(q.max_dihedral_deg, dihedral, 1e-10);
  EXPECT_NEAR(q.min_altitude, edge * std::sqrt(2.0 / 3), 1e-12);
  EXPECT_NEAR(q.aspect, std::sqrt(1.5), 1e-12);
}

TEST(ClosestPoint, AgreesWithSamplingOfTheTriangle) {
  const Vec3 a(0, 0, 0), b(2, 0.3, -0.2), c(0.4, 1.5, 0.6);
  for (int i = 0; i < 200; ++i) {
    const Vec3 p(3 * std::sin(1.7 * i), 3 * std::sin(2.9 * i + 1), 2 * std::sin(4.1 * i + 2));
    const Vec3 w = closest_point_weights(p, a, b, c);
    EXPECT_NEAR(w.sum(), 1, 1e-12);
    EXPECT_GE(w.minCoeff(), -1e-12);
    const double d = (p - w[0] * a - w[1] * b - w[2] * c).norm();
    for (int u = 0; u <= 20; ++u)
      for (int v = 0; u + v <= 20; ++v) EXPECT_LE(d, (p - a - u / 20.0 * (b - a) - v / 20.0 * (c - a)).norm() + 1e-12);
  }
}

TEST(LeastGap, OfShiftedCubes) {
  const auto m = cube();
  const auto s = boundary(m);
  auto shifted = m.nodes;
  for (auto& x : shifted) x += Vec3(1.25, 0.3, -0.4);
  EXPECT_NEAR(least_gap(m.nodes, s, shifted, s), 0.25, 1e-12);
}

}  // namespace
}  // namespace carus::mesh
