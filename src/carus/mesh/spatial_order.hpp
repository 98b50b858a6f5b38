// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "carus/mesh/tet_mesh.hpp"

namespace carus::mesh {

/// Indices of the points along a Z-order curve through their bounding box (Morton 1966): neighbours in the list are
/// mostly neighbours in space. Equal points keep their order.
std::vector<std::int32_t> z_order(const std::vector<Vec3>& points);

/// Renumbers nodes and tets along that curve, tets by their centroids, so that what is near in space is near in memory.
/// Shape, orientation and labels stay.
void order_spatially(TetMesh& mesh);

}  // namespace carus::mesh
