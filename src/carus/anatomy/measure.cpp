// SPDX-License-Identifier: Apache-2.0
#include "carus/anatomy/measure.hpp"

#include <fmt/format.h>

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>

#include "carus/anatomy/bony_landmarks.hpp"
#include "carus/core/error.hpp"
#include "carus/mesh/closest_point.hpp"

namespace carus::anatomy {
namespace {

using mesh::Triangles;
constexpr double far = std::numeric_limits<double>::infinity();

struct Surface {
  const std::vector<Vec3>& x;
  Triangles t;
};

Surface surface_of(const Body& body, const std::function<bool(std::int32_t)>& keep) {
  return {body.mesh.nodes, mesh::boundary(body.mesh, keep)};
}
Surface surface_of(const Body& body, Label label) {
  return surface_of(body, [=](std::int32_t l) { return l == label; });
}

/// Distances along a ray from o to the surface, nearest and farthest hit (Moeller and Trumbore 1997); far, -far if
/// none.
std::pair<double, double> hits(const Surface& s, const Vec3& o, const Vec3& dir) {
  double first = far, last = -far;
  for (const auto& t : s.t) {
    const Vec3 e1 = s.x[t[1]] - s.x[t[0]], e2 = s.x[t[2]] - s.x[t[0]], h = dir.cross(e2), r = o - s.x[t[0]];
    const double det = e1.dot(h);
    if (std::abs(det) < 1e-18) continue;
    const double u = r.dot(h) / det, v = dir.dot(r.cross(e1)) / det, distance = e2.dot(r.cross(e1)) / det;
    if (u < -1e-9 || v < -1e-9 || u + v > 1 + 1e-9 || distance <= 0) continue;
    first = std::min(first, distance);
    last = std::max(last, distance);
  }
  return {first, last};
}

/// Width of a solid along a line through c.
double diameter(const Surface& s, const Vec3& c, const Vec3& dir) {
  return hits(s, c, dir).second + hits(s, c, -dir).second;
}

/// Where rays into a solid, started along the segment from a to b, first meet it.
std::vector<Vec3> midline(const Surface& s, const Vec3& a, const Vec3& b, const Vec3& into) {
  std::vector<Vec3> line;
  constexpr int n = 24;
  for (int i = 0; i <= n; ++i) {
    const Vec3 o = a + (b - a) * i / n;
    if (const double d = hits(s, o, into).first; d < far) line.push_back(o + d * into);
  }
  if (line.empty()) throw NumericalFailure("anatomy: nothing to measure: the mesh has no bone where a landmark is");
  return line;
}

/// The same in the midline and 3 mm beside it: just in the middle, where two bones meet, the mesh may have a groove.
std::vector<Vec3> about_midline(const Surface& s, const Vec3& a, const Vec3& b, const Vec3& into) {
  std::vector<Vec3> lines;
  for (const double beside : {-0.003, 0.0, 0.003}) {
    const Vec3 off = beside * Vec3::UnitX();
    const auto line = midline(s, a + off, b + off, into);
    lines.insert(lines.end(), line.begin(), line.end());
  }
  return lines;
}

double least_distance(const std::vector<Vec3>& a, const std::vector<Vec3>& b) {
  double least = far;
  for (const auto& p : a)
    for (const auto& q : b) least = std::min(least, (p - q).norm());
  return least;
}

Vec3 closest(const Surface& s, const Vec3& p) {
  Vec3 best = Vec3::Constant(far);
  for (const auto& t : s.t) {
    const Vec3 w = mesh::closest_point_weights(p, s.x[t[0]], s.x[t[1]], s.x[t[2]]);
    const Vec3 q = w[0] * s.x[t[0]] + w[1] * s.x[t[1]] + w[2] * s.x[t[2]];
    if (!((q - p).norm() >= (best - p).norm())) best = q;
  }
  return best;
}

/// The facets of a surface whose centre lies within r of c.
Surface part(const Surface& s, const Vec3& c, double r) {
  Surface result{s.x, {}};
  for (const auto& t : s.t)
    if (((s.x[t[0]] + s.x[t[1]] + s.x[t[2]]) / 3 - c).norm() < r) result.t.push_back(t);
  return result;
}

double angle(const Vec3& a, const Vec3& b) { return std::atan2(a.cross(b).norm(), a.dot(b)); }

/// Inner edge of an inferior ramus: where lines across it first meet bone at several depths below the symphysis; a
/// straight line through them by least squares gives half the pubic arch angle.
double half_arch(const Surface& bone, const Vec3& S, const Vec3& ramus, double side) {
  Vec3 down = ramus - S;
  down.x() = 0;
  const double depth = down.norm();
  down.normalize();
  const Vec3 front = Vec3(0, -down.z(), down.y());
  Eigen::Matrix2d A = Eigen::Matrix2d::Zero();
  Eigen::Vector2d b = Eigen::Vector2d::Zero();
  for (int i = 0; i <= 12; ++i) {
    const double u = depth * (0.5 + 0.9 * i / 12);
    double x = far;
    for (int k = -8; k <= 8; ++k)
      x = std::min(x, hits(bone, S + u * down + 0.0015 * k * front, side * Vec3::UnitX()).first);
    if (x == far) continue;
    A += Eigen::Vector2d(u, 1) * Eigen::RowVector2d(u, 1);
    b += x * Eigen::Vector2d(u, 1);
  }
  const Eigen::Vector2d line = A.ldlt().solve(b);
  return std::atan(line[0]);
}

/// Points on the facets of a surface, no further apart than `spacing`, for what looks at nodes alone.
std::vector<Vec3> points_on(const Surface& s, double spacing) {
  std::vector<Vec3> points;
  for (const auto& t : s.t) {
    const Vec3 &a = s.x[t[0]], ab = s.x[t[1]] - a, ac = s.x[t[2]] - a;
    const int n = std::max(1, int(std::ceil(std::max({ab.norm(), ac.norm(), (ab - ac).norm()}) / spacing)));
    for (int i = 0; i <= n; ++i)
      for (int j = 0; i + j <= n; ++j) points.emplace_back(a + (i * ab + j * ac) / n);
  }
  return points;
}

/// What the innominate bones and the promontory decide, in given bones, by the same landmarks as in the volume that
/// they came from: only meshing can have changed it.
void measure_given_ring(Anatomy& a) {
  constexpr double spacing = 0.002;
  const auto points = [&](Label label) { return mesh::Surface{points_on(surface_of(a.abdomen, label), spacing), {}}; };
  const auto found =
      find_landmarks({points(innominate_right), points(innominate_left), points(sacrum), points(coccyx)});
  for (const char* key :
       {"obstetric_conjugate", "transverse_inlet", "interspinous", "intertuberous", "pubic_arch_angle"})
    a.measured[key] = found.measures.at(key);
}

void measure_bones(Anatomy& a) {
  const auto right = surface_of(a.abdomen, innominate_right), left = surface_of(a.abdomen, innominate_left);
  const auto upper = surface_of(a.abdomen, sacrum), lower = surface_of(a.abdomen, coccyx);
  const auto& l = a.landmarks;
  auto& m = a.measured;
  const auto width = [&](const Vec3& middle) {
    return hits(right, middle, Vec3::UnitX()).first + hits(left, middle, -Vec3::UnitX()).first;
  };
  // Shortest way between two places, by alternating closest points.
  const auto between = [&](const Surface& s, Vec3 p, const Surface& t, Vec3 q) {
    for (int i = 0; i < 20; ++i) p = closest(s, q), q = closest(t, p);
    return (p - q).norm();
  };
  const auto& S = l.at("symphysis_bottom");
  const auto& P = l.at("promontory");
  const auto& T = l.at("coccyx_tip");
  // Sagittal diameters are taken in the midline: off it the inlet's oval is nearer to itself.
  const Surface pubis =
      surface_of(a.abdomen, [](std::int32_t q) { return q == innominate_right || q == innominate_left; });
  const Surface back = surface_of(a.abdomen, [](std::int32_t q) { return q == sacrum || q == coccyx; });
  const auto front_line =
      about_midline(pubis, Vec3(0, 0, l.at("symphysis_top").z()), Vec3(0, 0, S.z() - 0.003), Vec3::UnitY());
  const auto back_line = about_midline(back, Vec3(0, 0, P.z() + 0.004), Vec3(0, 0, P.z() - 0.012), -Vec3::UnitY());
  m["obstetric_conjugate"] = least_distance(front_line, back_line);
  m["transverse_inlet"] = 0;
  for (int k = -10; k <= 10; ++k)
    if (const double w = width({0, 0.002 * k, 0}); w < 1) m["transverse_inlet"] = std::max(m["transverse_inlet"], w);
  m["interspinous"] = between(part(right, l.at("spine_right"), 0.012), l.at("spine_right"),
                              part(left, l.at("spine_left"), 0.012), l.at("spine_left"));
  m["intertuberous"] = width((l.at("tuber_right") + l.at("tuber_left")) / 2);
  m["sagittal_outlet"] = least_distance(front_line, {closest(back, T)});
  const Vec3 ramus_right = l.at("ramus_right"), ramus_left = l.at("ramus_left");
  m["pubic_arch_angle"] = half_arch(right, S, ramus_right, 1) + half_arch(left, S, ramus_left, -1);
  const Vec3 promontory = closest(upper, P), tip = closest(lower, l.at("sacrum_tip"));
  m["sacral_height"] = (promontory - tip).norm();
  // The coccyx' direction from its anterior face between its ends, which meshing rounds.
  const Vec3 along = T - l.at("sacrum_tip"), into = Vec3(0, along.z(), -along.y()).normalized();
  const auto face = midline(lower, l.at("sacrum_tip") + 0.3 * along - 0.01 * into,
                            l.at("sacrum_tip") + 0.85 * along - 0.01 * into, into);
  m["sacrococcygeal_angle"] = angle(promontory - tip, face.back() - face.front());
}

void measure_pelvis(Anatomy& a) {
  const auto& p = a.parameters.pelvis;
  a.requested.insert({{"obstetric_conjugate", p.obstetric_conjugate},
                      {"transverse_inlet", p.transverse_inlet},
                      {"interspinous", p.interspinous},
                      {"intertuberous", p.intertuberous},
                      {"sagittal_outlet", p.sagittal_outlet},
                      {"pubic_arch_angle", p.pubic_arch_angle},
                      {"sacral_height", p.sacral_height},
                      {"sacrococcygeal_angle", p.sacrococcygeal_angle}});
  measure_bones(a);
  if (a.parameters.bones) measure_given_ring(a);
}

void measure_fetus(Anatomy& a) {
  const Surface skin{a.fetus.mesh.nodes, mesh::boundary(a.fetus.mesh)};
  const auto& l = a.landmarks;
  const auto& p = a.parameters.fetus;
  auto& m = a.measured;
  const Vec3 c = l.at("head_centre");
  const auto along = [&](const char* name) { return Vec3((l.at(name) - c).normalized()); };
  // In the head's sagittal plane the far ends lie in the neck: twice the free half.
  const auto twice = [&](const char* name) { return 2 * hits(skin, c, along(name)).second; };
  m["biparietal"] = diameter(skin, c, along("biparietal_right"));
  m["occipitofrontal"] = twice("occiput");
  m["suboccipitobregmatic"] = twice("head_top");
  const Vec3 shoulders = (l.at("shoulder_right") + l.at("shoulder_left")) / 2;
  const Vec3 across = (l.at("shoulder_right") - shoulders).normalized(),
             up = (l.at("breech") - l.at("vertex")).normalized();
  m["shoulder_width"] = 0;
  for (int k = -10; k <= 10; ++k)
    m["shoulder_width"] = std::max(m["shoulder_width"], diameter(skin, shoulders + 0.002 * k * up, across));
  double low = far, high = -far;
  for (const auto& x : a.fetus.mesh.nodes) low = std::min(low, x.dot(up)), high = std::max(high, x.dot(up));
  m["length"] = high - low;
  // Densities: the paper's, skin 400, body and skull 950 kg/m^3.
  m["mass_kg"] = 0;
  for (std::size_t e = 0; e < a.fetus.mesh.tets.size(); ++e)
    m["mass_kg"] += mesh::volume(a.fetus.mesh, e) * (a.fetus.mesh.labels[e] == fetal_skin ? 400 : 950);
  a.requested.insert({{"biparietal", p.biparietal},
                      {"occipitofrontal", p.occipitofrontal},
                      {"suboccipitobregmatic", p.suboccipitobregmatic},
                      {"shoulder_width", p.shoulder_width},
                      {"length", p.length}});
}

}  // namespace

void measure(Anatomy& a) {
  measure_pelvis(a);
  measure_fetus(a);
  for (const Body* body : {&a.fetus, &a.uterus, &a.abdomen})
    for (std::size_t e = 0; e < body->mesh.tets.size(); ++e)
      a.measured[fmt::format("volume_{}", name_of(body->mesh.labels[e]))] += mesh::volume(body->mesh, e);
  const auto& p = a.parameters;
  const double narrowest = std::min({p.pelvis.interspinous, p.pelvis.intertuberous, p.pelvis.obstetric_conjugate});
  const double presents = std::min(p.fetus.biparietal, p.fetus.suboccipitobregmatic);
  if (presents + 2 * p.uterus.wall_canal > narrowest)
    a.warnings.push_back(fmt::format(
        "the head ({:.1f} mm with {:.1f} mm of canal wall on each side) is wider than the bony canal ({:.1f} mm)",
        presents * 1e3, p.uterus.wall_canal * 1e3, narrowest * 1e3));
}

}  // namespace carus::anatomy
