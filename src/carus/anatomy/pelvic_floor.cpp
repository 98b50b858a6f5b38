// SPDX-License-Identifier: Apache-2.0
#include "carus/anatomy/pelvic_floor.hpp"

#include "carus/anatomy/shapes.hpp"

namespace carus::anatomy {
namespace {

constexpr double levator_front = -pi / 12;   // in front of it the rami of the pubis leave no room beside the head
constexpr double perineal_half_angle = 0.8;  // rad from the midline behind
constexpr double perineal_height = 0.027;    // from the vulva up, to below the coccyx [m]
constexpr double thinnest = 0.25;            // of its thickness, at the borders

}  // namespace

double PelvicFloor::angle(const Vec3& x) const {
  const double s = axis_.nearest(x);
  const Vec3 t = axis_.tangent(s);
  return std::atan2((x - axis_.centre(s)).dot(Vec3(0, -t.z(), t.y())), std::abs(x.x()));
}

bool PelvicFloor::levator(const Vec3& x) const {
  return axis_.nearest(x) > canal_.floor_top && angle(x) < levator_front;
}

bool PelvicFloor::perineum(const Vec3& x) const {
  return axis_.nearest(x) > axis_.vulva() - perineal_height && angle(x) < -pi / 2 + perineal_half_angle;
}

double PelvicFloor::perineal_thickness(const Vec3& x) const {
  const double side = 1 - smooth_step(0.3 * perineal_half_angle, perineal_half_angle, angle(x) + pi / 2);
  const double up =
      smooth_step(axis_.vulva() - perineal_height, axis_.vulva() - 0.4 * perineal_height, axis_.nearest(x));
  return p_.perineal_body_thickness * (thinnest + (1 - thinnest) * side * up);
}

Vec3 PelvicFloor::outward(const Vec3& x) const {
  const double s = axis_.nearest(x);
  const Vec3 t = axis_.tangent(s), r = x - axis_.centre(s);
  return (r - r.dot(t) * t).normalized();
}

}  // namespace carus::anatomy
