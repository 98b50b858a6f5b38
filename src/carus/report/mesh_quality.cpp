// SPDX-License-Identifier: Apache-2.0
#include "carus/report/mesh_quality.hpp"

#include <algorithm>
#include <cmath>

#include "carus/core/types.hpp"
#include "carus/core/units.hpp"

namespace carus::report {
namespace {

/// Angle between the planes of facets (a, b, c) and (a, b, d), inside the tet: between the parts of ac and ad across
/// ab.
double dihedral(const Vec3& a, const Vec3& b, const Vec3& c, const Vec3& d) {
  const Vec3 e = (b - a).normalized();
  const Vec3 u = (c - a) - e.dot(c - a) * e, v = (d - a) - e.dot(d - a) * e;
  return std::atan2(u.cross(v).norm(), u.dot(v)) / units::deg;
}

}  // namespace

MeshQuality mesh_quality(const FrameMesh& mesh) {
  constexpr std::size_t edges[6][4] = {{0, 1, 2, 3}, {0, 2, 1, 3}, {0, 3, 1, 2},
                                       {1, 2, 0, 3}, {1, 3, 0, 2}, {2, 3, 0, 1}};
  MeshQuality q;
  if (mesh.tets.empty()) return q;
  std::vector<double> least;
  double length = 0;
  for (const auto& t : mesh.tets) {
    Vec3 x[4];
    for (std::size_t k = 0; k < 4; ++k) x[k] = {mesh.rest[t[k]][0], mesh.rest[t[k]][1], mesh.rest[t[k]][2]};
    double low = 180;
    for (const auto& e : edges) {
      low = std::min(low, dihedral(x[e[0]], x[e[1]], x[e[2]], x[e[3]]));
      length += (x[e[1]] - x[e[0]]).norm();
    }
    least.push_back(low);
  }
  std::sort(least.begin(), least.end());
  q.least_angle = least.front(), q.low_angle = least[least.size() / 100];
  q.mean_edge = length / double(6 * mesh.tets.size());
  return q;
}

}  // namespace carus::report
