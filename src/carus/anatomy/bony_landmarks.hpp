// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <map>
#include <string>

#include "carus/anatomy/anatomy.hpp"
#include "carus/mesh/surface.hpp"

namespace carus::anatomy {

/// The bones of one pelvis as closed surfaces, in RAS and metres, standing roughly upright.
struct PelvicBones {
  mesh::Surface right, left, sacrum, coccyx;
};

/// From RAS to the pelvis' own frame (docs/theory/frame.md): p = rotation (x - origin).
struct PelvicFrame {
  Mat3 rotation = Mat3::Identity();
  Vec3 origin = Vec3::Zero();
  [[nodiscard]] Vec3 to_pelvis(const Vec3& x) const { return rotation * (x - origin); }
  [[nodiscard]] Vec3 to_ras(const Vec3& p) const { return rotation.transpose() * p + origin; }
};

/// What a pelvis is measured by.
struct BonyLandmarks {
  std::map<std::string, Vec3> points;  ///< in the pelvis' own frame [m]; the names are Pelvis::landmarks()'s
  PelvicFrame frame;
  std::map<std::string, double> measures;  ///< pelvimetry by PelvisParameters' names, and diagonal and true conjugate
                                           ///< [m, rad]
};

/// Landmarks that somebody has seen take the place of those found, by name, in RAS [m].
using SeenLandmarks = std::map<std::string, Vec3>;

/// Finds the landmarks on the bones' nodes (accuracy: the nodes' spacing) and measures the pelvis.
///
/// - median plane: halfway between the innominate bones' centroids, across the line that joins them;
/// - symphysis: where the innominate bones come closest in front, the midpoints of their facing nodes; its top is the
///   one nearest to the promontory (that makes the obstetric conjugate), its bottom the one farthest down the joint;
/// - promontory: of the sacrum's nodes within 10 mm of the median plane and in its upper third, the foremost;
/// - frame: origin halfway between promontory and top of the symphysis, y along that line, x to the right;
/// - spines: on each side, of the ischium's nodes 50 to 95 mm below the inlet and within 30 mm of its centre in y, the
///   one farthest inward, a third as much backward and downward;
/// - tuberosities: on each side, of the ischium's nodes within 12 mm of its lowest in height and in y, the innermost;
/// - coccyx' tip: its node farthest from the sacrum; sacrum's tip: its node nearest to the coccyx;
/// - hinge of the coccyx: on the sacrum's front in the median plane, 0.55 of the way from promontory to tip, as in the
///   generated pelvis.
///
/// Throws InputError, saying which landmark is nowhere and why, if the bones are not those of one upright pelvis.
/// Of those seen, promontory and symphysis are taken into the median plane, as those found are.
BonyLandmarks find_landmarks(const PelvicBones& bones, const SeenLandmarks& seen = {});

/// The generated pelvis' parameters with the measures of this one in the place of averages.
PelvisParameters fitted(PelvisParameters p, const BonyLandmarks& landmarks);

/// The canal's axis through this pelvis: it begins to bend, and bends round a centre, that lies to the lower border of
/// the symphysis as in the reference anatomy (12 mm in front, 7 mm above).
CanalParameters fitted(CanalParameters p, const BonyLandmarks& landmarks);

}  // namespace carus::anatomy
