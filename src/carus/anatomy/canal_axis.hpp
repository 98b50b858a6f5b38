// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "carus/anatomy/anatomy.hpp"

namespace carus::anatomy {

/// A point in the frame that moves along the canal's axis.
struct CanalCoordinates {
  double s;        ///< arc length from the inlet down [m]
  double lateral;  ///< to the right [m]
  double front;    ///< towards the centre of the bend [m]
};
CanalCoordinates canal_coordinates(const CanalAxis& axis, const Vec3& x);

}  // namespace carus::anatomy
