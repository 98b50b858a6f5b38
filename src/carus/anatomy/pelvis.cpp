// SPDX-License-Identifier: Apache-2.0
#include "carus/anatomy/pelvis.hpp"

#include <fmt/format.h>

#include <Eigen/Geometry>
#include <limits>

#include "carus/anatomy/shapes.hpp"
#include "carus/core/error.hpp"

namespace carus::anatomy {
namespace {

using Vec2 = Eigen::Vector2d;

// Proportions that no pelvimetry names [m].
constexpr double symphysis_lean = 0.0025;  // the lower end of the symphysis stands behind the upper
constexpr double coccyx_length = 0.025;
constexpr double hinge_at = 0.55;  // of the sacral arc: the third sacral vertebra
constexpr double unrolling_radius = 0.062;
constexpr double ramus_radius = 0.010;
constexpr double sacrum_above = 0.012;  // top of the first sacral vertebra above the promontory
constexpr double edge = 0.003;          // rounding of plates' edges
constexpr double wing_height = 0.075;
const Vec2 tuber_yz(0.046, -0.106);

/// The point at distances a from A and b from B, on the right when looking from A to B. Throws if there is none.
Vec2 meet(const Vec2& A, double a, const Vec2& B, double b) {
  const double d = (B - A).norm(), t = (a * a - b * b + d * d) / (2 * d), h2 = a * a - t * t;
  if (h2 <= 0)
    throw InputError(fmt::format(
        "anatomy.pelvis: sacral height, sacrococcygeal angle and sagittal outlet do not meet ({:.0f} and {:.0f} mm "
        "over {:.0f} mm from promontory to symphysis); hint: keep near 98 mm, 109 deg, 116 mm",
        a * 1e3, b * 1e3, d * 1e3));
  const Vec2 e = (B - A) / d;
  return A + t * e + std::sqrt(h2) * Vec2(e.y(), -e.x());
}

}  // namespace

Pelvis::Pelvis(const PelvisParameters& p, const CanalParameters& canal, std::shared_ptr<const GivenBones> bones)
    : p_(p), axis_(canal), bones_(std::move(bones)) {
  if (!bones_) generate();
}

void Pelvis::generate() {
  const auto& p = p_;
  const double half = p.obstetric_conjugate / 2;
  const Vec2 P(-half, 0);
  symphysis_bottom_ = {half - symphysis_lean, -p.symphysis_height};
  // |PT| by the law of cosines; T from the sagittal outlet; Q behind the line PT.
  const double c = coccyx_length, h = p.sacral_height;
  const double PT = std::sqrt(h * h + c * c - 2 * h * c * std::cos(p.sacrococcygeal_angle));
  coccyx_tip_ = meet(P, PT, symphysis_bottom_, p.sagittal_outlet);
  sacral_tip_ = meet(P, h, coccyx_tip_, c);

  // Anterior face: above the promontory, a circular arc of the sacral depth from P to Q, the coccyx straight to T.
  curve_.push_back(P + sacrum_above * Vec2(-0.5, 0.866));
  const Vec2 chord = sacral_tip_ - P, mid = (P + sacral_tip_) / 2, back = Vec2(chord.y(), -chord.x()).normalized();
  const double sag = p.sacral_depth, R = (h * h / 4 + sag * sag) / (2 * sag),
               half_angle = std::asin(std::min(1.0, h / 2 / R));
  const Vec2 centre = mid + (sag - R) * back;
  constexpr int segments = 16;
  for (int i = 0; i <= segments; ++i) {
    const double a = half_angle * (2.0 * i / segments - 1);
    curve_.push_back(centre + R * (std::cos(a) * back + std::sin(a) * chord.normalized()));
  }
  curve_.push_back(coccyx_tip_);
  along_.push_back(-sacrum_above);
  for (std::size_t i = 1; i < curve_.size(); ++i) along_.push_back(along_.back() + (curve_[i] - curve_[i - 1]).norm());
  end_ = along_.back();
  tip_ = end_ - c;
  hinge_ = hinge_at * tip_;

  tuber_ = {p.intertuberous / 2, tuber_yz.x(), tuber_yz.y()};
  tuber_s_ = axis_.nearest(tuber_);
  const Vec3 on_axis = axis_.point(p.spines_depth);
  spine_ = {p.interspinous / 2, on_axis.y() - 0.018, -p.spines_depth};
  // Inferior rami: inner edges from the symphysis' lower end, half the pubic arch angle to each side, in the plane
  // through the tubers.
  const Vec3 S(0, symphysis_bottom_.x(), symphysis_bottom_.y());
  const Vec3 down = Vec3(0, tuber_.y() - S.y(), tuber_.z() - S.z()).normalized();
  const double a = p.pubic_arch_angle / 2;
  const Vec3 inner = std::sin(a) * Vec3::UnitX() + std::cos(a) * down,
             outward = std::cos(a) * Vec3::UnitX() - std::sin(a) * down;
  const Vec3 front = Vec3(0, -down.z(), down.y());
  const Vec3 offset = (ramus_radius + 0.0007) * outward + 0.006 * (front.y() > 0 ? front : Vec3(-front));
  ramus_start_ = S + 0.004 * inner + offset;
  ramus_end_ = S + (tuber_.x() / std::sin(a)) * inner + offset;
}

double Pelvis::half_width(double s) const {
  const double inlet = p_.transverse_inlet / 2, tubers = p_.intertuberous / 2 + 0.0005,
               spines = p_.interspinous / 2 + 0.004;
  if (s < 0) return inlet + 0.75 * -s;  // the iliac wings flare
  return inlet + (spines - inlet) * smooth_step(0, p_.spines_depth, s) +
         (tubers - spines) * smooth_step(p_.spines_depth, 0.1, s);
}

double Pelvis::half_depth(double s) const {
  const double half = p_.obstetric_conjugate / 2;
  if (s < 0) return half + 0.45 * -s;
  return half - symphysis_lean * std::min(s / p_.symphysis_height, 1.5);
}

double Pelvis::channel(const Vec3& x) const {
  const auto c = canal_coordinates(axis_, x);
  return ellipse(c.lateral, c.front, half_width(c.s), half_depth(c.s));
}

Eigen::Vector2d Pelvis::unroll(const Vec3& x) const {
  const auto c = canal_coordinates(axis_, x);
  return {unrolling_radius * std::atan2(c.front, std::abs(c.lateral)), -c.s};
}

double Pelvis::innominate(const Vec3& x) const {
  const Vec3 m(std::abs(x.x()), x.y(), x.z());
  const auto c = canal_coordinates(axis_, m);
  const double d = ellipse(c.lateral, c.front, half_width(c.s), half_depth(c.s));
  const double u = unrolling_radius * std::atan2(c.front, c.lateral), v = -c.s;
  const double H = p_.symphysis_height, t0 = p_.bone_thickness;

  // Plane shapes: pubis with superior ramus, body round the acetabulum, ischium, part that meets the sacrum, wing.
  double plane = rectangle(u, v, 0.076, 0.105, -H - 0.003, 0.002);
  plane = smooth_union(plane, rectangle(u, v, 0.010, 0.105, -0.018, 0.002), 0.008);
  plane = smooth_union(plane, std::hypot(u - 0.006, v + 0.015) - 0.026, 0.008);
  const double ischium = capsule({u, v, 0}, {-0.004, -0.035, 0}, {0.004, -tuber_s_ + 0.004, 0}, 0.014, 0.012);
  plane = smooth_union(plane, ischium, 0.008);
  plane = smooth_union(plane, rectangle(u, v, -0.062, 0, -0.020, 0.020), 0.008);
  const double wing = std::max(ellipse(u + 0.008, v - 0.005, 0.052, wing_height), -v - 0.005);
  plane = smooth_union(plane, wing, 0.008);
  const double bulge = std::exp(-(std::pow(u - 0.006, 2) + std::pow(v + 0.015, 2)) / std::pow(0.024, 2)) +
                       std::exp(-(u * u + std::pow(v + tuber_s_ - 0.008, 2)) / std::pow(0.018, 2));
  const double t = t0 * (0.8 + bulge + 0.5 * smooth_step(0.07, 0.085, u));
  double bone = rounded_intersection(plane, std::max(-d, d - t), edge);

  const Vec3 spine_root = spine_ + Vec3(0.014, 0.004, 0);
  bone = smooth_union(bone, capsule(m, spine_ + Vec3(0.003, 0, 0), spine_root, 0.003, 0.008), 0.003);
  bone = smooth_union(bone, capsule(m, ramus_start_, ramus_end_, ramus_radius, ramus_radius), 0.003);
  // The socket of the hip, for looks: hollow, with bone left behind it.
  const Vec3 hip(half_width(0.015) + 2.1 * t0 + 0.012, 0.006, -0.015);
  return std::max(bone, 0.022 - (m - hip).norm());
}

double Pelvis::sacral(const Vec3& x, double& along) const {
  const Vec2 q(x.y(), x.z());
  double best = std::numeric_limits<double>::infinity(), behind = 0, beyond = -1;
  for (std::size_t i = 0; i + 1 < curve_.size(); ++i) {
    const Vec2 e = (curve_[i + 1] - curve_[i]).normalized(), w = q - curve_[i];
    const double length = along_[i + 1] - along_[i], raw = w.dot(e), t = std::clamp(raw, 0.0, length);
    const double distance = (w - t * e).norm();
    if (distance >= best) continue;
    best = distance;
    along = along_[i] + t;
    const Vec2 back(e.y(), -e.x());
    behind = w.dot(back) >= 0 ? distance : -distance;
    beyond = (i == 0 && raw < 0) ? -raw : (i + 2 == curve_.size() && raw > length) ? raw - length : -1;
    if (beyond > 0) behind = w.dot(back);
  }
  const double f = std::clamp(along / tip_, 0.0, 1.0);
  // Alae sweep forward along the inlet's oval; the lower part is flat.
  behind += (1 - f) * 0.0075e3 * x.x() * x.x();
  const double thickness = along < tip_ ? 0.026 + (0.009 - 0.026) * f : 0.009 - 0.002 * (along - tip_) / (end_ - tip_);
  const double width = along < tip_ ? 0.054 - 0.020 * smooth_step(0, 0.45, f) - 0.020 * smooth_step(0.35, 1, f)
                                    : 0.014 - 0.006 * (along - tip_) / (end_ - tip_);
  const double plate = std::max({-behind, behind - thickness, beyond});
  return rounded_intersection(plate, std::abs(x.x()) - width, edge);
}

std::int32_t Pelvis::label(const Vec3& x) const {
  if (bones_) return bones_->label(x);
  double along = 0;
  if (x.y() < -0.01 && sacral(x, along) < 0) return along > hinge_ ? coccyx : sacrum;
  if (innominate(x) >= 0) return outside;
  return x.x() >= 0 ? innominate_right : innominate_left;
}

std::map<std::string, Vec3> Pelvis::landmarks() const {
  if (bones_) {
    auto given = bones_->landmarks;
    given["vulva_centre"] = axis_.centre(axis_.vulva()), given["vulva_normal"] = axis_.tangent(axis_.vulva());
    return given;
  }
  const auto mid = [](const Vec2& q) { return Vec3(0, q.x(), q.y()); };
  const auto mirrored = [](const Vec3& x) { return Vec3(-x.x(), x.y(), x.z()); };
  Vec2 hinge = curve_.front();
  for (std::size_t i = 0; i + 1 < curve_.size(); ++i)
    if (hinge_ >= along_[i] && hinge_ < along_[i + 1])
      hinge = curve_[i] + (hinge_ - along_[i]) / (along_[i + 1] - along_[i]) * (curve_[i + 1] - curve_[i]);
  return {{"inlet", Vec3::Zero()},
          {"promontory", {0, -p_.obstetric_conjugate / 2, 0}},
          {"symphysis_top", {0, p_.obstetric_conjugate / 2, 0}},
          {"symphysis_bottom", mid(symphysis_bottom_)},
          {"spine_right", spine_},
          {"spine_left", mirrored(spine_)},
          {"tuber_right", tuber_},
          {"tuber_left", mirrored(tuber_)},
          {"ramus_right", (ramus_start_ + ramus_end_) / 2},
          {"ramus_left", mirrored((ramus_start_ + ramus_end_) / 2)},
          {"sacrum_tip", mid(sacral_tip_)},
          {"coccyx_tip", mid(coccyx_tip_)},
          {"coccyx_hinge", mid(hinge)},
          {"vulva_centre", axis_.centre(axis_.vulva())},
          {"vulva_normal", axis_.tangent(axis_.vulva())}};
}

}  // namespace carus::anatomy
