// SPDX-License-Identifier: Apache-2.0
#include "carus/mesh/named_mesh.hpp"

#include <algorithm>
#include <map>

namespace carus::mesh {

void orient_outward(const TetMesh& mesh, Triangles& surface) {
  const auto sorted = [](Triangle t) {
    std::sort(t.begin(), t.end());
    return t;
  };
  std::map<Triangle, Triangle> outward;
  for (const Triangle& t : boundary(mesh)) outward[sorted(t)] = t;
  for (Triangle& t : surface) {
    const auto it = outward.find(sorted(t));
    if (it != outward.end()) t = it->second;
  }
}

std::size_t orient_tets(TetMesh& mesh) {
  std::size_t turned = 0;
  for (std::size_t e = 0; e < mesh.tets.size(); ++e) {
    if (volume(mesh, e) < 0) std::swap(mesh.tets[e][2], mesh.tets[e][3]), ++turned;
  }
  return turned;
}

}  // namespace carus::mesh
