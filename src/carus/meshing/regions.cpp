// SPDX-License-Identifier: Apache-2.0
#include "carus/meshing/regions.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <set>

#include "carus/core/error.hpp"

namespace carus::meshing {
namespace {

using anatomy::Body;
using mesh::Triangle;
using mesh::Triangles;

struct Facet {
  Vec3 centre, normal;  ///< normal unit, outward
};

Facet facet_of(const mesh::TetMesh& m, const Triangle& t) {
  const Vec3 &a = m.nodes[t[0]], &b = m.nodes[t[1]], &c = m.nodes[t[2]];
  return {(a + b + c) / 3, (b - a).cross(c - a).normalized()};
}

template <class Keep>
Triangles select(const mesh::TetMesh& m, const Triangles& from, Keep keep) {
  Triangles result;
  for (const auto& t : from)
    if (keep(facet_of(m, t))) result.push_back(t);
  return result;
}

/// Facets of `from` that belong to a tet whose label `keep` selects.
template <class Keep>
Triangles owned(const mesh::TetMesh& m, const Triangles& from, Keep keep) {
  const auto all = mesh::boundary(m, [&](std::int32_t l) { return keep(l); });
  const std::set<Triangle> mine(all.begin(), all.end());
  Triangles result;
  for (const auto& t : from)
    if (mine.contains(t)) result.push_back(t);
  return result;
}

template <class Keep>
std::vector<std::int32_t> nodes_where(const mesh::TetMesh& m, const std::vector<std::int32_t>& from, Keep keep) {
  std::vector<std::int32_t> result;
  for (const auto i : from)
    if (keep(m.nodes[i])) result.push_back(i);
  return result;
}

std::vector<std::int32_t> nodes_of_label(const mesh::TetMesh& m, std::int32_t label) {
  std::set<std::int32_t> nodes;
  for (std::size_t e = 0; e < m.tets.size(); ++e)
    if (m.labels[e] == label) nodes.insert(m.tets[e].begin(), m.tets[e].end());
  return {nodes.begin(), nodes.end()};
}

/// The node of some that scores highest.
template <class Score>
std::vector<std::int32_t> best_node(const mesh::TetMesh& m, const std::vector<std::int32_t>& from, Score score) {
  CARUS_ASSERT(!from.empty());
  return {*std::max_element(from.begin(), from.end(),
                            [&](std::int32_t i, std::int32_t j) { return score(m.nodes[i]) < score(m.nodes[j]); })};
}

constexpr double tie_low = 0.010, tie_high = 0.032;  // z of the ring where the lower uterus hangs on the pelvis [m]
constexpr double hiatus_height = 0.020;              // above the vulva [m]
constexpr double on_plane = 0.0015;                  // [m]

}  // namespace

void name_fetus(Body& body) {
  body.surfaces.push_back({"skin", mesh::boundary(body.mesh)});
  body.nodes.push_back({"skull", nodes_of_label(body.mesh, anatomy::skull)});
}

void name_uterus(Body& body, const anatomy::Uterus& uterus) {
  const auto& m = body.mesh;
  const auto& axis = uterus.axis();
  const auto skin = mesh::boundary(m);
  const Vec3 end = axis.point(axis.vulva()), end_normal = axis.tangent(axis.vulva());
  const auto rim = [&](const Facet& f) {
    return (f.centre - end).dot(end_normal) > -on_plane && f.normal.dot(end_normal) > 0.7;
  };
  const auto inwards = [&](const Facet& f) {
    return f.normal.dot(uterus.frame(f.centre).normal) < 0 &&
           uterus.inner_distance(f.centre) < 0.5 * uterus.thickness(f.centre);
  };
  const auto inner = select(m, skin, [&](const Facet& f) { return !rim(f) && inwards(f); });
  const auto outer = select(m, skin, [&](const Facet& f) { return !rim(f) && !inwards(f); });
  const auto muscle = owned(m, outer, [](std::int32_t l) { return l < anatomy::vaginal_canal; });
  const auto upper =
      owned(m, outer, [](std::int32_t l) { return l == anatomy::uterine_fundus || l == anatomy::uterine_body; });
  body.surfaces.push_back({"inner", inner});
  body.surfaces.push_back({"outer", outer});
  body.surfaces.push_back({"contraction", muscle});
  body.surfaces.push_back({"tone", muscle});
  body.surfaces.push_back({"push", select(m, upper, [](const Facet& f) { return f.normal.z() > 0.2; })});

  const auto outer_nodes = mesh::nodes_of(outer);
  body.nodes.push_back({"vaginal_canal", nodes_of_label(m, anatomy::vaginal_canal)});
  body.nodes.push_back({"lower_uterus_tie", nodes_where(m, outer_nodes, [](const Vec3& x) {
                          return x.z() > tie_low && x.z() < tie_high;
                        })});
  const auto inner_nodes = mesh::nodes_of(inner), rim_nodes = mesh::nodes_of(select(m, skin, rim));
  std::vector<std::int32_t> vulva;  // its inner edge: the opening itself
  std::set_intersection(inner_nodes.begin(), inner_nodes.end(), rim_nodes.begin(), rim_nodes.end(),
                        std::back_inserter(vulva));
  body.nodes.push_back({"vulva", vulva});
  body.surfaces.push_back({"vulva", select(m, skin, rim)});
  body.nodes.push_back({"bed", nodes_where(m, outer_nodes, [](const Vec3& x) { return x.z() < 0; })});
  const auto canal = nodes_of_label(m, anatomy::vaginal_canal), sheet = nodes_of_label(m, anatomy::levator_ani);
  std::vector<std::int32_t> hiatus;  // where the levator lies on the canal, at the vulva's level
  std::set_intersection(canal.begin(), canal.end(), sheet.begin(), sheet.end(), std::back_inserter(hiatus));
  body.nodes.push_back({"hiatus", nodes_where(m, hiatus, [&](const Vec3& x) {
                          return axis.nearest(x) > axis.vulva() - hiatus_height;
                        })});
  // The paper's Fig. 14 follows a front-sagittal point at the top: where the dome faces upwards and forwards alike.
  body.nodes.push_back(
      {"point_fundus", best_node(m, outer_nodes, [](const Vec3& x) { return x.z() + x.y() - std::abs(x.x()); })});
  const auto lower = nodes_where(m, outer_nodes, [](const Vec3& x) { return x.z() > 0.005 && x.z() < 0.035; });
  body.nodes.push_back({"point_lower", best_node(m, lower, [](const Vec3& x) {
                          return x.y() - std::abs(x.x()) - std::abs(x.z() - 0.02);
                        })});
  // The lateral points: at two thirds of the height from inlet to dome.
  const double level = 2.0 / 3.0 * uterus.fundus_z();
  for (const double side : {1.0, -1.0})
    body.nodes.push_back({side > 0 ? "point_right" : "point_left", best_node(m, outer_nodes, [&](const Vec3& x) {
                            return side * x.x() - std::abs(x.y()) - std::abs(x.z() - level);
                          })});
}

void name_abdomen(Body& body, const anatomy::Abdomen& abdomen, const anatomy::Uterus& uterus) {
  const auto& m = body.mesh;
  const auto skin = mesh::boundary(m);
  const auto soft = [](std::int32_t l) { return l < anatomy::innominate_right; };
  const auto bare_soft = owned(m, skin, soft);
  const auto inwards = [&](const Facet& f) {
    // Facing the cavity: close to its wall, and the distance to it falls along the outward normal.
    constexpr double e = 0.001;
    const double d = abdomen.cavity(f.centre);
    return std::abs(d) < 0.004 && abdomen.cavity(f.centre + e * f.normal) < d - 0.5 * e;
  };
  const auto cavity = select(m, bare_soft, inwards);
  body.surfaces.push_back({"cavity", cavity});
  body.surfaces.push_back({"bone", owned(m, skin, [&](std::int32_t l) { return !soft(l) && l != anatomy::coccyx; })});
  body.surfaces.push_back({"coccyx", owned(m, skin, [](std::int32_t l) { return l == anatomy::coccyx; })});
  const auto is_outer = [&](const Facet& f) { return !inwards(f); };
  const auto outer = select(m, bare_soft, is_outer);
  const auto front = select(m, outer, [](const Facet& f) { return f.centre.z() > 0.002 && f.normal.y() > 0.3; });
  const auto back = select(m, outer, [](const Facet& f) { return f.centre.z() > 0.002 && f.normal.y() < -0.5; });
  const auto thighs = select(m, outer, [&](const Facet& f) {
    return f.centre.z() < -0.002 && std::abs(f.centre.x()) > 0.06 && uterus.outer_distance(f.centre) > 0.02;
  });
  body.surfaces.push_back({"front", front});
  body.surfaces.push_back({"back", back});
  body.surfaces.push_back({"thighs", thighs});

  body.nodes.push_back({"front", mesh::nodes_of(front)});
  body.nodes.push_back({"back", mesh::nodes_of(back)});
  body.nodes.push_back({"thighs", mesh::nodes_of(thighs)});
  const auto on_cavity = mesh::nodes_of(cavity);
  body.nodes.push_back({"canal", nodes_where(m, on_cavity, [](const Vec3& x) { return x.z() < 0; })});
  for (const auto label : {anatomy::innominate_right, anatomy::innominate_left, anatomy::sacrum, anatomy::coccyx})
    body.nodes.push_back({anatomy::name_of(label), nodes_of_label(m, label)});
}

}  // namespace carus::meshing
