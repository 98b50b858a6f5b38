// SPDX-License-Identifier: Apache-2.0
#include "carus/meshing/keep_clear.hpp"

#include <algorithm>
#include <limits>

namespace carus::meshing {
namespace {

constexpr int rounds = 20;
/// Barycentric points of a facet at which it is held against the other body: corners, edges, inside.
const std::array<Vec3, 13> samples{{{1, 0, 0},
                                    {0, 1, 0},
                                    {0, 0, 1},
                                    {.5, .5, 0},
                                    {0, .5, .5},
                                    {.5, 0, .5},
                                    {1 / 3.0, 1 / 3.0, 1 / 3.0},
                                    {.75, .25, 0},
                                    {.25, .75, 0},
                                    {0, .75, .25},
                                    {0, .25, .75},
                                    {.75, 0, .25},
                                    {.25, 0, .75}}};

}  // namespace

double keep_clear(mesh::TetMesh& m, const std::function<double(const Vec3&)>& distance,
                  const std::function<Vec3(const Vec3&)>& gradient, double clearance) {
  const auto surface = mesh::boundary(m);
  std::vector<std::vector<std::size_t>> star(m.nodes.size());
  for (std::size_t e = 0; e < m.tets.size(); ++e)
    for (const auto i : m.tets[e]) star[i].push_back(e);
  double least = 0;
  for (int round = 0; round < rounds; ++round) {
    least = std::numeric_limits<double>::infinity();
    std::vector<Vec3> push(m.nodes.size(), Vec3::Zero());
    for (const auto& t : surface)
      for (const auto& w : samples) {
        const Vec3 x = w[0] * m.nodes[t[0]] + w[1] * m.nodes[t[1]] + w[2] * m.nodes[t[2]];
        const double d = distance(x);
        least = std::min(least, d);
        if (d >= clearance) continue;
        // Moves w_k p shift the point by (w.w) p: spread so that it comes to the clearance.
        const Vec3 p = 1.05 * (clearance - d) / w.squaredNorm() * gradient(x).normalized();
        for (int k = 0; k < 3; ++k)
          if (w[k] * p.norm() > push[t[k]].norm()) push[t[k]] = w[k] * p;
      }
    if (least >= clearance) break;
    for (std::size_t i = 0; i < m.nodes.size(); ++i) {
      if (push[i].isZero()) continue;
      const Vec3 start = m.nodes[i];
      m.nodes[i] += push[i];
      const bool sound =
          std::all_of(star[i].begin(), star[i].end(), [&](std::size_t e) { return mesh::volume(m, e) > 0; });
      if (!sound) m.nodes[i] = start;
    }
  }
  return least;
}

}  // namespace carus::meshing
