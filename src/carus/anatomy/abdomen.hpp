// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "carus/anatomy/pelvis.hpp"
#include "carus/anatomy/uterus.hpp"

namespace carus::anatomy {

/// The abdomen with the bones as one labelled solid.
///
///     above the inlet   a wall of soft tissue round the uterus, standing on the iliac wings and the brim
///     within the ring   bone is bare: the cavity reaches from the uterus to the bone, no tissue to be crushed between
///     hips              tissue on the outer side of the innominate bones, in the obturator foramina
///
/// The pelvic floor round the canal's end is meshed with the canal, see PelvicFloor.
class Abdomen {
 public:
  Abdomen(const Parameters& p, const Uterus& uterus, const Pelvis& pelvis);
  [[nodiscard]] std::int32_t label(const Vec3& x) const;
  [[nodiscard]] double cavity(const Vec3& x) const;  ///< distance to the cavity's wall, negative within [m]
  [[nodiscard]] double outer_wall(double z) const;   ///< how far from the uterus the trunk reaches at this height [m]

 private:
  [[nodiscard]] std::int32_t tissue(const Vec3& x, double from_uterus) const;
  AbdomenParameters p_;
  const Uterus& uterus_;
  const Pelvis& pelvis_;
};

/// Where the uterus with its canal, as it lies at rest, is deepest within bone; there the bone gives way in the mesh.
struct Overlap {
  double depth = 0;  ///< of the wall's outer face behind the bone's surface [m], 0 if they are apart; to about 0.5 mm
  Vec3 where = Vec3::Zero();
  double volume = 0;  ///< of the bone that gives way [m^3]
};
Overlap overlap(const Uterus& uterus, const Pelvis& pelvis);

}  // namespace carus::anatomy
