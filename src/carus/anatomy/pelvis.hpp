// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "carus/anatomy/canal_axis.hpp"

namespace carus::anatomy {

/// The bony pelvis as labelled solids: two innominate bones, the fixed upper sacrum, and the lower sacrum with coccyx
/// that can rock.
///
/// The inner face of the innominate bones is an oval tube round the canal's axis; on it, unrolled into (u, v) = (round,
/// up), the bone is drawn as plane shapes (ilium, pubis, ischium: what lies between is the sciatic notch and the
/// obturator foramen) and given thickness. Given bones take the place of all that; the tube remains, as wide as they
/// measure, for the soft parts to follow.
///
///     promontory P ●────── inlet, z = 0 ──────● symphysis top
///                  ╲ hollow                   │ symphysis, 42 mm
///          sacrum   )                         ● S
///                  ╱        axis bends  ⟶
///                 ● Q sacral tip
///                  ╲__● T tip of the coccyx:  |ST| sagittal outlet, |PQ| sacral height, angle PQT sacrococcygeal
class Pelvis {
 public:
  /// bones: given ones, or null to generate them. Throws InputError if the sagittal lengths of generated ones cannot
  /// meet in a triangle.
  Pelvis(const PelvisParameters& p, const CanalParameters& canal, std::shared_ptr<const GivenBones> bones = nullptr);
  [[nodiscard]] std::int32_t label(const Vec3& x) const;
  [[nodiscard]] double channel(const Vec3& x) const;  ///< to the bony canal's inner face: negative within [m]
  /// Round (from the side to the front, scaled to length) and up: the unrolled inner face.
  [[nodiscard]] Eigen::Vector2d unroll(const Vec3& x) const;
  [[nodiscard]] std::map<std::string, Vec3> landmarks() const;
  [[nodiscard]] const CanalAxis& axis() const { return axis_; }

 private:
  [[nodiscard]] double half_width(double s) const;
  [[nodiscard]] double half_depth(double s) const;
  [[nodiscard]] double innominate(const Vec3& x) const;  ///< right and left alike: mirrored in x = 0
  [[nodiscard]] double sacral(const Vec3& x, double& along) const;

  void generate();

  PelvisParameters p_;
  CanalAxis axis_;
  std::shared_ptr<const GivenBones> bones_;
  Eigen::Vector2d symphysis_bottom_, sacral_tip_, coccyx_tip_;  ///< (y, z)
  std::vector<Eigen::Vector2d> curve_;            ///< anterior face of sacrum and coccyx at x = 0, from above
  std::vector<double> along_;                     ///< arc length from the promontory
  double tip_, end_, hinge_;                      ///< arc lengths of Q, T, hinge
  Vec3 tuber_, spine_, ramus_start_, ramus_end_;  ///< of the right side; tuber and spine on the inner face
  double tuber_s_;
};

}  // namespace carus::anatomy
