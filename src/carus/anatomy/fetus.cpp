// SPDX-License-Identifier: Apache-2.0
#include "carus/anatomy/fetus.hpp"

#include <fmt/format.h>

#include <Eigen/Geometry>

#include "carus/anatomy/shapes.hpp"
#include "carus/core/error.hpp"

namespace carus::anatomy {
namespace {

constexpr double neck_radius = 0.026;  // [m]
constexpr double shoulder_half_depth = 0.0475, shoulder_half_height = 0.048;
constexpr double trunk_half_width = 0.053, trunk_half_depth = 0.050;
constexpr double head_to_shoulders = 0.046;  // from the head's upper end to the middle of the shoulders [m]
constexpr double neck_fillet = 0.040, trunk_fillet = 0.020;

Mat3 about(const Vec3& axis, double angle) { return Eigen::AngleAxisd(angle, axis).toRotationMatrix(); }

}  // namespace

double Fetus::turn_of(Position p) {
  // OA: occiput at +y; a turn of +90 degrees about z brings it to the mother's left, -x.
  switch (p) {
    case Position::OA:
      return 0;
    case Position::LOA:
      return pi / 4;
    case Position::LOT:
      return pi / 2;
    case Position::LOP:
      return 3 * pi / 4;
    case Position::OP:
      return pi;
    case Position::ROP:
      return -3 * pi / 4;
    case Position::ROT:
      return -pi / 2;
    case Position::ROA:
      return -pi / 4;
  }
  CARUS_ASSERT(false);
}

Fetus::Fetus(const FetusParameters& p)
    : p_(p), turn_(about(Vec3::UnitZ(), turn_of(p.position))), centre_(0, 0, p.head_start) {
  // Flexion brings the occiput (+y) down to the leading end (-z); asynclitism tilts the head about its occipitofrontal
  // axis.
  head_axes_ = about(Vec3::UnitY(), p.asynclitism) * about(Vec3::UnitX(), -p.flexion);
  head_semi_ = Vec3(p.biparietal, p.occipitofrontal, p.suboccipitobregmatic) / 2;
  head_up_ = head_semi_.cwiseProduct(head_axes_.row(2).transpose()).norm();
  breech_radius_ = p.suboccipitobregmatic / 2;
  breech_centre_ = p.length - head_up_ - breech_radius_;
  shoulders_ = head_up_ + head_to_shoulders;
  if (breech_centre_ < shoulders_ + 0.02)
    throw InputError(fmt::format(
        "fetus.length: {:.0f} mm leaves no room for a trunk, at least {:.0f} mm; hint: 300 mm for a head of 116 mm",
        p.length * 1e3, (shoulders_ + 0.02 + head_up_ + breech_radius_) * 1e3));
  trunk_ = (shoulders_ + breech_centre_) / 2;
  shoulder_semi_ = {p.shoulder_width / 2, shoulder_half_depth, shoulder_half_height};
  trunk_semi_ = {trunk_half_width, trunk_half_depth, (breech_centre_ - shoulders_) / 2 + 0.030};
  neck_start_ = head_axes_ * Vec3(0, 0, 0.4 * head_semi_.z());
}

double Fetus::head(const Vec3& own) const { return ellipsoid(head_axes_.transpose() * own, head_semi_); }

double Fetus::trunk(const Vec3& own) const {
  double d = ellipsoid(own - Vec3(0, 0, shoulders_), shoulder_semi_);
  d = smooth_union(d, ellipsoid(own - Vec3(0, 0, trunk_), trunk_semi_), trunk_fillet);
  d = smooth_union(d, (own - Vec3(0, 0, breech_centre_)).norm() - breech_radius_, trunk_fillet);
  return smooth_union(d, capsule(own, neck_start_, {0, 0, shoulders_}, neck_radius, neck_radius), neck_fillet);
}

double Fetus::join(const Vec3& own, double trunk, double head) const {
  // A wide fillet at the neck, none on the leading half of the head, whose diameters must stay.
  const double k = 0.010 + (neck_fillet - 0.010) * smooth_step(0.1 * head_up_, 0.7 * head_up_, own.z());
  return smooth_union(trunk, head, k);
}

double Fetus::distance(const Vec3& x) const { return whole(to_own(x)); }

double Fetus::bag(const Vec3& x) const {
  const Vec3 own = to_own(x);
  const Vec3 filler((head_semi_.x() + shoulder_semi_.x()) / 2, (head_semi_.z() + shoulder_semi_.y()) / 2, head_up_);
  return smooth_union(whole(own), ellipsoid(own - Vec3(0, 0, 0.5 * shoulders_), filler), 0.014);
}

std::int32_t Fetus::label(const Vec3& x) const {
  const auto inner = core(x);
  return inner == outside && distance(x) < 0 ? static_cast<std::int32_t>(fetal_skin) : inner;
}

std::int32_t Fetus::core(const Vec3& x) const {
  const Vec3 own = to_own(x);
  const double h = head(own), t = trunk(own);
  if (join(own, t, h) > -p_.skin_thickness) return outside;
  // The skull's base within the neck is the ellipsoid's; in the fillet round it the border stands across the surface,
  // not along it.
  return h < -p_.skin_thickness || h < t ? skull : fetal_body;
}

Vec3 Fetus::on_skin(Vec3 x) const {
  // Newton along the gradient, x <- x - d g / |g|^2, in short steps: in the fold of the neck the gradient is small.
  constexpr double e = 1e-6;
  for (int it = 0; it < 16; ++it) {
    Vec3 g;
    for (int i = 0; i < 3; ++i) g[i] = (distance(x + e * Vec3::Unit(i)) - distance(x - e * Vec3::Unit(i))) / (2 * e);
    const double step = std::clamp(distance(x) / g.norm(), -0.001, 0.001);
    x -= step * g.normalized();
  }
  return x;
}

std::map<std::string, Vec3> Fetus::landmarks() const {
  const auto on_head = [&](const Vec3& unit) { return to_world(head_axes_ * unit.cwiseProduct(head_semi_)); };
  return {{"head_centre", centre_},
          {"occiput", on_head({0, 1, 0})},
          {"sinciput", on_head({0, -1, 0})},
          {"head_top", on_head({0, 0, -1})},
          {"head_base", on_head({0, 0, 1})},
          {"biparietal_right", on_head({1, 0, 0})},
          {"biparietal_left", on_head({-1, 0, 0})},
          {"vertex", to_world({0, 0, -head_up_})},
          {"breech", to_world({0, 0, breech_centre_ + breech_radius_})},
          {"neck", to_world({0, 0, head_up_})},
          {"shoulder_right", to_world({p_.shoulder_width / 2, 0, shoulders_})},
          {"shoulder_left", to_world({-p_.shoulder_width / 2, 0, shoulders_})}};
}

}  // namespace carus::anatomy
