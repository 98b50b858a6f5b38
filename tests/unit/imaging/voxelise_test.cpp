// SPDX-License-Identifier: Apache-2.0
#include "carus/imaging/voxelise.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "carus/core/error.hpp"
#include "support/closed_shapes.hpp"

namespace carus::imaging {
namespace {

using test::box_surface;

TEST(Voxelise, ABoxIsTheVoxelsWhoseCentresLieInIt) {
  // Voxel centres lie at whole millimetres from its corner: 0.3 mm aside, so that none lies on a face.
  const auto v = voxelise({{box_surface({0.0003, 0, 0}, {0.0103, 0.0204, 0.0306}), 7}}, 0.001);
  EXPECT_EQ(count_labels(v).at(7), 11u * 21 * 31);
  EXPECT_EQ(v.label({0.0053, 0.0102, 0.0153}), 7);
  EXPECT_EQ(v.label({-0.0010, 0.0102, 0.0153}), 0);
  EXPECT_NEAR(v.origin.x(), 0.0003 - 0.006, 1e-12);
}

TEST(Voxelise, KeepsVolumesAndTheFirstOfTwo) {
  const auto ball = test::sphere_surface({0.02, -0.01, 0.3}, 0.02, 4);
  const auto other = test::sphere_surface({0.035, -0.01, 0.3}, 0.02, 4);
  const auto v = voxelise({{ball, 1}, {other, 2}}, 0.0005);
  const auto counts = count_labels(v);
  EXPECT_NEAR(double(counts.at(1)) * v.voxel_volume(), mesh::volume(ball), 2e-3 * mesh::volume(ball));
  // Lens of two balls of radius R, d apart: pi (2R - d)^2 (d^2 + 4 R d) / (12 d).
  const double d = 0.015, R = 0.02, lens = pi * std::pow(2 * R - d, 2) * (d * d + 4 * R * d) / (12 * d);
  EXPECT_NEAR(double(counts.at(2)) * v.voxel_volume(), 4 * pi / 3 * R * R * R - lens, 1e-2 * lens);
  EXPECT_EQ(v.label({0.0275, -0.01, 0.3}), 1);
}

TEST(Voxelise, SaysWhenTheUnitMustBeWrong) {
  for (const double size : {300.0, 3e8})  // [m]; the second has more voxels along an edge than an int can count
    try {
      static_cast<void>(voxelise({{box_surface({0, 0, 0}, {size, 200, 200}), 1}}, 0.001));
      FAIL();
    } catch (const InputError& e) {
      EXPECT_THAT(e.what(), testing::HasSubstr("are the surfaces in the unit that is said?"));
    }
}

}  // namespace
}  // namespace carus::imaging
