// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>

#include "carus/mesh/tet_mesh.hpp"

namespace carus::meshing {

/// Moves a mesh's surface nodes out of a zone round another body until every facet stays clear of it: facets that cut
/// across an edge of the solid would otherwise reach into the gap. distance and gradient: to the other body's surface,
/// positive outside [m]; clearance: wanted [m]. Nodes whose move would turn a tet over stay. Returns the least
/// clearance reached.
double keep_clear(mesh::TetMesh& m, const std::function<double(const Vec3&)>& distance,
                  const std::function<Vec3(const Vec3&)>& gradient, double clearance);

}  // namespace carus::meshing
