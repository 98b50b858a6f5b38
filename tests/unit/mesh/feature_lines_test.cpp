// SPDX-License-Identifier: Apache-2.0
#include "carus/mesh/feature_lines.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "support/closed_shapes.hpp"

namespace carus::mesh {
namespace {

double length(const std::vector<FeatureLine>& lines) {
  double sum = 0;
  for (const auto& line : lines) sum += length(line);
  return sum;
}

/// A closed cylinder along z of `sides` sides.
Surface cylinder(double radius, double height, int sides) {
  Surface s;
  for (int i = 0; i < sides; ++i)
    for (const double z : {0.0, height})
      s.nodes.emplace_back(radius * std::cos(2 * pi * i / sides), radius * std::sin(2 * pi * i / sides), z);
  s.nodes.emplace_back(0, 0, 0), s.nodes.emplace_back(0, 0, height);
  for (int i = 0; i < sides; ++i) {
    const int a = 2 * i, b = 2 * ((i + 1) % sides);
    for (const Triangle& t :
         {Triangle{a, b, b + 1}, {a, b + 1, a + 1}, {2 * sides, b, a}, {2 * sides + 1, a + 1, b + 1}})
      s.triangles.push_back(t);
  }
  return s;
}

TEST(FeatureLines, ABoxHasTwelve) {
  const auto box = test::box_surface({0, 0, 0}, {0.03, 0.04, 0.05});
  const auto lines = feature_lines({{&box, 0.005}}, pi / 3);
  ASSERT_EQ(lines.size(), 12u);
  for (const auto& line : lines) {
    EXPECT_EQ(line.points.size(), 2u);
    EXPECT_EQ(line.edge, 0.005);
  }
  EXPECT_NEAR(length(lines), 4 * 0.12, 1e-12);
}

TEST(FeatureLines, ACylindersRimsAreRingsAndASphereHasNone) {
  const auto s = cylinder(0.02, 0.05, 48), ball = test::sphere_surface({0, 0, 0}, 0.03, 3);
  const auto lines = feature_lines({{&s, 0.005}, {&ball, 0.002}}, pi / 4);
  ASSERT_EQ(lines.size(), 2u);
  for (const auto& line : lines) {
    EXPECT_EQ(line.points.size(), 49u);
    EXPECT_EQ(line.points.front(), line.points.back());
    EXPECT_NEAR(length(line), 96 * 0.02 * std::sin(pi / 48), 1e-12);
  }
}

TEST(FeatureLines, WhatTwoBodiesShareIsThereOnce) {
  // The upper box stands on the lower one's corner: of its foot's four edges two run along those of the lower box' top.
  const auto lower = test::box_surface({0, 0, 0}, {0.04, 0.04, 0.02});
  const auto upper = test::box_surface({0, 0, 0.02 + 1e-6}, {0.02, 0.02, 0.05});
  const auto lines = feature_lines({{&lower, 0.005}, {&upper, 0.002}}, pi / 3);
  EXPECT_NEAR(length(lines), 8 * 0.04 + 4 * 0.02 + 8 * 0.02 + 4 * 0.03 - 2 * 0.02, 1e-5);
  EXPECT_EQ(lines.size(),
            12u + 12u);  // two of the lower box' are cut in two, and in these halves two of the upper fall
  int fine = 0;
  for (const auto& line : lines) fine += line.edge == 0.002;
  EXPECT_EQ(fine, 12);  // the finer body's, those that it shares among them
}

TEST(FeatureLines, CrossingLinesMeetInACorner) {
  // Two plates that lie across each other, the upper's lower face in the lower's upper face: 2 x 2 edges cross there.
  const auto along = test::box_surface({-0.05, -0.01, -0.01}, {0.05, 0.01, 0});
  const auto across = test::box_surface({-0.01, -0.05, 0}, {0.01, 0.05, 0.01});
  const auto lines = feature_lines({{&along, 0.005}, {&across, 0.005}}, pi / 3);
  EXPECT_EQ(lines.size(), 24u + 2 * 4u);  // each of the four long edges is cut in three
  int at = 0;
  for (const auto& line : lines)
    for (const auto& p : {line.points.front(), line.points.back()}) at += (p - Vec3(0.01, 0.01, 0)).norm() < 1e-9;
  EXPECT_EQ(at, 4);
}

TEST(FeatureLines, ShortOnesThatEndInNothingAreNoise) {
  // Two neighbours of a ball's nodes stand 2.4 mm out: the edge between them is a ridge of 60 degrees that ends in
  // nothing, what lies round them is half as sharp.
  auto ball = test::sphere_surface({0, 0, 0}, 0.03, 3);
  const auto [a, b, c] = ball.triangles[0];
  const double edge = (ball.nodes[a] - ball.nodes[b]).norm();
  for (const auto i : {a, b}) ball.nodes[i] *= 1.08;
  const auto sharp = [&](double wanted) { return feature_lines({{&ball, wanted}}, 50 * pi / 180).size(); };
  EXPECT_EQ(sharp(0.9 * edge), 1u);
  EXPECT_EQ(sharp(1.2 * edge), 0u);
}

}  // namespace
}  // namespace carus::mesh
