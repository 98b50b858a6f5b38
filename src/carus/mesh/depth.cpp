// SPDX-License-Identifier: Apache-2.0
#include "carus/mesh/depth.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <limits>

#include "carus/mesh/closest_point.hpp"

namespace carus::mesh {
namespace {

double volume6(const Vec3& a, const Vec3& b, const Vec3& c, const Vec3& d) { return (b - a).cross(c - a).dot(d - a); }

bool within(const TetMesh& m, std::size_t tet, const Vec3& x) {
  const auto& t = m.tets[tet];
  const Vec3 &a = m.nodes[t[0]], &b = m.nodes[t[1]], &c = m.nodes[t[2]], &d = m.nodes[t[3]];
  return volume6(x, b, c, d) >= 0 && volume6(a, x, c, d) >= 0 && volume6(a, b, x, d) >= 0 && volume6(a, b, c, x) >= 0;
}

}  // namespace

Depth deepest(const TetMesh& mesh, const std::function<bool(std::int32_t label)>& which, const TetMesh& in,
              const std::function<bool(std::int32_t label)>& in_which) {
  const auto skin = boundary(in, in_which);
  Eigen::AlignedBox3d box;
  for (const auto i : nodes_of(skin)) box.extend(in.nodes[i]);
  std::vector<std::size_t> tets;
  for (std::size_t e = 0; e < in.tets.size(); ++e)
    if (in_which(in.labels[e])) tets.push_back(e);
  Depth most;
  for (const auto i : nodes_of(boundary(mesh, which))) {
    const Vec3& x = mesh.nodes[i];
    if (!box.contains(x) || std::none_of(tets.begin(), tets.end(), [&](auto e) { return within(in, e, x); })) continue;
    double depth = std::numeric_limits<double>::infinity();
    for (const auto& t : skin) {
      const Vec3 &a = in.nodes[t[0]], &b = in.nodes[t[1]], &c = in.nodes[t[2]];
      const Vec3 w = closest_point_weights(x, a, b, c);
      depth = std::min(depth, (w[0] * a + w[1] * b + w[2] * c - x).norm());
    }
    if (depth > most.depth) most = {depth, x};
  }
  return most;
}

}  // namespace carus::mesh
