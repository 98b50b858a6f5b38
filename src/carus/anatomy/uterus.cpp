// SPDX-License-Identifier: Apache-2.0
#include "carus/anatomy/uterus.hpp"

#include <Eigen/Geometry>

#include "carus/anatomy/canal_axis.hpp"
#include "carus/anatomy/shapes.hpp"

namespace carus::anatomy {
namespace {

constexpr double grid = 0.005;   // [m] interpolation error h^2/(8 R) < 0.07 mm
constexpr double reach = 0.050;  // [m] how far outside the distance is wanted, by the abdomen
constexpr double fillet = 0.008;

SampledField inner_field(const Parameters& p, const CanalAxis& axis, const Fetus& fetus) {
  // The tube begins within the head, so that the head's leading part hides its upper end.
  const double tube_start = -p.fetus.head_start + 0.25 * p.fetus.biparietal;
  const auto f = [&](const Vec3& x) {
    const auto c = canal_coordinates(axis, x);
    const double above = std::max(tube_start - c.s, 0.0);
    const double tube = std::hypot((x - axis.centre(c.s)).norm(), above) - axis.radius(c.s);
    return smooth_union(fetus.bag(x) - p.uterus.gap, tube, fillet);
  };
  const double half = std::max(p.fetus.shoulder_width / 2, p.canal.radius) + p.uterus.gap + p.uterus.wall_body + reach;
  const Vec3 end = axis.point(axis.vulva());
  const double breech_top = fetus.landmarks().at("breech").z();
  return {f, Vec3(-half, -half, end.z() - p.canal.radius - reach),
          Vec3(half, std::max(half, end.y() + p.canal.radius + reach), breech_top + p.uterus.wall_fundus + reach),
          grid};
}

}  // namespace

Uterus::Uterus(const Parameters& p, const Fetus& fetus)
    : p_(p.uterus), axis_(p.canal), fundus_(fetus.breech_z()), field_(inner_field(p, axis_, fetus)) {}

double Uterus::thickness(const Vec3& x) const {
  const auto blend = [](double a, double b, double t) { return a + (b - a) * t; };
  const double z = x.z();
  double t = blend(p_.wall_canal, p_.wall_lower_segment, smooth_step(-0.01, 0.01, z));
  t = blend(t, p_.wall_body, smooth_step(lower_segment_top - 0.01, lower_segment_top + 0.02, z));
  return blend(t, p_.wall_fundus, smooth_step(fundus_ - 0.02, fundus_ + 0.02, z));
}

std::int32_t Uterus::label(const Vec3& x) const {
  if (axis_.nearest(x) >= axis_.vulva()) return outside;
  const double d = inner_distance(x);
  return d <= 0 || d >= thickness(x) ? static_cast<std::int32_t>(outside) : region(x);
}

std::int32_t Uterus::region(const Vec3& x) const {
  if (x.z() > fundus_) return uterine_fundus;
  if (x.z() > lower_segment_top) return uterine_body;
  return x.z() > 0 ? lower_segment : vaginal_canal;
}

WallFrame Uterus::frame(const Vec3& x) const {
  WallFrame w;
  w.s = axis_.nearest(x);
  w.normal = field_.gradient(x).normalized();
  const Vec3 down = axis_.tangent(w.s);
  // On the dome the meridians run together; at its pole any direction in the plane serves, since retraction is
  // isotropic there.
  w.dome = x.z() > fundus_ ? smooth_step(0.4, 0.8, -down.dot(w.normal)) : 0;
  Vec3 meridian = down - down.dot(w.normal) * w.normal;
  if (meridian.norm() < 1e-3) meridian = w.normal.unitOrthogonal();
  w.meridian = meridian.normalized();
  return w;
}

}  // namespace carus::anatomy
