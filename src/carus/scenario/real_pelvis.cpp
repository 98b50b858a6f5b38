// SPDX-License-Identifier: Apache-2.0
#include "carus/scenario/real_pelvis.hpp"

#include <fmt/format.h>

#include <Eigen/Geometry>

#include "carus/core/error.hpp"
#include "carus/core/units.hpp"
#include "carus/imaging/extract_surface.hpp"
#include "carus/imaging/read_labels.hpp"
#include "carus/imaging/read_surface.hpp"
#include "carus/imaging/smooth_labels.hpp"
#include "carus/imaging/voxelise.hpp"
#include "carus/scenario/schema.hpp"

namespace carus::scenario {
namespace {

constexpr double smoothing = 0.8;            // [voxels]
constexpr double voxel_of_surfaces = 0.001;  // [m]

/// How messages call what the bones are from.
std::string name_of(const anatomy::BoneSource& source) { return source.file.empty() ? "pelvis.surfaces" : source.file; }

imaging::LabelVolume read_volume(const std::string& file) {
  if (!std::filesystem::exists(file))
    throw InputError(
        fmt::format("pelvis.from: {} is not there. This scenario takes its bones from a label volume that does not "
                    "come with Carus: put one there, or name another with --set pelvis.from=FILE and its labels with "
                    "pelvis.labels, or name surfaces with pelvis.surfaces",
                    file));
  return imaging::read_labels(file).volume;
}

/// Surfaces of several bones may cut into each other a little, as scanned ones do: voxels settle whose that is.
imaging::LabelVolume read_surfaces(const anatomy::BoneSource& source) {
  const auto& s = source.surfaces;
  std::vector<std::string> problems;
  std::vector<imaging::LabelledSurface> bones;
  for (const auto& [key, file, label] :
       {std::tuple{"innominate_right", s.right, source.right}, std::tuple{"innominate_left", s.left, source.left},
        std::tuple{"sacrum", s.sacrum, source.sacrum}, std::tuple{"coccyx", s.coccyx, source.coccyx}}) {
    if (file.empty())
      problems.push_back(fmt::format("pelvis.surfaces.{}: silent; allowed a file: all four bones or none", key));
    else if (!std::filesystem::exists(file))
      problems.push_back(fmt::format("pelvis.surfaces.{}: {} is not there", key, file));
    else
      try {
        bones.push_back({imaging::read_surface({file, s.unit, s.frame, ""}).surface, label});
      } catch (const InputError& e) {
        problems.push_back(fmt::format("pelvis.surfaces.{}: {}", key, e.what()));
      }
  }
  if (!problems.empty()) throw InputError(problems);
  return imaging::voxelise(bones, voxel_of_surfaces);
}

/// The solid of the bones, in the pelvis' own frame.
std::shared_ptr<const anatomy::GivenBones> solid(const imaging::LabelVolume& v, const anatomy::BoneSource& source,
                                                 const anatomy::BonyLandmarks& l) {
  const auto labels = std::make_shared<imaging::SmoothLabels>(
      v, std::vector<std::int32_t>{source.right, source.left, source.sacrum, source.coccyx}, smoothing,
      name_of(source));
  const Vec3 hinge = l.points.at("coccyx_hinge"),
             down = (l.points.at("sacrum_tip") - l.points.at("promontory")).normalized();
  auto bones = std::make_shared<anatomy::GivenBones>();
  bones->landmarks = l.points;
  bones->label = [labels, source, hinge, down, frame = l.frame](const Vec3& p) -> std::int32_t {
    const auto found = labels->label(frame.to_ras(p));
    if (found == 0) return anatomy::outside;
    if (found == source.right) return anatomy::innominate_right;
    if (found == source.left) return anatomy::innominate_left;
    return found == source.coccyx || (p - hinge).dot(down) > 0 ? anatomy::coccyx : anatomy::sacrum;
  };
  return bones;
}

/// Every measure within what the schema allows a pelvis at all.
void check(const Scenario& s, const anatomy::BonyLandmarks& l) {
  std::vector<std::string> problems;
  for (const auto& leaf : leaves(schema())) {
    if (!leaf.path.starts_with("pelvis.") || leaf.key->type != Type::quantity) continue;
    const auto it = l.measures.find(leaf.key->name);
    if (it == l.measures.end()) continue;
    const double unit = leaf.key->unit == "deg" ? units::deg : units::mm, value = it->second / unit;
    if (!(value >= leaf.key->minimum && value <= leaf.key->maximum))
      problems.push_back(
          fmt::format("{}: {}: {} measures {:.1f} {} there; allowed {}; are the labels those of a whole pelvis, in the "
                      "right order?",
                      s.file, leaf.path, name_of(s.anatomy.bones_from), value, leaf.key->unit, allowed(*leaf.key)));
  }
  if (!problems.empty()) throw InputError(problems);
}

/// Each within or near the volume: a slip of sign or unit is told, not built upon.
anatomy::SeenLandmarks seen(const anatomy::BoneSource& source, const imaging::LabelVolume& v) {
  constexpr double beside = 0.02;  // [m]
  Eigen::AlignedBox3d box;
  for (int corner = 0; corner < 8; ++corner)
    box.extend(v.position(
        {double((corner & 1) * v.size[0]), double((corner >> 1 & 1) * v.size[1]), double((corner >> 2) * v.size[2])}));
  std::vector<std::string> problems;
  anatomy::SeenLandmarks points;
  for (std::size_t i = 0; i < source.landmarks.size(); ++i) {
    const auto& l = source.landmarks[i];
    const Vec3 x(l.right, l.anterior, l.superior);
    points[l.name] = x;
    if (box.exteriorDistance(x) > beside) {
      const Vec3 low = 1e3 * box.min(), high = 1e3 * box.max();
      problems.push_back(fmt::format(
          "pelvis.landmarks[{}]: {} at R {:.0f}, A {:.0f}, S {:.0f} mm lies outside {}, which reaches from {:.0f}, "
          "{:.0f}, {:.0f} to {:.0f}, {:.0f}, {:.0f} mm; are its coordinates RAS, not LPS?",
          i, l.name, 1e3 * x.x(), 1e3 * x.y(), 1e3 * x.z(), name_of(source), low.x(), low.y(), low.z(), high.x(),
          high.y(), high.z()));
    }
  }
  if (!problems.empty()) throw InputError(problems);
  return points;
}

}  // namespace

RealPelvis read_real_pelvis(const anatomy::BoneSource& source) {
  if (!source.file.empty() && source.surfaces.given())
    throw InputError("pelvis.from and pelvis.surfaces: both are given; leave one out");
  const auto v = source.file.empty() ? read_surfaces(source) : read_volume(source.file);
  const auto landmarks = seen(source, v);
  const auto bone = [&](int label) {
    return imaging::extract_surface(v, label, {.smoothing = smoothing, .spacing = 0.0015}, name_of(source)).surface;
  };
  RealPelvis r;
  r.landmarks = anatomy::find_landmarks(
      {bone(source.right), bone(source.left), bone(source.sacrum), bone(source.coccyx)}, landmarks);
  r.bones = solid(v, source, r.landmarks);
  return r;
}

void take_real_pelvis(Scenario& s) {
  auto& a = s.anatomy;
  if (!a.bones_from.given()) return;
  auto real = read_real_pelvis(a.bones_from);
  check(s, real.landmarks);
  a.pelvis = anatomy::fitted(a.pelvis, real.landmarks);
  if (a.bones_from.fit_canal) a.canal = anatomy::fitted(a.canal, real.landmarks);
  a.bones = std::move(real.bones);
}

}  // namespace carus::scenario
