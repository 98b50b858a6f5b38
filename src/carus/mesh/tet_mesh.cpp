// SPDX-License-Identifier: Apache-2.0
#include "carus/mesh/tet_mesh.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <limits>
#include <unordered_map>

#include "carus/core/error.hpp"
#include "carus/mesh/closest_point.hpp"

namespace carus::mesh {
namespace {

/// Facet i of a positive tet is opposite its node i and seen counterclockwise from outside.
constexpr std::array<std::array<int, 3>, 4> facets{{{1, 2, 3}, {0, 3, 2}, {0, 1, 3}, {0, 2, 1}}};

struct TriangleHash {
  std::size_t operator()(const Triangle& t) const {
    std::uint64_t h = 0;
    for (const auto i : t) h = (h ^ static_cast<std::uint32_t>(i)) * 0x9e3779b97f4a7c15ULL, h ^= h >> 29;
    return h;
  }
};

Triangle sorted(Triangle t) {
  std::sort(t.begin(), t.end());
  return t;
}

/// A triangulated surface's nodes put against another's facets, facets in order of their lowest x so that a sweep can
/// stop early.
double least_node_to_facet(const std::vector<Vec3>& xa, const std::vector<std::int32_t>& nodes,
                           const std::vector<Vec3>& xb, const Triangles& b) {
  struct Bounded {
    Eigen::AlignedBox3d box;
    Triangle t;
  };
  std::vector<Bounded> sweep;
  double widest = 0;
  for (const auto& t : b) {
    Eigen::AlignedBox3d box;
    for (const auto i : t) box.extend(xb[i]);
    widest = std::max(widest, box.sizes().x());
    sweep.push_back({box, t});
  }
  std::sort(sweep.begin(), sweep.end(),
            [](const Bounded& l, const Bounded& r) { return l.box.min().x() < r.box.min().x(); });
  double best = std::numeric_limits<double>::infinity();
  for (const auto i : nodes) {
    const Vec3& p = xa[i];
    auto it = std::lower_bound(sweep.begin(), sweep.end(), p.x() - best - widest,
                               [](const Bounded& f, double x) { return f.box.min().x() < x; });
    for (; it != sweep.end() && it->box.min().x() <= p.x() + best; ++it) {
      if (it->box.exteriorDistance(p) >= best) continue;
      const auto& [u, v, w] = it->t;
      const Vec3 k = closest_point_weights(p, xb[u], xb[v], xb[w]);
      best = std::min(best, (p - k[0] * xb[u] - k[1] * xb[v] - k[2] * xb[w]).norm());
    }
  }
  return best;
}

}  // namespace

Triangles boundary(const TetMesh& mesh, const std::function<bool(std::int32_t)>& keep) {
  CARUS_ASSERT(mesh.labels.size() == mesh.tets.size());
  std::unordered_map<Triangle, int, TriangleHash> count;
  count.reserve(2 * mesh.tets.size());
  const auto facet = [&](std::size_t e, const std::array<int, 3>& f) {
    return Triangle{mesh.tets[e][f[0]], mesh.tets[e][f[1]], mesh.tets[e][f[2]]};
  };
  for (std::size_t e = 0; e < mesh.tets.size(); ++e)
    if (keep(mesh.labels[e]))
      for (const auto& f : facets) ++count[sorted(facet(e, f))];
  Triangles result;
  for (std::size_t e = 0; e < mesh.tets.size(); ++e)
    if (keep(mesh.labels[e]))
      for (const auto& f : facets)
        if (const auto t = facet(e, f); count[sorted(t)] == 1) result.push_back(t);
  return result;
}

Triangles boundary(const TetMesh& mesh) {
  return boundary(mesh, [](std::int32_t) { return true; });
}

std::vector<std::int32_t> nodes_of(const Triangles& triangles) {
  std::vector<std::int32_t> nodes;
  nodes.reserve(3 * triangles.size());
  for (const auto& t : triangles) nodes.insert(nodes.end(), t.begin(), t.end());
  std::sort(nodes.begin(), nodes.end());
  nodes.erase(std::unique(nodes.begin(), nodes.end()), nodes.end());
  return nodes;
}

double volume(const TetMesh& mesh, std::size_t tet) {
  const auto& [a, b, c, d] = mesh.tets[tet];
  const auto& x = mesh.nodes;
  // V = (x1-x0)x(x2-x0).(x3-x0) / 6
  return (x[b] - x[a]).cross(x[c] - x[a]).dot(x[d] - x[a]) / 6;
}

Quality quality(const TetMesh& mesh, std::size_t tet) {
  std::array<Vec3, 4> x, area;
  for (int i = 0; i < 4; ++i) x[i] = mesh.nodes[mesh.tets[tet][i]];
  double largest_area = 0, longest = 0;
  for (int i = 0; i < 4; ++i) {
    const auto& f = facets[i];
    area[i] = (x[f[1]] - x[f[0]]).cross(x[f[2]] - x[f[0]]) / 2;
    largest_area = std::max(largest_area, area[i].norm());
    for (int j = 0; j < i; ++j) longest = std::max(longest, (x[i] - x[j]).norm());
  }
  Quality q{180, 0, 0, 0};
  for (int i = 0; i < 4; ++i)
    for (int j = 0; j < i; ++j) {
      // The angle between two facets is pi minus that between their outward normals.
      const double angle = std::atan2(area[i].cross(area[j]).norm(), -area[i].dot(area[j])) * 180 / pi;
      q.min_dihedral_deg = std::min(q.min_dihedral_deg, angle);
      q.max_dihedral_deg = std::max(q.max_dihedral_deg, angle);
    }
  // V = A h / 3: the least altitude stands on the largest facet.
  q.min_altitude = 3 * volume(mesh, tet) / largest_area;
  q.aspect = longest / q.min_altitude;
  return q;
}

double least_gap(const std::vector<Vec3>& xa, const Triangles& a, const std::vector<Vec3>& xb, const Triangles& b) {
  return std::min(least_node_to_facet(xa, nodes_of(a), xb, b), least_node_to_facet(xb, nodes_of(b), xa, a));
}

}  // namespace carus::mesh
