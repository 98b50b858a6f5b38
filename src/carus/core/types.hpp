// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Geometry>
#include <cstdint>

namespace carus {

/// Frame: RAS in metres. x to the right, y anterior, z cranial; origin at the centre of the pelvic inlet. SI units
/// throughout.
using Vec3 = Eigen::Vector3d;
using Mat3 = Eigen::Matrix3d;

inline constexpr double pi = 3.14159265358979323846;

}  // namespace carus
