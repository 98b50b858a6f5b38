// SPDX-License-Identifier: Apache-2.0
#include "carus/anatomy/canal_axis.hpp"

#include <algorithm>
#include <cmath>

#include "carus/anatomy/shapes.hpp"

namespace carus::anatomy {

Vec3 CanalAxis::point(double s) const {
  const double straight = -p_.bend_start, R = p_.bend_radius;
  if (s <= straight) return {0, 0, -s};
  const double angle = std::min((s - straight) / R, p_.bend_angle), rest = std::max(s - vulva(), 0.0);
  const Vec3 on_arc(0, R * (1 - std::cos(angle)), p_.bend_start - R * std::sin(angle));
  return on_arc + rest * tangent(s);
}

Vec3 CanalAxis::tangent(double s) const {
  const double angle = std::clamp((s + p_.bend_start) / p_.bend_radius, 0.0, p_.bend_angle);
  return {0, std::sin(angle), -std::cos(angle)};
}

double CanalAxis::nearest(const Vec3& x) const {
  if (x.z() >= p_.bend_start) return -x.z();
  const double angle = std::atan2(p_.bend_start - x.z(), p_.bend_radius - x.y());
  if (angle <= p_.bend_angle) return -p_.bend_start + p_.bend_radius * angle;
  return vulva() + std::max((x - point(vulva())).dot(tangent(vulva())), 0.0);
}

double CanalAxis::radius(double s) const {
  return p_.radius + (p_.vulva_radius - p_.radius) * smooth_step(p_.taper_start, vulva(), s);
}

Vec3 CanalAxis::centre(double s) const {
  const Vec3 t = tangent(s);
  return point(s) + p_.taper_forward * (p_.radius - radius(s)) * Vec3(0, -t.z(), t.y());
}

bool CanalAxis::inside_bend(const Vec3& x) const {
  return x.z() < p_.bend_start && std::hypot(p_.bend_radius - x.y(), p_.bend_start - x.z()) < 0.7 * p_.bend_radius;
}

CanalCoordinates canal_coordinates(const CanalAxis& axis, const Vec3& x) {
  const double s = axis.nearest(x);
  const Vec3 t = axis.tangent(s);
  const Vec3 front(0, -t.z(), t.y());
  return {s, x.x(), (x - axis.point(s)).dot(front)};
}

}  // namespace carus::anatomy
