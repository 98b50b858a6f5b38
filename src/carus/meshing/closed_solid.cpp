// SPDX-License-Identifier: Apache-2.0
#include "carus/meshing/closed_solid.hpp"

#include <CGAL/AABB_face_graph_triangle_primitive.h>
#include <CGAL/AABB_traits.h>
#include <CGAL/AABB_tree.h>
#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>
#include <CGAL/Polygon_mesh_processing/self_intersections.h>
#include <CGAL/Side_of_triangle_mesh.h>
#include <CGAL/Surface_mesh.h>
#include <fmt/format.h>

#include <algorithm>

#include "carus/core/error.hpp"

namespace carus::meshing {
namespace {

using Kernel = CGAL::Exact_predicates_inexact_constructions_kernel;
using Mesh = CGAL::Surface_mesh<Kernel::Point_3>;
using Tree = CGAL::AABB_tree<CGAL::AABB_traits<Kernel, CGAL::AABB_face_graph_triangle_primitive<Mesh>>>;

Mesh to_cgal(const mesh::Surface& s) {
  Mesh m;
  for (const auto& x : s.nodes) m.add_vertex({x.x(), x.y(), x.z()});
  for (const auto& t : s.triangles)
    if (m.add_face(Mesh::Vertex_index(t[0]), Mesh::Vertex_index(t[1]), Mesh::Vertex_index(t[2])) == Mesh::null_face())
      throw InputError("surface: touches itself in a node; separate its parts there");
  return m;
}

}  // namespace

struct ClosedSolid::Search {
  explicit Search(const mesh::Surface& s)
      : mesh(to_cgal(s)), tree(faces(mesh).first, faces(mesh).second, mesh), side((tree.build(), tree)) {
    tree.accelerate_distance_queries();
  }
  Mesh mesh;
  Tree tree;
  CGAL::Side_of_triangle_mesh<Mesh, Kernel> side;
};

ClosedSolid::ClosedSolid(const mesh::Surface& surface) : search_(std::make_unique<Search>(surface)) {
  static_cast<void>(
      contains(surface.nodes.at(0)));  // what the search sets up at its first question, before threads ask
}
ClosedSolid::~ClosedSolid() = default;
ClosedSolid::ClosedSolid(ClosedSolid&&) noexcept = default;
ClosedSolid& ClosedSolid::operator=(ClosedSolid&&) noexcept = default;

bool ClosedSolid::contains(const Vec3& x) const {
  return search_->side({x.x(), x.y(), x.z()}) == CGAL::ON_BOUNDED_SIDE;
}

double ClosedSolid::distance(const Vec3& x) const {
  const double d = (nearest(x) - x).norm();
  return contains(x) ? -d : d;
}

Vec3 ClosedSolid::nearest(const Vec3& x) const {
  const auto p = search_->tree.closest_point({x.x(), x.y(), x.z()});
  return {p.x(), p.y(), p.z()};
}

std::vector<std::pair<std::int32_t, std::int32_t>> self_intersections(const mesh::Surface& surface) {
  std::vector<std::pair<Mesh::Face_index, Mesh::Face_index>> faces;
  CGAL::Polygon_mesh_processing::self_intersections(to_cgal(surface), std::back_inserter(faces));
  std::vector<std::pair<std::int32_t, std::int32_t>> pairs;
  for (const auto& [f, g] : faces)
    pairs.emplace_back(std::minmax(static_cast<std::int32_t>(f), static_cast<std::int32_t>(g)));
  std::sort(pairs.begin(), pairs.end());
  return pairs;
}

void require_no_self_intersection(const mesh::Surface& surface, const std::string& name) {
  const auto pairs = self_intersections(surface);
  if (pairs.empty()) return;
  Vec3 where = Vec3::Zero();
  for (const auto i : surface.triangles[pairs[0].first]) where += surface.nodes[i] / 3;
  throw InputError(
      fmt::format("{}: {} pairs of triangles cut through each other, the first at ({:.1f}, {:.1f}, {:.1f}) mm; which "
                  "side is inside cannot be told there; repair it in the program that made it, or mesh from labels",
                  name, pairs.size(), 1e3 * where.x(), 1e3 * where.y(), 1e3 * where.z()));
}

}  // namespace carus::meshing
