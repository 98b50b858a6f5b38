// SPDX-License-Identifier: Apache-2.0
#include "carus/meshing/build.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "carus/anatomy/abdomen.hpp"
#include "carus/anatomy/measure.hpp"
#include "carus/core/error.hpp"
#include "carus/mesh/depth.hpp"
#include "carus/mesh/spatial_order.hpp"
#include "carus/meshing/keep_clear.hpp"
#include "carus/meshing/labelled_solid.hpp"
#include "carus/meshing/layer.hpp"
#include "carus/meshing/raise_altitudes.hpp"
#include "carus/meshing/regions.hpp"
#include "carus/meshing/wall.hpp"

namespace carus::meshing {
namespace {

using namespace anatomy;

/// A facet of edge h that spans a surface of radius R keeps a sagitta of about h^2 / (6 R) from it (circumradius h/sqrt
/// 3).
constexpr double bag_radius = 0.05;
constexpr double altitude_of_edge = 0.25;   // what altitudes are raised to, of the edge
constexpr double coccyx_size = 0.0060;      // [m]
constexpr double least_clearance = 0.0007;  // between bodies, whatever the facets [m]
constexpr double most_overlap = 0.006;      // of walls at rest and given bones [m]
double sagitta(double h) { return h * h / (6 * bag_radius); }

mesh::TetMesh mesh_fetus(const Parameters& p, const Fetus& fetus, const Uterus& uterus) {
  const double h = p.mesh.fetus;
  const Vec3 middle(0, 0, fetus.bottom_z() + p.fetus.length / 2);
  auto m = mesh_labelled_solid(
      [&](const Vec3& x) { return fetus.core(x); }, {middle, 0.55 * p.fetus.length + 0.01},
      {.facet = [=](const Vec3&, std::int32_t, std::int32_t) { return h; },
       .distance = [=](const Vec3&, std::int32_t a, std::int32_t) { return a == outside ? 0.10 * h : 0.15 * h; },
       .cell = [=](const Vec3&, std::int32_t) { return 2.2 * h; },
       .seed_spacing = 0.004});
  raise_altitudes(m, altitude_of_edge * h);
  const auto core = mesh::boundary(m);
  add_layer(
      m, core, [&](const Vec3& x) { return fetus.on_skin(x); }, [](const Vec3&) { return fetal_skin; });
  raise_altitudes(m, altitude_of_edge * h);
  // The wall's inner facets reach into the bag by their sagitta.
  keep_clear(
      m, [&](const Vec3& x) { return -uterus.inner_distance(x); },
      [&](const Vec3& x) { return Vec3(-uterus.frame(x).normal); }, least_clearance + sagitta(p.mesh.uterus));
  return m;
}

mesh::TetMesh mesh_abdomen(const Parameters& p, const Abdomen& solid, const Uterus& uterus, const Pelvis& pelvis,
                           const Fetus& fetus) {
  const auto& s = p.mesh;
  const auto soft_size = [&solid, s](const Vec3& x) {
    return std::min(s.abdomen_outer, s.abdomen_inner + 0.5 * std::max(solid.cavity(x) - 0.004, 0.0));
  };
  // Bone away from the canal (wings, backs) may be coarser: nothing touches it. The coccyx keeps its shape in any
  // resolution.
  const Vec3 tip = pelvis.landmarks().at("coccyx_tip");
  const auto bone_size = [&pelvis, s, tip](const Vec3& x) {
    const double h = s.bone * (1 + std::clamp(10 * pelvis.channel(x) - 0.12, 0.0, 0.4));
    return std::min(h, coccyx_size + std::max((x - tip).norm() - 0.030, 0.0));
  };
  const double top = fetus.breech_z() + 0.12, bottom = -0.15;
  auto m = mesh_labelled_solid(
      [&](const Vec3& x) { return solid.label(x); }, {Vec3(0, 0, (top + bottom) / 2), (top - bottom) / 2 + 0.05},
      {.facet = [=](const Vec3& x, std::int32_t,
                    std::int32_t b) { return b >= innominate_right ? bone_size(x) : soft_size(x); },
       // Closer than this would refine without end where surfaces meet in an edge; keep_clear sees to the gap.
       .distance = [=](const Vec3& x, std::int32_t,
                       std::int32_t b) { return b >= innominate_right ? 0.12 * bone_size(x) : 0.10 * soft_size(x); },
       .cell = [=](const Vec3& x,
                   std::int32_t label) { return label >= innominate_right ? 1.3 * s.bone : 1.3 * soft_size(x); },
       .seed_spacing = 0.004});
  const double altitude = altitude_of_edge * std::min(s.abdomen_inner, s.bone);
  for (int round = 0; round < 2; ++round) {  // each undoes a little of the other; the gap has the last word
    raise_altitudes(m, altitude);
    keep_clear(
        m, [&](const Vec3& x) { return uterus.outer_distance(x); },
        [&](const Vec3& x) { return uterus.frame(x).normal; }, least_clearance);
  }
  return m;
}

/// Given bones are where they are: the walls at rest may lie against them, not in them.
void require_room(Anatomy& a, const Uterus& uterus, const Pelvis& pelvis) {
  const auto o = overlap(uterus, pelvis);
  a.measured["overlap_of_wall_and_bone"] = o.depth;
  const auto told = fmt::format(
      "the canal at rest lies {:.1f} mm deep in {} at ({:.0f}, {:.0f}, {:.0f}) mm, {:.1f} ml of bone in all",
      o.depth * 1e3, name_of(pelvis.label(o.where)), o.where.x() * 1e3, o.where.y() * 1e3, o.where.z() * 1e3,
      o.volume * 1e6);
  if (o.depth > most_overlap)
    throw InputError(
        fmt::format("pelvis: {}; at most {:.0f} mm can give way; lower canal.radius or uterus.wall_canal, or set "
                    "pelvis.fit_canal "
                    "to false and lay canal.bend_start and bend_radius yourself",
                    told, most_overlap * 1e3));
  if (o.depth > 0) a.warnings.push_back(told + "; it gives way in the mesh");
}

/// Floor and bone at rest may lie in each other a little: contact pushes them apart in the first steps.
void require_room_for_floor(Anatomy& a) {
  const auto floor = [](std::int32_t label) { return label == levator_ani || label == perineal_body; };
  const auto bone = [](std::int32_t label) { return label >= innominate_right; };
  const auto &soft = a.uterus.mesh, &hard = a.abdomen.mesh;
  const auto in_bone = mesh::deepest(soft, floor, hard, bone), in_floor = mesh::deepest(hard, bone, soft, floor);
  const auto& [depth, where] = in_bone.depth > in_floor.depth ? in_bone : in_floor;
  a.measured["overlap_of_floor_and_bone"] = depth;
  if (depth < 1e-5) return;  // they touch
  const auto told =
      fmt::format("pelvic floor and bone at rest lie {:.1f} mm deep in each other at ({:.0f}, {:.0f}, {:.0f}) mm",
                  depth * 1e3, where.x() * 1e3, where.y() * 1e3, where.z() * 1e3);
  if (depth > most_overlap)
    throw InputError(
        fmt::format("abdomen: {}; at most {:.0f} mm can give way; lower abdomen.perineal_body_thickness or "
                    "abdomen.levator_thickness",
                    told, most_overlap * 1e3));
  a.warnings.push_back(told + "; contact pushes them apart in the first steps");
}

}  // namespace

Anatomy build(const Parameters& given) {
  Anatomy a;
  a.parameters = given;
  Parameters p = given;
  // Gaps hold between meshes, not only between shapes: a convex body's facets lie inside it, a cavity's facets cut into
  // the cavity.
  p.uterus.gap += sagitta(p.mesh.uterus);
  p.abdomen.gap += sagitta(p.mesh.abdomen_inner);
  const Fetus fetus(p.fetus);
  const Uterus uterus(p, fetus);
  const Pelvis pelvis(p.pelvis, p.canal, p.bones);
  const Abdomen abdomen(p, uterus, pelvis);
  if (given.bones) require_room(a, uterus, pelvis);

  a.fetus = {"fetus", mesh_fetus(p, fetus, uterus), {}, {}};
  a.uterus = {
      "uterus", mesh_wall(uterus, PelvicFloor(p.abdomen, p.canal), p.abdomen.levator_thickness, p.mesh.uterus), {}, {}};
  a.abdomen = {"abdomen", mesh_abdomen(p, abdomen, uterus, pelvis, fetus), {}, {}};
  require_room_for_floor(a);
  for (Body* body : {&a.fetus, &a.uterus, &a.abdomen}) mesh::order_spatially(body->mesh);
  name_fetus(a.fetus);
  name_uterus(a.uterus, uterus);
  name_abdomen(a.abdomen, abdomen, uterus);
  for (const auto& t : a.uterus.mesh.tets) {
    Vec3 centre = Vec3::Zero();
    for (const auto i : t) centre += a.uterus.mesh.nodes[i] / 4;
    a.uterine_wall.push_back(uterus.frame(centre));
  }
  a.landmarks = pelvis.landmarks();
  a.landmarks.merge(fetus.landmarks());
  measure(a);
  return a;
}

}  // namespace carus::meshing
