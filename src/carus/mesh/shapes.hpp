// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>

#include "carus/mesh/tet_mesh.hpp"

/// Structured meshes of simple shapes: of general models, verification, tests and benchmarks.
namespace carus::mesh::shapes {

/// A grid of nx x ny x nz cells over [0,1]^3, six tets a cell round a common diagonal, mapped by `map`. Where `map`
/// glues nodes (a closed tube), nodes that fall on the same place within 1e-9 m become one.
mesh::TetMesh grid(int nx, int ny, int nz, const std::function<Vec3(const Vec3&)>& map, std::int32_t label = 0);

/// Box [low, low + size].
mesh::TetMesh box(const Vec3& low, const Vec3& size, int nx, int ny, int nz, std::int32_t label = 0);
/// Ball of radius r: a cube of n^3 cells blown up.
mesh::TetMesh ball(const Vec3& centre, double r, int n, std::int32_t label = 0);
/// Hollow cylinder along z.
mesh::TetMesh tube(double r_inner, double r_outer, double z0, double z1, int n_radial, int n_around, int n_along,
                   std::int32_t label = 0);
/// Eighth of a hollow sphere, x, y, z >= 0.
mesh::TetMesh sphere_octant(double r_inner, double r_outer, int n_radial, int n_around, std::int32_t label = 0);

/// Moves the interior nodes by a reproducible share of the edge, so that no pattern of the grid helps a patch test.
void shake(mesh::TetMesh& mesh, double amplitude);

/// Both meshes as one; labels are kept.
mesh::TetMesh join(const mesh::TetMesh& a, const mesh::TetMesh& b);

}  // namespace carus::mesh::shapes
