// SPDX-License-Identifier: Apache-2.0
#include "support/closed_shapes.hpp"

#include <map>

namespace carus::test {

mesh::Surface box_surface(const Vec3& low, const Vec3& high) {
  mesh::Surface s;
  for (int i = 0; i < 8; ++i)
    s.nodes.emplace_back((i & 1) != 0 ? high.x() : low.x(), (i & 2) != 0 ? high.y() : low.y(),
                         (i & 4) != 0 ? high.z() : low.z());
  s.triangles = {{0, 2, 3}, {0, 3, 1}, {4, 5, 7}, {4, 7, 6}, {0, 1, 5}, {0, 5, 4},
                 {2, 6, 7}, {2, 7, 3}, {0, 4, 6}, {0, 6, 2}, {1, 3, 7}, {1, 7, 5}};
  return s;
}

mesh::Surface sphere_surface(const Vec3& centre, double radius, int levels) {
  const double g = (1 + std::sqrt(5.0)) / 2;
  mesh::Surface s;
  s.nodes = {{-1, g, 0},  {1, g, 0},  {-1, -g, 0}, {1, -g, 0}, {0, -1, g},  {0, 1, g},
             {0, -1, -g}, {0, 1, -g}, {g, 0, -1},  {g, 0, 1},  {-g, 0, -1}, {-g, 0, 1}};
  s.triangles = {{0, 11, 5},  {0, 5, 1},  {0, 1, 7},  {0, 7, 10}, {0, 10, 11}, {1, 5, 9}, {5, 11, 4},
                 {11, 10, 2}, {10, 7, 6}, {7, 1, 8},  {3, 9, 4},  {3, 4, 2},   {3, 2, 6}, {3, 6, 8},
                 {3, 8, 9},   {4, 9, 5},  {2, 4, 11}, {6, 2, 10}, {8, 6, 7},   {9, 8, 1}};
  for (int level = 0; level < levels; ++level) {
    std::map<std::pair<std::int32_t, std::int32_t>, std::int32_t> middles;
    const auto middle = [&](std::int32_t a, std::int32_t b) {
      const auto [it, fresh] = middles.try_emplace(std::minmax(a, b), std::int32_t(s.nodes.size()));
      if (fresh) s.nodes.push_back((s.nodes[a] + s.nodes[b]) / 2);
      return it->second;
    };
    mesh::Triangles finer;
    for (const auto& [a, b, c] : s.triangles) {
      const auto ab = middle(a, b), bc = middle(b, c), ca = middle(c, a);
      for (const auto& t : {mesh::Triangle{a, ab, ca}, {ab, b, bc}, {ca, bc, c}, {ab, bc, ca}}) finer.push_back(t);
    }
    s.triangles = std::move(finer);
  }
  for (auto& x : s.nodes) x = centre + radius * x.normalized();
  return s;
}

}  // namespace carus::test
