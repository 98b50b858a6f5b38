// SPDX-License-Identifier: Apache-2.0
#include "carus/report/mesh_quality.hpp"

#include <algorithm>

namespace carus::report {
MeshQuality mesh_quality(const FrameMesh& mesh) {
  MeshQuality q;
  if (mesh.tets.empty()) return q;
  std::vector<double> least;
  double length = 0;
  for (std::size_t e = 0; e < mesh.tets.size(); ++e) {
    least.push_back(mesh::quality(mesh, e).min_dihedral_deg);
    for (int i = 0; i < 4; ++i)
      for (int j = 0; j < i; ++j) length += (mesh.nodes[mesh.tets[e][i]] - mesh.nodes[mesh.tets[e][j]]).norm();
  }
  std::sort(least.begin(), least.end());
  q.least_angle = least.front(), q.low_angle = least[least.size() / 100];
  q.mean_edge = length / double(6 * mesh.tets.size());
  return q;
}

}  // namespace carus::report
