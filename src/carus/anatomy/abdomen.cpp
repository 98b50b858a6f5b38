// SPDX-License-Identifier: Apache-2.0
#include "carus/anatomy/abdomen.hpp"

#include "carus/anatomy/shapes.hpp"

namespace carus::anatomy {
namespace {

constexpr double funnel = 0.8;       // how fast the widened cavity closes in on the uterus above the inlet
constexpr double recess = 0.006;     // of the soft tissue in the gaps between the bones [m]
constexpr double bone_gap = 0.0006;  // more between uterus and bone than between uterus and tissue: facets' sagitta

}  // namespace

Abdomen::Abdomen(const Parameters& p, const Uterus& uterus, const Pelvis& pelvis)
    : p_(p.abdomen), uterus_(uterus), pelvis_(pelvis) {}

double Abdomen::outer_wall(double z) const { return p_.wall + 0.014 * (1 - smooth_step(0, 0.08, z)); }

double Abdomen::cavity(const Vec3& x) const {
  const double bag = uterus_.outer_distance(x) - p_.gap;
  const auto c = canal_coordinates(pelvis_.axis(), x);
  const double above = std::max(-c.s, 0.0);
  // The channel flares above the inlet; the funnel more than takes that back.
  return smooth_union(bag, pelvis_.channel(x) + 1.6 * funnel * above, 0.004);
}

std::int32_t Abdomen::tissue(const Vec3& x, double from_uterus) const {
  if (from_uterus > outer_wall(x.z()) || cavity(x) < 0) return outside;
  if (x.z() > 0) return abdomen;
  // Behind the bones' inner face only: wisps of soft tissue between them would be the first thing that the canal meets.
  if (pelvis_.channel(x) < recess) return outside;
  const Eigen::Vector2d uv = pelvis_.unroll(x);
  return rectangle(uv.x(), uv.y(), -0.030, 0.056, -0.096, 0.020) < 0 ? abdomen : outside;
}

std::int32_t Abdomen::label(const Vec3& x) const {
  const double from_uterus = uterus_.outer_distance(x);
  if (from_uterus < p_.gap) return outside;
  if (const auto bone = pelvis_.label(x); bone != outside) return from_uterus < p_.gap + bone_gap ? outside : bone;
  return tissue(x, from_uterus);
}

Overlap overlap(const Uterus& uterus, const Pelvis& pelvis) {
  constexpr double h = 0.002;  // [m]
  Overlap o;
  for (double z = -0.16; z < 0.12; z += h)
    for (double y = -0.11; y < 0.13; y += h)
      for (double x = -0.10; x < 0.10; x += h) {
        const Vec3 p(x, y, z);
        const double inside = -uterus.outer_distance(p);
        if (inside <= 0 || uterus.axis().nearest(p) > uterus.axis().vulva() || pelvis.label(p) == outside) continue;
        o.volume += h * h * h;
        if (inside > o.depth) o.depth = inside, o.where = p;
      }
  return o;
}

}  // namespace carus::anatomy
