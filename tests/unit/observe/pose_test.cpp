// SPDX-License-Identifier: Apache-2.0
#include "carus/observe/pose.hpp"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <random>

namespace carus::observe {
namespace {

std::vector<Vec3> cloud(int n) {
  std::mt19937 random(7);
  std::uniform_real_distribution<double> unit(-0.05, 0.05);
  std::vector<Vec3> points;
  for (int i = 0; i < n; ++i) points.emplace_back(unit(random), 1.3 * unit(random), 0.8 * unit(random));
  return points;
}

std::vector<std::int32_t> all(std::size_t n) {
  std::vector<std::int32_t> nodes(n);
  for (std::size_t i = 0; i < n; ++i) nodes[i] = std::int32_t(i);
  return nodes;
}

TEST(BestFit, RecoversKnownMotions) {
  const auto rest = cloud(40);
  for (const double angle : {0.0, 1e-6, 0.3, 1.5, 3.1}) {
    const Mat3 R = Eigen::AngleAxisd(angle, Vec3(1, -2, 0.5).normalized()).toRotationMatrix();
    auto moved = rest;
    for (auto& x : moved) x = R * x + Vec3(0.01, 0.06, -0.184);
    const Pose pose = best_fit(rest, moved, all(rest.size()));
    EXPECT_LT((pose.rotation - R).norm(), 1e-12) << angle;  // round-off of sums of 40 products
    EXPECT_LT((pose.centre - R * pose.rest_centre - Vec3(0.01, 0.06, -0.184)).norm(), 1e-15);
    EXPECT_NEAR(rotation_vector(pose.rotation).norm(), angle, 1e-9);
  }
}

TEST(BestFit, StretchIsNotTakenForTurning) {
  const auto rest = cloud(200);
  auto crushed = rest;
  for (auto& x : crushed) x = Vec3(0.9, 1.1, 1.0).asDiagonal() * x;
  EXPECT_LT(rotation_vector(best_fit(rest, crushed, all(rest.size())).rotation).norm(),
            0.02);  // the cloud is not quite symmetric
}

TEST(BestFit, FlatSetsStayProper) {
  std::vector<Vec3> rest{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {1, 2, 0}};
  const Mat3 R = Eigen::AngleAxisd(2.0, Vec3(0.3, 1, 0.2).normalized()).toRotationMatrix();
  auto moved = rest;
  for (auto& x : moved) x = R * x;
  const Mat3 found = best_fit(rest, moved, all(4)).rotation;
  EXPECT_NEAR(found.determinant(), 1, 1e-12);
  EXPECT_LT((found - R).norm(), 1e-12);
}

/// A head in the military attitude, face to the mother's back: occiput anterior.
HeadAxes occiput_anterior() { return HeadAxes::from(Vec3::UnitX(), -Vec3::UnitY()); }

TEST(Attitude, NamesTheCardinalPositions) {
  const Vec3 down = -Vec3::UnitZ();
  EXPECT_LT((occiput_anterior().vertex - down).norm(), 1e-15);
  for (const double turn : {0.0, 0.5, pi / 2, -pi / 2, -2.5}) {
    // A turn from above's view: positive brings the occiput from anterior to the mother's right.
    const Mat3 R = Eigen::AngleAxisd(-turn, Vec3::UnitZ()).toRotationMatrix();
    const auto a = attitude(occiput_anterior().turned(R), down);
    EXPECT_NEAR(a.rotation, turn, 1e-12);
    EXPECT_NEAR(a.flexion, 0, 1e-12);
    EXPECT_NEAR(a.tilt, 0, 1e-12);
  }
}

TEST(Attitude, FlexionLetsTheOcciputLead) {
  const Vec3 down = -Vec3::UnitZ();
  const auto head = occiput_anterior();
  const Mat3 flexed = Eigen::AngleAxisd(1.05, -head.right).toRotationMatrix();
  const auto a = attitude(head.turned(flexed), down);
  EXPECT_GT((flexed * -head.face).dot(down), 0.8);
  EXPECT_NEAR(a.flexion, 1.05, 1e-12);
  EXPECT_NEAR(a.rotation, 0, 1e-12);
}

TEST(Attitude, FollowsTheCanalRoundTheBend) {
  // Tangent and head turned together about x: nothing changes in the canal's own frame.
  const Mat3 bend = Eigen::AngleAxisd(0.87, Vec3::UnitX()).toRotationMatrix();
  const Mat3 turned = Eigen::AngleAxisd(-0.4, Vec3::UnitZ()).toRotationMatrix();
  const auto a = attitude(occiput_anterior().turned(bend * turned), bend * -Vec3::UnitZ());
  EXPECT_NEAR(a.rotation, 0.4, 1e-12);
  EXPECT_NEAR(a.flexion, 0, 1e-12);
}

TEST(Unwrapped, StaysNearTheReference) {
  EXPECT_NEAR(unwrapped(-3.0, 3.2), 2 * pi - 3.0, 1e-15);
  EXPECT_NEAR(unwrapped(0.1, 0), 0.1, 1e-15);
}

}  // namespace
}  // namespace carus::observe
