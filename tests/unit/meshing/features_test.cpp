// SPDX-License-Identifier: Apache-2.0
// Lines that a mesh keeps, against bodies whose volume a cut corner would change.
#ifdef CARUS_WITH_MESHING
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <set>

#include "carus/meshing/labelled_solid.hpp"
#include "carus/meshing/quality_report.hpp"
#include "carus/meshing/raise_altitudes.hpp"
#include "support/closed_shapes.hpp"

namespace carus::meshing {
namespace {

constexpr double h = 0.006;

mesh::TetMesh meshed(const LabelFunction& solid, const Sphere& bounds, const std::vector<mesh::FeatureLine>& lines) {
  auto m = mesh_labelled_solid(solid, bounds,
                               {.facet = [](const Vec3&, std::int32_t, std::int32_t) { return h; },
                                .distance = [](const Vec3&, std::int32_t, std::int32_t) { return 0.1 * h; },
                                .cell = [](const Vec3&, std::int32_t) { return 1.3 * h; },
                                .seed_spacing = 0.6 * h,
                                .features = lines});
  raise_altitudes(m, 0.25 * h, lines.empty() ? 0.0004 : 0);
  return m;
}

/// Length of the mesh's edges that lie on a line.
double covered(const mesh::TetMesh& m, const mesh::FeatureLine& line) {
  const Vec3 a = line.points.front(), u = (line.points.back() - a).normalized();
  const double whole = (line.points.back() - a).norm();
  const auto on = [&](const Vec3& x) {
    const double along = u.dot(x - a);
    return along > -1e-9 && along < whole + 1e-9 && (x - a - along * u).norm() < 1e-9;
  };
  std::set<std::pair<std::int32_t, std::int32_t>> edges;
  for (const auto& t : m.tets)
    for (int i = 0; i < 4; ++i)
      for (int j = i + 1; j < 4; ++j)
        if (on(m.nodes[t[i]]) && on(m.nodes[t[j]])) edges.insert(std::minmax(t[i], t[j]));
  double sum = 0;
  for (const auto& [i, j] : edges) sum += (m.nodes[i] - m.nodes[j]).norm();
  return sum;
}

TEST(FeatureEdges, TwoBoxesThatTouchKeepTheirEdgesAndVolumes) {
  const Vec3 top_low{0.01, 0.01, 0.02}, top_high{0.03, 0.03, 0.035};
  const auto lower = test::box_surface({0, 0, 0}, {0.04, 0.04, 0.02}), upper = test::box_surface(top_low, top_high);
  const auto solid = [&](const Vec3& x) {
    const auto within = [&](const Vec3& low, const Vec3& high) {
      return (x.array() > low.array()).all() && (x.array() < high.array()).all();
    };
    return within({0, 0, 0}, {0.04, 0.04, 0.02}) ? 1 : within(top_low, top_high) ? 2 : 0;
  };
  const Sphere bounds{{0.02, 0.02, 0.0175}, 0.04};
  const auto lines = mesh::feature_lines({{&lower, h}, {&upper, h}}, pi / 3);
  ASSERT_EQ(lines.size(), 24u);
  const auto kept = meshed(solid, bounds, lines), cut = meshed(solid, bounds, {});
  for (const auto& line : lines)
    EXPECT_NEAR(covered(kept, line), (line.points.back() - line.points.front()).norm(), 1e-6);
  const auto volumes = quality_report(kept), without = quality_report(cut);
  // On planes the surface's points are within CGAL's bisection, 1e-6 of the bounds.
  EXPECT_NEAR(volumes.at(1).volume, 32e-6, 1e-4 * 32e-6);
  EXPECT_NEAR(volumes.at(2).volume, 6e-6, 1e-4 * 6e-6);
  EXPECT_LT(without.at(1).volume, 0.995 * 32e-6);  // what is lost where corners and edges are cut
  for (const auto& [label, q] : volumes) EXPECT_GT(q.min_dihedral_deg, 5) << label;
}

TEST(FeatureEdges, PartsThatNoFeatureTouchesAreFoundToo) {
  const auto box = test::box_surface({0, 0, 0}, {0.02, 0.02, 0.02});
  const Vec3 centre{0.07, 0.01, 0.01};
  const auto solid = [&](const Vec3& x) {
    if ((x - centre).norm() < 0.01) return 2;
    return (x.array() > 0).all() && (x.array() < 0.02).all() ? 1 : 0;
  };
  const auto m = meshed(solid, {{0.04, 0.01, 0.01}, 0.06}, mesh::feature_lines({{&box, h}}, pi / 3));
  const auto volumes = quality_report(m);
  ASSERT_TRUE(volumes.contains(2));
  EXPECT_NEAR(volumes.at(1).volume, 8e-6, 1e-4 * 8e-6);
  // Facets lie within the ball by a tenth of h at the most: 0.6 mm of a radius of 10 mm.
  EXPECT_NEAR(volumes.at(2).volume, 4 * pi / 3 * 1e-6, 3 * 0.06 * 4 * pi / 3 * 1e-6);
}

}  // namespace
}  // namespace carus::meshing
#endif
