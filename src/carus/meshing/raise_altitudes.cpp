// SPDX-License-Identifier: Apache-2.0
#include "carus/meshing/raise_altitudes.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <limits>
#include <map>

#include "carus/core/error.hpp"

namespace carus::meshing {
namespace {

constexpr double flat =
    0.94;  // cosine between a facet and the mean of the surface about a node that may slide in it (20 degrees)
constexpr int passes = 8;
constexpr double slim = 0.12;  // smallest altitude over longest edge

enum class Freedom { fixed, slides, free };

struct Node {
  Freedom freedom = Freedom::free;
  Vec3 normal = Vec3::Zero();
};

/// All facets between two labels, outside (0) included, with one orientation for each pair of labels.
std::map<mesh::Triangle, std::pair<mesh::Triangle, std::pair<int, int>>> interfaces(const mesh::TetMesh& m) {
  constexpr std::array<std::array<int, 3>, 4> facets{{{1, 2, 3}, {0, 3, 2}, {0, 1, 3}, {0, 2, 1}}};
  std::map<mesh::Triangle, std::pair<mesh::Triangle, std::pair<int, int>>> found;
  for (std::size_t e = 0; e < m.tets.size(); ++e)
    for (const auto& f : facets) {
      const mesh::Triangle t{m.tets[e][f[0]], m.tets[e][f[1]], m.tets[e][f[2]]};
      auto key = t;
      std::sort(key.begin(), key.end());
      const auto [it, fresh] = found.try_emplace(key, t, std::pair{m.labels[e], 0});
      if (!fresh) it->second.second.second = m.labels[e];
    }
  std::erase_if(found, [](const auto& f) { return f.second.second.first == f.second.second.second; });
  for (auto& [key, f] : found)
    if (f.second.first < f.second.second) std::swap(f.first[0], f.first[1]), std::swap(f.second.first, f.second.second);
  return found;
}

std::vector<Node> freedoms(const mesh::TetMesh& m) {
  std::vector<Node> nodes(m.nodes.size());
  std::vector<std::pair<int, int>> patch(m.nodes.size());
  const auto facets = interfaces(m);
  const auto area = [&](const mesh::Triangle& t) {
    return Vec3((m.nodes[t[1]] - m.nodes[t[0]]).cross(m.nodes[t[2]] - m.nodes[t[0]]));
  };
  for (const auto& [key, f] : facets)
    for (const auto i : f.first) {
      auto& n = nodes[i];
      if (n.freedom == Freedom::free)
        n.freedom = Freedom::slides, patch[i] = f.second;
      else if (patch[i] != f.second)
        n.freedom = Freedom::fixed;
      n.normal += area(f.first);
    }
  for (const auto& [key, f] : facets)
    for (const auto i : f.first)
      if (auto& n = nodes[i]; area(f.first).normalized().dot(n.normal.normalized()) < flat) n.freedom = Freedom::fixed;
  for (auto& n : nodes) n.normal.normalize();
  return nodes;
}

/// Smallest altitude (6 V over twice the largest facet's area) as a part of what is wanted: `target`, or so much of the
/// longest edge that dihedral angles stay above about 7 degrees. 1 is good enough; negative if turned over.
double score(const mesh::TetMesh& m, const mesh::Tet& t, double target) {
  const Vec3 &a = m.nodes[t[0]], u = m.nodes[t[1]] - a, v = m.nodes[t[2]] - a, w = m.nodes[t[3]] - a;
  const double largest = std::max({u.cross(v).squaredNorm(), v.cross(w).squaredNorm(), w.cross(u).squaredNorm(),
                                   (v - u).cross(w - u).squaredNorm()});
  const double longest = std::sqrt(std::max({u.squaredNorm(), v.squaredNorm(), w.squaredNorm(), (v - u).squaredNorm(),
                                             (w - u).squaredNorm(), (w - v).squaredNorm()}));
  return u.cross(v).dot(w) / std::sqrt(largest) / std::max(target, slim * longest);
}

/// Brings a node back to where its freedom lets it be.
Vec3 allowed(const Node& n, const Vec3& first, const Vec3& x, double off) {
  Vec3 moved = x - first;
  if (n.freedom == Freedom::fixed && moved.norm() > off) moved *= off / moved.norm();
  if (n.freedom == Freedom::slides) {
    const double out = moved.dot(n.normal);
    moved += (std::clamp(out, -off, off) - out) * n.normal;
  }
  return first + moved;
}

}  // namespace

void raise_altitudes(mesh::TetMesh& m, double target, double allowance) {
  const auto nodes = freedoms(m);
  const auto first = m.nodes;
  std::vector<std::vector<std::int32_t>> star(m.nodes.size());
  for (std::size_t e = 0; e < m.tets.size(); ++e)
    for (const auto i : m.tets[e]) star[i].push_back(static_cast<std::int32_t>(e));
  const auto worst = [&](std::int32_t i) {
    double least = std::numeric_limits<double>::infinity();
    for (const auto e : star[i]) least = std::min(least, score(m, m.tets[e], target));
    return least;
  };
  std::vector<Vec3> directions;
  for (int x = -1; x <= 1; ++x)
    for (int y = -1; y <= 1; ++y)
      for (int z = -1; z <= 1; ++z)
        if (x || y || z) directions.push_back(Vec3(x, y, z).normalized());

  for (int pass = 0; pass < passes; ++pass)
    for (const auto& tet : m.tets) {
      if (score(m, tet, target) >= 1) continue;
      for (const auto i : tet) {
        double best = worst(i);
        const Vec3 start = m.nodes[i];
        Vec3 chosen = start;
        for (const double step : {1.0, 0.5, 0.25, 0.1})
          for (const Vec3& d : directions) {
            m.nodes[i] = allowed(nodes[i], first[i], start + step * target * d, allowance);
            if (const double w = worst(i); w > best + 1e-4) best = w, chosen = m.nodes[i];
          }
        m.nodes[i] = chosen;
      }
    }
}

}  // namespace carus::meshing
