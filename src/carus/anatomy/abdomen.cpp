// SPDX-License-Identifier: Apache-2.0
#include "carus/anatomy/abdomen.hpp"

#include "carus/anatomy/shapes.hpp"

namespace carus::anatomy {
namespace {

constexpr double deg = pi / 180;
constexpr double funnel = 0.8;         // how fast the widened cavity closes in on the uterus above the inlet
constexpr double bone_gap = 0.0006;    // more between uterus and bone than between uterus and tissue: facets' sagitta
constexpr double coccyx_play = 0.012;  // free space round the rocking bone [m]
constexpr double coccyx_half_width = 0.026;
constexpr double floor_side = -6 * deg;   // the floor ends beside the canal at the ischium
constexpr double floor_bare = -16 * deg;  // and before it is left out between bone and canal
constexpr double perineal_half_angle = 24 * deg;

}  // namespace

Abdomen::Abdomen(const Parameters& p, const Uterus& uterus, const Pelvis& pelvis)
    : p_(p.abdomen), uterus_(uterus), pelvis_(pelvis) {}

double Abdomen::outer_wall(double z) const { return p_.wall + 0.014 * (1 - smooth_step(0, 0.08, z)); }

double Abdomen::cavity(const Vec3& x) const {
  const double bag = uterus_.outer_distance(x) - p_.gap;
  const auto c = canal_coordinates(pelvis_.axis(), x);
  // The floor reaches to the canal where no bone stands beside it.
  if (c.s > pelvis_.axis().vulva() - floor_height && std::atan2(c.front, std::abs(c.lateral)) < floor_bare) return bag;
  const double above = std::max(-c.s, 0.0);
  // The channel flares above the inlet; the funnel more than takes that back.
  return smooth_union(bag, pelvis_.channel(x) + 1.6 * funnel * above, 0.004);
}

std::int32_t Abdomen::tissue(const Vec3& x, double from_uterus) const {
  const auto c = canal_coordinates(pelvis_.axis(), x);
  const double vulva = pelvis_.axis().vulva(), angle = std::atan2(c.front, std::abs(c.lateral));
  if (c.s >= vulva - floor_height && c.s < vulva && angle < floor_side && from_uterus < p_.perineal_body_thickness) {
    // In the midline the floor begins below the coccyx.
    if (std::abs(c.lateral) < coccyx_half_width && c.s < pelvis_.coccyx_level()) return outside;
    if (pelvis_.coccyx_distance(x) < coccyx_play || (angle > floor_bare && pelvis_.channel(x) < 0)) return outside;
    const bool low = c.s > vulva - 0.7 * floor_height;
    if (from_uterus < p_.levator_thickness + p_.gap) return levator_ani;
    return low && angle < -90 * deg + perineal_half_angle ? perineal_body : abdomen;
  }
  if (from_uterus > outer_wall(x.z()) || cavity(x) < 0) return outside;
  if (x.z() > 0) return abdomen;
  const Eigen::Vector2d uv = pelvis_.unroll(x);
  return rectangle(uv.x(), uv.y(), -0.030, 0.056, -0.096, 0.020) < 0 ? abdomen : outside;
}

std::int32_t Abdomen::label(const Vec3& x) const {
  const double from_uterus = uterus_.outer_distance(x);
  if (from_uterus < p_.gap) return outside;
  if (const auto bone = pelvis_.label(x); bone != outside) return from_uterus < p_.gap + bone_gap ? outside : bone;
  return tissue(x, from_uterus);
}

}  // namespace carus::anatomy
