// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <map>

#include "carus/contact/contact.hpp"
#include "carus/core/parallel.hpp"

namespace carus::contact {

Surface::Surface(std::string surface_name, mesh::Triangles t, const std::vector<Vec3>& rest)
    : name(std::move(surface_name)), triangles(std::move(t)), nodes(mesh::nodes_of(triangles)) {
  local.resize(triangles.size());
  around_begin.assign(nodes.size() + 1, 0);
  for (std::size_t i = 0; i < triangles.size(); ++i) {
    for (int k = 0; k < 3; ++k) {
      local[i][k] = std::int32_t(std::lower_bound(nodes.begin(), nodes.end(), triangles[i][k]) - nodes.begin());
      ++around_begin[std::size_t(local[i][k]) + 1];
    }
  }
  for (std::size_t v = 1; v < around_begin.size(); ++v) around_begin[v] += around_begin[v - 1];
  around.resize(std::size_t(around_begin.back()));
  std::vector<std::int32_t> next(around_begin.begin(), around_begin.end() - 1);
  std::map<std::pair<std::int32_t, std::int32_t>, int> edges;
  for (std::size_t i = 0; i < local.size(); ++i) {
    for (int k = 0; k < 3; ++k) {
      around[std::size_t(next[std::size_t(local[i][k])]++)] = std::int32_t(i);
      ++edges[std::minmax(local[i][k], local[i][(k + 1) % 3])];
    }
  }
  on_border.assign(nodes.size(), 0);
  for (const auto& [edge, count] : edges) {
    if (count == 1) on_border[std::size_t(edge.first)] = on_border[std::size_t(edge.second)] = 1;
  }
  normal.assign(nodes.size(), Vec3::Zero());
  facet_normal.resize(triangles.size());
  rest_centre.reserve(triangles.size());
  for (const auto& f : triangles) rest_centre.push_back((rest[f[0]] + rest[f[1]] + rest[f[2]]) / 3);
  shade = local;
  side_begin.assign(nodes.size() + 1, std::int32_t(nodes.size()));
  update_normals(rest);
  find_sides();
  update_normals(rest);
  rest_normal = normal;
}

/// A rim or the edge of a block is no strongly curved surface: each facet there goes on in its own side only. Sides end
/// at sharp edges and nowhere else, so that what slides over any other edge meets the same normals on both its facets;
/// else its gap would jump, and the jump would shake it to and fro.
void Surface::find_sides() {
  side_facets_begin_ = {0};
  for (std::size_t v = 0; v < nodes.size(); ++v) {
    side_begin[v] = std::int32_t(normal.size());
    std::vector<std::int32_t> left(around.begin() + around_begin[v], around.begin() + around_begin[v + 1]);
    const std::size_t all = left.size();
    while (!left.empty()) {
      const auto side = take_side(left);
      if (side.size() == all) break;
      for (const auto f : side) {
        const auto corner = std::find(local[f].begin(), local[f].end(), std::int32_t(v)) - local[f].begin();
        shade[f][corner] = std::int32_t(normal.size());
      }
      side_facets_.insert(side_facets_.end(), side.begin(), side.end());
      side_facets_begin_.push_back(std::int32_t(side_facets_.size()));
      normal.push_back(Vec3::Zero());
    }
  }
  side_begin.back() = std::int32_t(normal.size());
}

/// Takes from facets round a vertex the first one and all that are joined to it by edges that are not sharp.
std::vector<std::int32_t> Surface::take_side(std::vector<std::int32_t>& left) const {
  constexpr double cos_crease = 0.643;  // 50 degrees
  const auto joined = [&](std::int32_t f, std::int32_t g) {
    int shared = 0;
    for (const auto v : local[f]) shared += std::count(local[g].begin(), local[g].end(), v) > 0;
    return shared >= 2 &&
           facet_normal[g].dot(facet_normal[f]) > cos_crease * facet_normal[g].norm() * facet_normal[f].norm();
  };
  std::vector<std::int32_t> side{left.front()};
  left.erase(left.begin());
  for (std::size_t k = 0; k < side.size(); ++k) {
    const auto rest =
        std::stable_partition(left.begin(), left.end(), [&](std::int32_t g) { return !joined(side[k], g); });
    side.insert(side.end(), rest, left.end());
    left.erase(rest, left.end());
  }
  return side;
}

void Surface::update_normals(const std::vector<Vec3>& x) {
  parallel::for_chunks(triangles.size(), 2048, [&](std::size_t b, std::size_t e, std::size_t) {
    for (std::size_t i = b; i < e; ++i) {
      const Vec3& a = x[triangles[i][0]];
      facet_normal[i] = (x[triangles[i][1]] - a).cross(x[triangles[i][2]] - a);
    }
  });
  const auto set_normal = [&](std::size_t i, const std::vector<std::int32_t>& facets, std::int32_t begin,
                              std::int32_t end) {
    Vec3 n = Vec3::Zero();
    for (std::int32_t q = begin; q < end; ++q) n += facet_normal[std::size_t(facets[std::size_t(q)])];
    const double length = n.norm();
    if (length > 0) normal[i] = n / length;
  };
  parallel::for_chunks(nodes.size(), 2048, [&](std::size_t b, std::size_t e, std::size_t) {
    for (std::size_t v = b; v < e; ++v) {
      set_normal(v, around, around_begin[v], around_begin[v + 1]);
    }
  });
  for (std::size_t side = 0; nodes.size() + side < normal.size(); ++side)
    set_normal(nodes.size() + side, side_facets_, side_facets_begin_[side], side_facets_begin_[side + 1]);
}

}  // namespace carus::contact
