// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "carus/anatomy/anatomy.hpp"

namespace carus::anatomy {

/// The fetus as a labelled solid: flexed oval head, neck, shoulders, trunk, breech, and a layer of skin over all.
///
///     own frame: origin at the head's centre, z to the breech, y dorsal (occiput), x lateral
///
/// Biometry is that of the outer surface, scalp included.
class Fetus {
 public:
  /// Throws InputError if the length leaves no room for the trunk.
  explicit Fetus(const FetusParameters& p);
  [[nodiscard]] std::int32_t label(const Vec3& x) const;
  [[nodiscard]] std::int32_t core(const Vec3& x) const;  ///< the label without the skin: 0 in it and outside
  [[nodiscard]] Vec3 on_skin(Vec3 x) const;              ///< the point of the outer surface above a point of the core's
  [[nodiscard]] double distance(const Vec3& x) const;    ///< to the skin's outer surface [m]
  /// The smooth bag that the uterus is generated from: the fetus with its neck filled up.
  [[nodiscard]] double bag(const Vec3& x) const;

  [[nodiscard]] Vec3 to_world(const Vec3& own) const { return turn_ * own + centre_; }
  [[nodiscard]] Vec3 to_own(const Vec3& x) const { return turn_.transpose() * (x - centre_); }
  [[nodiscard]] double breech_z() const { return centre_.z() + breech_centre_; }  ///< of the breech's centre
  [[nodiscard]] double bottom_z() const { return centre_.z() - head_up_; }        ///< of the leading point
  [[nodiscard]] std::map<std::string, Vec3> landmarks() const;

  static double turn_of(Position p);  ///< about z from occiput anterior [rad]

 private:
  [[nodiscard]] double head(const Vec3& own) const;
  [[nodiscard]] double trunk(const Vec3& own) const;  ///< with breech, shoulders and neck
  [[nodiscard]] double whole(const Vec3& own) const { return join(own, trunk(own), head(own)); }
  [[nodiscard]] double join(const Vec3& own, double trunk, double head) const;
  FetusParameters p_;
  Mat3 turn_, head_axes_;  ///< columns of the latter: lateral, occiput, base of the skull
  Vec3 centre_, head_semi_, shoulder_semi_, trunk_semi_, neck_start_;
  double head_up_, shoulders_, trunk_, breech_centre_, breech_radius_;
};

}  // namespace carus::anatomy
