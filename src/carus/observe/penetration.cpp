// SPDX-License-Identifier: Apache-2.0
#include "carus/observe/penetration.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>

#include "carus/core/parallel.hpp"
#include "carus/observe/box_grid.hpp"

namespace carus::observe {
namespace {

/// Component of every node under "shares a tet", by union-find.
std::vector<std::int32_t> components(const mesh::TetMesh& mesh) {
  std::vector<std::int32_t> parent(mesh.nodes.size());
  std::iota(parent.begin(), parent.end(), 0);
  auto root = [&](std::int32_t n) {
    while (parent[n] != n) n = parent[n] = parent[parent[n]];
    return n;
  };
  for (const auto& t : mesh.tets) {
    for (int k = 1; k < 4; ++k) parent[root(t[k])] = root(t[0]);
  }
  for (std::int32_t n = 0; n < std::int32_t(parent.size()); ++n) parent[n] = root(n);
  return parent;
}

bool has(const auto& simplex, std::int32_t node) { return std::find(simplex.begin(), simplex.end(), node) != simplex.end(); }

/// All four sub-volumes of (p, tet) positive, for tets of either orientation.
bool inside(const Vec3& p, const std::vector<Vec3>& x, const mesh::Tet& t) {
  const auto volume = [](const Vec3& a, const Vec3& b, const Vec3& c, const Vec3& d) { return (b - a).cross(c - a).dot(d - a); };
  const Vec3 &a = x[t[0]], &b = x[t[1]], &c = x[t[2]], &d = x[t[3]];
  const double sign = volume(a, b, c, d) < 0 ? -1 : 1;
  return sign * volume(p, b, c, d) > 0 && sign * volume(a, p, c, d) > 0 && sign * volume(a, b, p, d) > 0 &&
         sign * volume(a, b, c, p) > 0;
}

template <class Simplices>
std::vector<Box> boxes_of(const std::vector<Vec3>& x, const Simplices& simplices) {
  std::vector<Box> boxes(simplices.size());
  for (std::size_t i = 0; i < simplices.size(); ++i) {
    for (const auto n : simplices[i]) boxes[i].extend(x[n]);
  }
  return boxes;
}

double mean_diagonal(const std::vector<Box>& boxes) {
  double sum = 0;
  for (const auto& b : boxes) sum += b.diagonal().norm();
  return boxes.empty() ? 1.0 : std::max(sum / double(boxes.size()), 1e-9);
}

}  // namespace

PenetrationCheck::PenetrationCheck(const fem::Model& model, double search) : model_(model), search_(search) {
  const auto component = components(model.mesh);
  for (const auto& surface : model.contact_surfaces) {
    Side side{mesh::nodes_of(surface.triangles), {}};
    std::vector<bool> behind(model.mesh.nodes.size(), false);
    for (const auto n : side.nodes) behind[component[n]] = true;
    for (std::size_t e = 0; e < model.mesh.tets.size(); ++e) {
      if (behind[component[model.mesh.tets[e][0]]]) side.tets.push_back(std::int32_t(e));
    }
    sides_.push_back(std::move(side));
  }
}

void PenetrationCheck::pass(const std::vector<Vec3>& x, int from, int onto, Penetration& out) const {
  const auto& triangles = model_.contact_surfaces[onto].triangles;
  std::vector<mesh::Tet> tets;
  for (const auto e : sides_[onto].tets) tets.push_back(model_.mesh.tets[e]);
  const auto facet_boxes = boxes_of(x, triangles), tet_boxes = boxes_of(x, tets);
  const BoxGrid facet_grid(facet_boxes, mean_diagonal(facet_boxes)), tet_grid(tet_boxes, mean_diagonal(tet_boxes));

  // Distance to the nearest facet within r, or infinity.
  const auto distance = [&](std::int32_t node, double r) {
    double nearest = std::numeric_limits<double>::infinity();
    const Vec3& p = x[node];
    facet_grid.visit(Box(p.array() - r, p.array() + r), [&](std::int32_t f) {
      const auto& t = triangles[f];
      if (has(t, node) || facet_boxes[f].exteriorDistance(p) > std::min(r, nearest)) return;
      const Vec3 w = mesh::closest_point_weights(p, x[t[0]], x[t[1]], x[t[2]]);
      nearest = std::min(nearest, (p - w[0] * x[t[0]] - w[1] * x[t[1]] - w[2] * x[t[2]]).norm());
    });
    return nearest <= r ? nearest : std::numeric_limits<double>::infinity();
  };
  const auto gap = [&](std::int32_t node) {
    const Vec3& p = x[node];
    bool in = false;
    tet_grid.visit(Box(p, p), [&](std::int32_t e) {
      in = in || (tet_boxes[e].contains(p) && !has(tets[e], node) && inside(p, x, tets[e]));
    });
    if (!in) return from == onto ? search_ : std::min(search_, distance(node, search_));
    for (double r = search_; r < 1; r *= 4) {
      if (const double d = distance(node, r); std::isfinite(d)) return -d;
    }
    return -1.0;
  };

  const auto& nodes = sides_[from].nodes;
  std::vector<double> gaps(nodes.size());
  parallel::for_chunks(nodes.size(), 256, [&](std::size_t begin, std::size_t end, std::size_t) {
    for (std::size_t i = begin; i < end; ++i) gaps[i] = gap(nodes[i]);
  });
  for (std::size_t i = 0; i < nodes.size(); ++i) {
    out.penetrated += gaps[i] < 0;
    if (gaps[i] < out.least_gap) {
      out.least_gap = gaps[i];
      out.node = nodes[i];
    }
  }
}

std::vector<Penetration> PenetrationCheck::check(const std::vector<Vec3>& x) const {
  std::vector<Penetration> result;
  for (const auto& pair : model_.contact_pairs) {
    Penetration p{search_, -1, 0};
    pass(x, pair.a, pair.b, p);
    if (pair.a != pair.b) pass(x, pair.b, pair.a, p);
    result.push_back(p);
  }
  return result;
}

}  // namespace carus::observe
