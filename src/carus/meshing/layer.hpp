// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>

#include "carus/mesh/tet_mesh.hpp"

namespace carus::meshing {

/// Where a node of the inner surface lies on the outer one.
using Outward = std::function<Vec3(const Vec3&)>;

/// Grows a layer of prisms, three tets each, outward from a triangulated surface on a mesh's nodes, labelled by the
/// prism's centre. A thin wall so keeps altitudes near its thickness, where Delaunay refinement leaves slivers of a
/// tenth of it. Throws NumericalFailure if a prism turns over (the wall is thicker than the surface's radius of
/// curvature). Returns the layer's outer face.
mesh::Triangles add_layer(mesh::TetMesh& m, const mesh::Triangles& surface, const Outward& outward,
                          const std::function<std::int32_t(const Vec3&)>& label);

}  // namespace carus::meshing
