// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "carus/imaging/label_volume.hpp"
#include "carus/mesh/surface.hpp"

namespace carus::imaging {

/// A closed surface and the label that its inside gets.
struct LabelledSurface {
  mesh::Surface surface;
  std::int32_t label;
};

/// Voxels whose centres lie in closed surfaces, along the axes of RAS, with six voxels of 0 round them all. Where
/// surfaces overlap the first has it. O(voxels + triangles). Throws InputError beyond 200 million voxels.
LabelVolume voxelise(const std::vector<LabelledSurface>& surfaces, double spacing);

}  // namespace carus::imaging
