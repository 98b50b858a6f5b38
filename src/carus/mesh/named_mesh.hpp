// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include "carus/mesh/tet_mesh.hpp"

namespace carus::mesh {

/// A mesh with the names of its parts, as a file states them.
struct NamedMesh {
  TetMesh mesh;                      ///< labels are indices into `regions`
  std::vector<std::string> regions;  ///< "" where the file names none
  std::vector<NamedNodes> nodes;
  std::vector<NamedSurface> surfaces;  ///< outward oriented where a tet lies on one side only
};

/// Turns each facet of a surface that is a facet of the boundary the way that it is there, outward. A facet inside
/// keeps its way.
void orient_outward(const TetMesh& mesh, Triangles& surface);

/// Swaps two corners of every tet that is oriented the wrong way round; how many there were.
std::size_t orient_tets(TetMesh& mesh);

}  // namespace carus::mesh
