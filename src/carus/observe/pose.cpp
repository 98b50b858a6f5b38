// SPDX-License-Identifier: Apache-2.0
#include "carus/observe/pose.hpp"

#include <Eigen/Geometry>
#include <Eigen/SVD>
#include <algorithm>
#include <cmath>

#include "carus/core/error.hpp"

namespace carus::observe {

Pose best_fit(const std::vector<Vec3>& rest, const std::vector<Vec3>& current, const std::vector<std::int32_t>& nodes) {
  CARUS_ASSERT(nodes.size() >= 3);
  Pose pose;
  for (const auto n : nodes) {
    pose.rest_centre += rest[n];
    pose.centre += current[n];
  }
  pose.rest_centre /= double(nodes.size());
  pose.centre /= double(nodes.size());
  // H = Σ (x - x̄)(X - X̄)ᵀ = U S Vᵀ;  R = U diag(1, 1, det U Vᵀ) Vᵀ
  Mat3 H = Mat3::Zero();
  for (const auto n : nodes) H += (current[n] - pose.centre) * (rest[n] - pose.rest_centre).transpose();
  const Eigen::JacobiSVD<Mat3> svd(H, Eigen::ComputeFullU | Eigen::ComputeFullV);
  const double handed = (svd.matrixU() * svd.matrixV().transpose()).determinant() < 0 ? -1.0 : 1.0;
  pose.rotation = svd.matrixU() * Vec3(1, 1, handed).asDiagonal() * svd.matrixV().transpose();
  return pose;
}

Vec3 rotation_vector(const Mat3& R) {
  const Eigen::AngleAxisd a(R);
  return a.angle() * a.axis();
}

HeadAxes HeadAxes::from(const Vec3& to_right, const Vec3& to_face) {
  const Vec3 right = to_right.normalized();
  const Vec3 face = (to_face - to_face.dot(right) * right).normalized();
  return {right, face, right.cross(face)};
}

Attitude attitude(const HeadAxes& head, const Vec3& tangent) {
  const Vec3 anterior = Vec3::UnitX().cross(tangent).normalized();
  const Vec3 right = tangent.cross(anterior);
  // Across the canal the occiput lies along right ear × tangent, whatever the flexion.
  const Vec3 occiput = head.right.cross(tangent);
  return {std::atan2(-head.face.dot(tangent), head.vertex.dot(tangent)),
          std::atan2(occiput.dot(right), occiput.dot(anterior)),
          std::asin(std::clamp(head.right.dot(tangent), -1.0, 1.0))};
}

double unwrapped(double angle, double reference) { return angle - 2 * pi * std::round((angle - reference) / (2 * pi)); }

}  // namespace carus::observe
