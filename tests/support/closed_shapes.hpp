// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "carus/mesh/surface.hpp"

/// Closed, outward oriented surfaces with exactly known shape.
namespace carus::test {

mesh::Surface box_surface(const Vec3& low, const Vec3& high);  ///< 8 nodes, 12 triangles
/// Nodes exactly on the sphere: an icosahedron, each triangle cut into four `levels` times.
mesh::Surface sphere_surface(const Vec3& centre, double radius, int levels);

}  // namespace carus::test
