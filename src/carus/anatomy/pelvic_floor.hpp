// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "carus/anatomy/anatomy.hpp"

namespace carus::anatomy {

/// What has grown together with the narrow end of the canal, as layers on its outer face: the levator ani, a sheet
/// slung behind and beside it, and on that, in the midline before the vulva, the perineal body.
///
/// Layers are measured across the axis, from the canal's centre outwards.
class PelvicFloor {
 public:
  PelvicFloor(const AbdomenParameters& p, const CanalParameters& canal) : p_(p), canal_(canal), axis_(canal) {}
  [[nodiscard]] bool levator(const Vec3& x) const;   ///< whether the sheet lies over this point of the canal's wall
  [[nodiscard]] bool perineum(const Vec3& x) const;  ///< whether the perineal body lies over this point of the sheet
  [[nodiscard]] double perineal_thickness(const Vec3& x) const;  ///< there [m]; thins out towards its borders
  [[nodiscard]] Vec3 outward(const Vec3& x) const;               ///< unit, across the axis

 private:
  [[nodiscard]] double angle(const Vec3& x) const;  ///< round the canal's centre, from the side (0) to the front [rad]
  AbdomenParameters p_;
  CanalParameters canal_;
  CanalAxis axis_;
};

}  // namespace carus::anatomy
