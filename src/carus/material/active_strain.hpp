// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cmath>

#include "carus/core/types.hpp"

namespace carus::material {

/// Active strain F = F_e F_a of a retracting wall (Ambrosi and Pezzuto 2012): its rest length along the meridian is
/// lambda.
///   F_a = lambda^(1-d/2) m (x) m + lambda^(d/2) h (x) h + lambda^-1 n (x) n,   h = n x m,   d = dome.
/// On the tube (d = 0) the meridian shortens and the thickness takes the volume while the hoop keeps its length; on the
/// dome (d = 1), where the meridian is singular, both directions of the plane take sqrt(lambda). det F_a = 1 for every
/// d. meridian, normal: unit, orthogonal; lambda > 0; dome 0..1.
inline Mat3 active_strain(double lambda, const Vec3& meridian, const Vec3& normal, double dome) {
  const Vec3 hoop = normal.cross(meridian);
  const double along_hoop = std::pow(lambda, 0.5 * dome);
  return lambda / along_hoop * meridian * meridian.transpose() + along_hoop * hoop * hoop.transpose() +
         1 / lambda * normal * normal.transpose();
}

/// F_a^-1 = F_a(1/lambda).
inline Mat3 inverse_active_strain(double lambda, const Vec3& meridian, const Vec3& normal, double dome) {
  return active_strain(1 / lambda, meridian, normal, dome);
}

}  // namespace carus::material
