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
  normal.resize(nodes.size());
  facet_normal.resize(triangles.size());
  rest_centre.reserve(triangles.size());
  for (const auto& f : triangles) rest_centre.push_back((rest[f[0]] + rest[f[1]] + rest[f[2]]) / 3);
  update_normals(rest);
  constexpr double cos_crease = 0.77;  // 40 degrees between a facet and the mean of its corner
  on_crease.assign(nodes.size(), 0);
  for (std::size_t i = 0; i < local.size(); ++i) {
    for (const auto v : local[i]) {
      if (facet_normal[i].dot(normal[std::size_t(v)]) < cos_crease * facet_normal[i].norm())
        on_crease[std::size_t(v)] = 1;
    }
  }
}

void Surface::update_normals(const std::vector<Vec3>& x) {
  parallel::for_chunks(triangles.size(), 2048, [&](std::size_t b, std::size_t e, std::size_t) {
    for (std::size_t i = b; i < e; ++i) {
      const Vec3& a = x[triangles[i][0]];
      facet_normal[i] = (x[triangles[i][1]] - a).cross(x[triangles[i][2]] - a);
    }
  });
  parallel::for_chunks(nodes.size(), 2048, [&](std::size_t b, std::size_t e, std::size_t) {
    for (std::size_t v = b; v < e; ++v) {
      Vec3 n = Vec3::Zero();
      for (std::int32_t q = around_begin[v]; q < around_begin[v + 1]; ++q)
        n += facet_normal[std::size_t(around[std::size_t(q)])];
      const double length = n.norm();
      if (length > 0) normal[v] = n / length;
    }
  });
}

}  // namespace carus::contact
