// SPDX-License-Identifier: Apache-2.0
#include "carus/material/active_strain.hpp"

#include <gtest/gtest.h>

#include <Eigen/LU>

#include "law_cases.hpp"

namespace carus::material {
namespace {

TEST(active_strain, keeps_volume_and_has_its_closed_inverse) {
  std::mt19937 random(1);
  for (const double lambda : {0.2, 0.5, 1.0, 1.3}) {
    for (const double dome : {0.0, 0.3, 1.0}) {
      const Mat3 Q = random_rotation(random);
      const Mat3 Fa = active_strain(lambda, Q.col(0), Q.col(2), dome);
      EXPECT_NEAR(Fa.determinant(), 1, 1e-14);
      EXPECT_LT((Fa * inverse_active_strain(lambda, Q.col(0), Q.col(2), dome) - Mat3::Identity()).norm(), 1e-13);
    }
  }
}

TEST(active_strain, shortens_the_meridian_on_the_tube_and_the_plane_on_the_dome) {
  const Vec3 m = Vec3::UnitX(), n = Vec3::UnitZ();
  const Mat3 tube = active_strain(0.49, m, n, 0), dome = active_strain(0.49, m, n, 1);
  EXPECT_LT((tube - Mat3(Vec3(0.49, 1, 1 / 0.49).asDiagonal())).norm(), 1e-14);
  EXPECT_LT((dome - Mat3(Vec3(0.7, 0.7, 1 / 0.49).asDiagonal())).norm(), 1e-14);
}

TEST(active_strain, rest_length_one_is_rest) {
  EXPECT_LT((active_strain(1, Vec3::UnitY(), Vec3::UnitX(), 0.4) - Mat3::Identity()).norm(), 1e-15);
}

}  // namespace
}  // namespace carus::material
