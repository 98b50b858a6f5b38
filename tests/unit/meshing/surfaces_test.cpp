// SPDX-License-Identifier: Apache-2.0
// Distances between surfaces, simplification, thickness and closed solids, against shapes whose answers are known.
#ifdef CARUS_WITH_MESHING
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "carus/core/error.hpp"
#include "carus/meshing/closed_solid.hpp"
#include "carus/meshing/precision.hpp"
#include "carus/meshing/simplify.hpp"
#include "support/closed_shapes.hpp"

namespace carus::meshing {
namespace {

using test::box_surface;
using test::sphere_surface;

TEST(SurfaceDistance, ConcentricSpheresAreTheirRadiiApart) {
  // Facets of edge h lie inside their sphere by up to h^2/(6R) = 0.01 mm here: that is the tolerance.
  const auto inner = sphere_surface({0, 0, 0}, 0.050, 5), outer = sphere_surface({0, 0, 0}, 0.053, 5);
  const auto d = compare(Distances(outer), inner, 20000);
  for (const auto* way : {&d.forward, &d.backward}) {
    EXPECT_NEAR(way->mean, 0.003, 1e-5);
    EXPECT_NEAR(way->rms, 0.003, 1e-5);
    EXPECT_NEAR(way->percentile_95, 0.003, 1e-5);
    EXPECT_NEAR(way->largest, 0.003, 2e-5);
  }
}

TEST(SurfaceDistance, OneSidedDifferencesShowInOneDirection) {
  // A box with a tower on it: from the tower's top it is 40 mm to the bare box, from the box nowhere more than to the
  // tower's walls.
  const auto box = box_surface({0, 0, 0}, {0.1, 0.1, 0.01}), tall = box_surface({0, 0, 0}, {0.1, 0.1, 0.05});
  const auto d = compare(Distances(tall), box, 50000);
  EXPECT_NEAR(d.forward.largest, 0.04, 1e-9);   // its nodes are among what is measured
  EXPECT_NEAR(d.backward.largest, 0.01, 1e-6);  // from the middle of the box' top to the tall one's bottom
  EXPECT_GT(d.forward.mean, 0.5 * d.forward.largest * 0.1 * 0.1 / mesh::area(tall));
}

TEST(SurfaceDistance, SamplesAreEvenByArea) {
  const auto s = box_surface({0, 0, 0}, {0.1, 0.2, 0.3});
  const auto points = sample(s, 10000);
  EXPECT_NEAR(double(points.size()), 10000, 1);
  std::size_t on_top = 0;
  for (const auto& x : points) on_top += x.z() == 0.3;
  EXPECT_NEAR(double(on_top) / 10000, 0.1 * 0.2 / mesh::area(s), 2e-4);  // a point more or less for each triangle
}

TEST(Simplification, OnePassGivesEveryCountAndKeepsShapeAndVolume) {
  const auto s = sphere_surface({0.01, 0.02, 0.03}, 0.05, 5);  // 10,242 nodes
  const auto states = simplify(s, {20000, 5000, 1000, 200});
  ASSERT_EQ(states.size(), 4u);
  EXPECT_EQ(states[0].nodes.size(), s.nodes.size());
  const std::array<std::size_t, 4> counts{s.nodes.size(), 5000, 1000, 200};
  for (std::size_t i = 0; i < 4; ++i) {
    EXPECT_EQ(states[i].nodes.size(), counts[i]);
    EXPECT_TRUE(mesh::closed(states[i], "state").repairs.empty());
    EXPECT_NO_THROW(require_no_self_intersection(states[i], "state"));
    EXPECT_NEAR(mesh::volume(states[i]) / mesh::volume(s), 1, 1e-3);  // it is made to keep the volume
  }
  // 200 nodes: edges of about sqrt(4 pi R^2 / 200 * 2/sqrt 3) = 13.5 mm, sagitta h^2/(6R) = 0.6 mm.
  EXPECT_LT(compare(Distances(s), states[3], 20000).largest(), 0.0012);
}

TEST(Simplification, AnErrorBoundIsKeptAndUsed) {
  const auto s = sphere_surface({0, 0, 0}, 0.05, 4);
  const auto coarse = simplify_within(s, 0.0005);
  const double largest = compare(Distances(s), coarse).largest();
  EXPECT_LE(largest, 0.0005);
  EXPECT_GT(largest, 0.00035);
  EXPECT_LT(coarse.nodes.size(), s.nodes.size() / 5);
}

TEST(Simplification, ThinShellsKeepWhatWouldCutThroughItself) {
  auto shell = sphere_surface({0, 0, 0}, 0.05, 4);  // and a cavity in it
  const auto inner = sphere_surface({0.0004, 0, 0}, 0.049, 4);
  const auto n = std::int32_t(shell.nodes.size());
  shell.nodes.insert(shell.nodes.end(), inner.nodes.begin(), inner.nodes.end());
  for (const auto& t : inner.triangles) shell.triangles.push_back({n + t[0], n + t[2], n + t[1]});
  ASSERT_FALSE(self_intersections(simplify(shell, {600})[0]).empty());
  const auto sound = simplify_soundly(shell, 600);
  EXPECT_TRUE(self_intersections(sound).empty());
  EXPECT_LT(sound.nodes.size(), shell.nodes.size() / 2);
  EXPECT_NEAR(mesh::volume(sound) / mesh::volume(shell), 1, 0.01);
}

TEST(Simplification, WhatCutsThroughItselfIsRefused) {
  auto two = sphere_surface({0, 0, 0}, 0.02, 3);
  const auto other = sphere_surface({0.03, 0, 0}, 0.02, 3);
  const auto n = std::int32_t(two.nodes.size());
  two.nodes.insert(two.nodes.end(), other.nodes.begin(), other.nodes.end());
  for (const auto& t : other.triangles) two.triangles.push_back({n + t[0], n + t[1], n + t[2]});
  try {
    static_cast<void>(simplify_soundly(two, 300));
    FAIL();
  } catch (const NumericalFailure& e) {
    EXPECT_THAT(e.what(), testing::HasSubstr("triangles of the surface itself cut through each other, first near (1"));
  }
}

TEST(Precision, AlphaIsThePapers) {
  PrecisionRow r;
  r.deviation.forward.mean = 0.0005, r.deviation.backward.mean = 0.001;
  EXPECT_NEAR(r.alpha(0.005), 80, 1e-12);
  const auto p = precision(Distances(sphere_surface({0, 0, 0}, 0.05, 4)), {0.9, 0.5}, 20000);
  ASSERT_EQ(p.rows.size(), 2u);
  EXPECT_EQ(p.rows[0].reduction, 0.5);
  EXPECT_EQ(p.rows[0].nodes, 1281u);
  EXPECT_LT(p.rows[0].deviation.mean(), p.rows[1].deviation.mean());
}

TEST(Thickness, OfAPlateAndAShell) {
  const Distances plate(box_surface({0, 0, 0}, {0.2, 0.006, 0.2}));
  EXPECT_NEAR(iliac_wing_thickness(plate).median, 0.006, 1e-9);
  EXPECT_NEAR(thin_part_thickness(plate).median, 0.006, 1e-9);
  auto shell = sphere_surface({0, 0, 0}, 0.05, 4);
  const auto inside = sphere_surface({0, 0, 0}, 0.044, 4);
  const auto n = std::int32_t(shell.nodes.size());
  shell.nodes.insert(shell.nodes.end(), inside.nodes.begin(), inside.nodes.end());
  for (const auto& t : inside.triangles) shell.triangles.push_back({t[0] + n, t[2] + n, t[1] + n});
  EXPECT_NEAR(thin_part_thickness(Distances(shell)).median, 0.006, 1e-4);  // facets' sagitta
}

TEST(ClosedSolid, KnowsInsideAndDistance) {
  const ClosedSolid s(sphere_surface({0.01, 0, 0}, 0.05, 4));
  EXPECT_TRUE(s.contains({0.055, 0, 0}));
  EXPECT_FALSE(s.contains({0.065, 0, 0}));
  EXPECT_NEAR(s.distance({0.01, 0.08, 0}), 0.03, 1e-4);
  EXPECT_NEAR(s.distance({0.01, 0.02, 0}), -0.03, 1e-4);
}

TEST(ClosedSolid, SurfacesThatCutThemselvesAreRefusedWithThePlace) {
  auto s = box_surface({0, 0, 0}, {0.02, 0.02, 0.02});
  EXPECT_NO_THROW(require_no_self_intersection(s, "box"));
  const auto other = box_surface({0.01, 0.01, 0.01}, {0.03, 0.03, 0.03});
  s.nodes.insert(s.nodes.end(), other.nodes.begin(), other.nodes.end());
  for (const auto& t : other.triangles) s.triangles.push_back({t[0] + 8, t[1] + 8, t[2] + 8});
  try {
    require_no_self_intersection(s, "boxes");
    ADD_FAILURE();
  } catch (const InputError& e) {
    EXPECT_THAT(e.what(), testing::HasSubstr("boxes: "));
    EXPECT_THAT(e.what(), testing::HasSubstr("pairs of triangles cut through each other, the first at ("));
  }
}

}  // namespace
}  // namespace carus::meshing
#endif
