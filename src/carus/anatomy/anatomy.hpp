// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>
#include <map>
#include <memory>
#include <string>
#include <vector>

#include "carus/mesh/tet_mesh.hpp"

namespace carus::anatomy {

/// Labels of the reference anatomy's solids. A body is a group of labels meshed together.
enum Label : std::int32_t {
  outside = 0,
  skull = 1,
  fetal_body = 2,
  fetal_skin = 3,  // body "fetus"
  uterine_fundus = 11,
  uterine_body = 12,
  lower_segment = 13,
  vaginal_canal = 14,
  levator_ani = 22,
  perineal_body = 23,  // body "uterus": the floor is grown together with the canal
  abdomen = 21,        // body "abdomen", with the bones
  innominate_right = 31,
  innominate_left = 32,
  sacrum = 33,
  coccyx = 34,  // coccyx: the lower sacrum that can rock, with the coccyx
};
const char* name_of(std::int32_t label);

enum class Position { OA, LOA, LOT, LOP, OP, ROP, ROT, ROA };

/// Defaults and sources: targets.md-derived, documented in schema/scenario.schema.json. Lengths in metres, angles in
/// radians.
struct PelvisParameters {
  double obstetric_conjugate = 0.1217, transverse_inlet = 0.1295, interspinous = 0.1123, intertuberous = 0.1206;
  double sagittal_outlet = 0.1158, pubic_arch_angle = 1.5237, sacral_height = 0.098, sacral_depth = 0.018;
  double sacrococcygeal_angle = 1.9024, symphysis_height = 0.042, bone_thickness = 0.010;
  double spines_depth = 0.060;  ///< of the ischial spines below the inlet, along -z
};
struct CanalParameters {
  double radius = 0.046;        ///< inner radius where the cervix is fully dilated: the upper canal (calibrated)
  double vulva_radius = 0.020;  ///< inner radius at the vulva, which the head stretches
  double taper_start = 0.030;   ///< s [m] from which the canal narrows down to the vulva
  double taper_forward = 0.7;   ///< 0: it narrows evenly; 1: from behind only, its front stays where it is
  double floor_top = 0.060;     ///< s [m] where the pelvic floor begins
  double bend_radius = 0.080;   ///< radius of the axis' arc round the symphysis
  double bend_start = -0.045;   ///< z at which the straight part ends
  double bend_angle = 0.87;     ///< rad, where the canal ends at the vulva
};
struct UterusParameters {
  double wall_fundus = 0.0068, wall_body = 0.0060, wall_lower_segment = 0.0047, wall_canal = 0.0047;
  double gap = 0.0008;  ///< to the fetus at the start
};
struct AbdomenParameters {
  double wall = 0.030;  ///< thickness of the trunk round the uterus
  double gap = 0.0008;  ///< cavity to uterus at the start
  double levator_thickness = 0.006, perineal_body_thickness = 0.024;
};
struct FetusParameters {
  double biparietal = 0.0935, occipitofrontal = 0.116, suboccipitobregmatic = 0.095;
  double shoulder_width = 0.122, length = 0.300, skin_thickness = 0.005;
  double flexion = 1.05;      ///< rad from the military attitude
  double head_start = 0.040;  ///< z of the head's centre at the start
  Position position = Position::LOT;
  double asynclitism = 0.0;  ///< rad
};
/// Bones that are not generated but given: a real pelvis, in its own frame.
struct GivenBones {
  std::function<std::int32_t(const Vec3&)> label;  ///< innominate_right ... coccyx, or outside; thread-safe
  std::map<std::string, Vec3> landmarks;           ///< by the names of Pelvis::landmarks(), without the vulva's
};
/// A landmark that the user has seen, in the RAS frame of the volume or the surfaces.
struct GivenLandmark {
  std::string name;
  double right = 0, anterior = 0, superior = 0;  ///< [m]
};
/// Bones as closed surfaces, a file each.
struct BoneSurfaces {
  std::string right, left, sacrum, coccyx;
  std::string unit, frame;  ///< of all files: imaging::convention

  [[nodiscard]] bool given() const { return !(right + left + sacrum + coccyx).empty(); }
};
/// Where given bones are read from; all else about them follows from it. Neither a volume nor surfaces: bones are
/// generated.
struct BoneSource {
  std::string file;  ///< a label volume
  int right = 2, left = 1, sacrum = 3, coccyx = 4;
  BoneSurfaces surfaces;
  std::vector<GivenLandmark> landmarks;  ///< take the place of those found
  bool fit_canal = true;                 ///< bend_radius and bend_start follow from where the symphysis is

  [[nodiscard]] bool given() const { return !file.empty() || surfaces.given(); }
};
struct MeshSize {
  double fetus, uterus, abdomen_inner, abdomen_outer, bone;  ///< facet edge [m]
};
struct Parameters {
  PelvisParameters pelvis;
  CanalParameters canal;
  UterusParameters uterus;
  AbdomenParameters abdomen;
  FetusParameters fetus;
  MeshSize mesh{};
  BoneSource bones_from;
  std::shared_ptr<const GivenBones> bones;  ///< in the place of generated ones; `pelvis` then holds their measures
};

/// Axis of the birth canal, from the fundus down: straight along -z, then an arc forward round the symphysis, then
/// straight on.
class CanalAxis {
 public:
  explicit CanalAxis(const CanalParameters& p) : p_(p) {}
  /// s: arc length [m] from the inlet's centre downwards (negative above it).
  [[nodiscard]] Vec3 point(double s) const;
  [[nodiscard]] Vec3 tangent(double s) const;         ///< unit, towards the vulva
  [[nodiscard]] double nearest(const Vec3& x) const;  ///< s of the nearest point
  /// Inner radius of the canal at rest [m]: constant down to taper_start, then smoothly to that of the vulva.
  [[nodiscard]] double radius(double s) const;
  /// Centre of the canal at rest: before the axis by taper_forward of what it has narrowed.
  [[nodiscard]] Vec3 centre(double s) const;
  /// Whether x lies on the bend's inner side, nearer to its centre than 0.7 of its radius: there the cross-sections run
  /// together.
  [[nodiscard]] bool inside_bend(const Vec3& x) const;
  [[nodiscard]] double vulva() const { return -p_.bend_start + p_.bend_radius * p_.bend_angle; }

 private:
  CanalParameters p_;
};

/// One body of tets with everything later stages may want to name on it.
struct Body {
  std::string name;  ///< "fetus", "uterus", "abdomen"
  mesh::TetMesh mesh;
  std::vector<mesh::NamedNodes> nodes;  ///< e.g. "back", "thighs", "vulva", "vaginal_canal", "lower_uterus_tie"
  std::vector<mesh::NamedSurface>
      surfaces;  ///< e.g. "skin", "inner", "outer", "cavity", "bone", "contraction", "push", "tone"
};

/// Local frame of the uterine wall at a point: the directions in which muscle retracts.
struct WallFrame {
  Vec3 meridian, normal;  ///< unit; the hoop direction is normal x meridian
  double s;               ///< coordinate along the canal axis [m], the ring the point belongs to
  double dome;  ///< 0 on the tube, 1 on the dome, where the meridian is singular and retraction isotropic in the plane
};

struct Anatomy {
  Parameters parameters;
  Body fetus, uterus, abdomen;
  std::map<std::string, Vec3> landmarks;              ///< see landmarks.hpp
  std::vector<WallFrame> uterine_wall;                ///< one per tet of the uterus
  std::map<std::string, double> requested, measured;  ///< pelvimetry and biometry [m, rad], by the same keys
  std::vector<std::string> warnings;
};

}  // namespace carus::anatomy
