// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "carus/mesh/tet_mesh.hpp"

namespace carus::meshing {

/// Moves nodes so that the smallest altitudes grow up to `target` [m], since they bound the explicit step, and flat
/// tets get thicker. Nodes within one label move freely, nodes on a nearly flat part of one surface within it, nodes on
/// edges and corners hardly: no node leaves its surface, edge or corner by more than `allowance` [m]. No tet is allowed
/// to get worse than the worst beside it was. Deterministic.
void raise_altitudes(mesh::TetMesh& m, double target, double allowance = 0.0004);

}  // namespace carus::meshing
