// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "carus/anatomy/fetus.hpp"
#include "carus/anatomy/sampled_field.hpp"

namespace carus::anatomy {

/// The uterus with the vaginal canal as a labelled solid: one thin wall, generated from the fetus, open at the vulva
/// only.
///
///     inner surface: bag of the fetus + gap, joined to a tube of the canal's radius round the axis
///     outer surface: inner + thickness of the region
class Uterus {
 public:
  Uterus(const Parameters& p, const Fetus& fetus);
  [[nodiscard]] std::int32_t label(const Vec3& x) const;
  [[nodiscard]] std::int32_t region(const Vec3& x) const;  ///< the label that wall at this height has
  [[nodiscard]] double inner_distance(const Vec3& x) const { return field_(x); }  ///< [m] > 0 in the wall and beyond
  [[nodiscard]] double outer_distance(const Vec3& x) const { return field_(x) - thickness(x); }
  [[nodiscard]] double thickness(const Vec3& x) const;  ///< of the wall at this height [m]
  [[nodiscard]] WallFrame frame(const Vec3& x) const;
  [[nodiscard]] double fundus_z() const { return fundus_; }  ///< where the dome begins
  [[nodiscard]] const CanalAxis& axis() const { return axis_; }

  static constexpr double lower_segment_top = 0.060;  ///< [m] above the inlet

 private:
  UterusParameters p_;
  CanalAxis axis_;
  double fundus_;
  SampledField field_;
};

}  // namespace carus::anatomy
