// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "carus/core/types.hpp"

namespace carus::observe {

/// Rigid motion that carries rest positions nearest to current ones: x ≈ R (X - rest_centre) + centre.
struct Pose {
  Mat3 rotation = Mat3::Identity();
  Vec3 rest_centre = Vec3::Zero(), centre = Vec3::Zero();  ///< [m]
};

/// Best fit in the least-squares sense over `nodes` (at least three, not on one line), equal weights; R is proper (det
/// R = 1). Kabsch, Acta Cryst. A32 (1976) 922; the determinant's correction after Umeyama, IEEE PAMI 13 (1991) 376.
Pose best_fit(const std::vector<Vec3>& rest, const std::vector<Vec3>& current, const std::vector<std::int32_t>& nodes);

/// Axis times angle of a rotation [rad], |.| <= pi.
Vec3 rotation_vector(const Mat3& R);

/// A head's own axes, orthonormal: right ear, face, vertex (right x face = vertex).
struct HeadAxes {
  Vec3 right, face, vertex;
  /// From two measured directions; `face` is made perpendicular to `right`.
  static HeadAxes from(const Vec3& to_right, const Vec3& to_face);
  [[nodiscard]] HeadAxes turned(const Mat3& R) const { return {R * right, R * face, R * vertex}; }
};

/// How a head lies in the birth canal.
struct Attitude {
  double flexion;   ///< [rad] 0: the vertex leads (military), pi/2: the occiput leads; extension makes it smaller
  double rotation;  ///< [rad] of the occiput from anterior in the plane across the canal: 0 OA, +pi/2 mother's right,
                    ///< ±pi OP
  double tilt;      ///< [rad] lateral (asynclitism): right ear leads if positive
};

/// `tangent`: unit, down the canal. In the plane across it, anterior is x̂ × tangent.
Attitude attitude(const HeadAxes& head, const Vec3& tangent);

/// `angle` + k 2π nearest to `reference`.
double unwrapped(double angle, double reference);

}  // namespace carus::observe
