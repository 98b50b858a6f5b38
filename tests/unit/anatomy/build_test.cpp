// SPDX-License-Identifier: Apache-2.0
#ifdef CARUS_WITH_MESHING
#include "carus/meshing/build.hpp"

#include <gtest/gtest.h>

#include <set>

#include "carus/anatomy/sizes.hpp"
#include "carus/meshing/quality_report.hpp"

namespace carus::meshing {
namespace {

using anatomy::Anatomy;
using anatomy::Body;

anatomy::Parameters coarse() {
  anatomy::Parameters p;
  p.mesh = anatomy::mesh_size("coarse");
  return p;
}

void expect_gaps(const Anatomy& a) {
  const auto f = mesh::boundary(a.fetus.mesh), u = mesh::boundary(a.uterus.mesh), b = mesh::boundary(a.abdomen.mesh);
  constexpr double least = 0.3e-3;  // [m] above the reach of contact and of any barrier
  EXPECT_GT(mesh::least_gap(a.fetus.mesh.nodes, f, a.uterus.mesh.nodes, u), least);
  EXPECT_GT(mesh::least_gap(a.uterus.mesh.nodes, u, a.abdomen.mesh.nodes, b), least);
  EXPECT_GT(mesh::least_gap(a.fetus.mesh.nodes, f, a.abdomen.mesh.nodes, b), least);
}

void expect_shapely_tets(const Anatomy& a) {
  for (const Body* body : {&a.fetus, &a.uterus, &a.abdomen})
    for (const auto& [label, q] : quality_report(body->mesh)) {
      EXPECT_GT(q.min_altitude, 1e-3) << anatomy::name_of(label);  // [m] the explicit step's bound, before mass scaling
      EXPECT_LT(q.max_aspect, 25) << anatomy::name_of(label);
    }
}

void expect_names(const Anatomy& a) {
  std::set<std::string> names;
  for (const Body* body : {&a.fetus, &a.uterus, &a.abdomen}) {
    for (const auto& n : body->nodes) {
      EXPECT_FALSE(n.nodes.empty()) << n.name;
      names.insert(n.name);
    }
    for (const auto& t : body->surfaces) {
      EXPECT_FALSE(t.triangles.empty()) << t.name;
      names.insert(t.name);
    }
  }
  for (const char* name : {"skin",        "inner",        "outer",         "push",
                           "contraction", "tone",         "vaginal_canal", "lower_uterus_tie",
                           "vulva",       "point_fundus", "point_lower",   "point_left",
                           "point_right", "back",         "thighs",        "front",
                           "canal",       "cavity",       "bone",          "coccyx",
                           "bed",         "hiatus"})
    EXPECT_TRUE(names.contains(name)) << name;
  EXPECT_EQ(a.uterine_wall.size(), a.uterus.mesh.tets.size());
}

void expect_requested_measures(const Anatomy& a) {
  for (const auto& [key, value] : a.requested) {
    // Facets of 14-17 mm round off edges and tips: twice the 2 mm, and on an angle between edges of 35 mm 7 degrees.
    const double tolerance = key.ends_with("angle") ? 7 * pi / 180 : 4e-3;
    EXPECT_NEAR(a.measured.at(key), value, tolerance) << key;
  }
}

void expect_small(const Anatomy& a) {
  EXPECT_LT(a.fetus.mesh.tets.size() + a.uterus.mesh.tets.size() + a.abdomen.mesh.tets.size(), 27000u);
}

void expect_same_bits(const Body& one, const Body& two) {
  EXPECT_EQ(one.mesh.tets, two.mesh.tets);
  EXPECT_EQ(one.mesh.labels, two.mesh.labels);
  EXPECT_TRUE(one.mesh.nodes == two.mesh.nodes);
}

/// One test, since a test runs in a process of its own and would build the anatomy anew.
TEST(ReferenceAnatomy, IsBuiltAsPromisedAndTwiceTheSame) {
  const Anatomy a = build(coarse());
  expect_gaps(a);
  expect_shapely_tets(a);
  expect_names(a);
  expect_requested_measures(a);
  expect_small(a);
  const Anatomy again = build(coarse());
  expect_same_bits(a.fetus, again.fetus);
  expect_same_bits(a.uterus, again.uterus);
  expect_same_bits(a.abdomen, again.abdomen);
}

}  // namespace
}  // namespace carus::meshing
#endif
