// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "carus/mesh/tet_mesh.hpp"

namespace carus::mesh {

struct Depth {
  double depth = 0;  ///< [m]; 0: no node lies in a tet
  Vec3 where = Vec3::Zero();
};

/// How deep the boundary nodes of what `which` selects in one mesh lie in what `in_which` selects in another, below its
/// boundary. O(nodes within its box x tets).
Depth deepest(const TetMesh& mesh, const std::function<bool(std::int32_t label)>& which, const TetMesh& in,
              const std::function<bool(std::int32_t label)>& in_which);

}  // namespace carus::mesh
