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

/// A rim or the edge of a block is no strongly curved surface: each facet there goes on in its own side only.
void Surface::find_sides() {
  constexpr double cos_crease = 0.643;  // 50 degrees
  side_facets_begin_ = {0};
  for (std::size_t v = 0; v < nodes.size(); ++v) {
    side_begin[v] = std::int32_t(normal.size());
    const auto first = around.begin() + around_begin[v], last = around.begin() + around_begin[v + 1];
    std::vector<std::vector<std::int32_t>> sides;
    for (auto f = first; f != last; ++f) {
      std::vector<std::int32_t> side;
      std::copy_if(first, last, std::back_inserter(side), [&](std::int32_t g) {
        return facet_normal[g].dot(facet_normal[*f]) > cos_crease * facet_normal[g].norm() * facet_normal[*f].norm();
      });
      if (side.size() == std::size_t(last - first)) continue;
      auto known = std::find(sides.begin(), sides.end(), side);
      if (known == sides.end()) {
        side_facets_.insert(side_facets_.end(), side.begin(), side.end());
        side_facets_begin_.push_back(std::int32_t(side_facets_.size()));
        normal.push_back(Vec3::Zero());
        known = sides.insert(known, std::move(side));
      }
      const auto corner = std::find(local[*f].begin(), local[*f].end(), std::int32_t(v)) - local[*f].begin();
      shade[*f][corner] = side_begin[v] + std::int32_t(known - sides.begin());
    }
  }
  side_begin.back() = std::int32_t(normal.size());
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
