// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>
#include <functional>
#include <string>
#include <vector>

#include "carus/core/types.hpp"

namespace carus::mesh {

using Tet = std::array<std::int32_t, 4>;
using Triangle = std::array<std::int32_t, 3>;

/// Linear tetrahedra with one label each. Positively oriented: (x1-x0)x(x2-x0).(x3-x0) > 0.
struct TetMesh {
  std::vector<Vec3> nodes;           ///< rest positions [m]
  std::vector<Tet> tets;             ///< node indices
  std::vector<std::int32_t> labels;  ///< one per tet
};

/// A triangulated surface on the nodes of a mesh, outward oriented.
using Triangles = std::vector<Triangle>;

/// Boundary facets of the tets that `keep` selects, outward oriented, in the order of the tets.
Triangles boundary(const TetMesh& mesh, const std::function<bool(std::int32_t label)>& keep);
Triangles boundary(const TetMesh& mesh);

/// Sorted unique node indices of some triangles.
std::vector<std::int32_t> nodes_of(const Triangles& triangles);

double volume(const TetMesh& mesh, std::size_t tet);  ///< [m^3]

/// Shape quality of one tet.
struct Quality {
  double min_dihedral_deg, max_dihedral_deg;
  double min_altitude;  ///< [m]
  double aspect;        ///< longest edge over smallest altitude, 1.22 for the regular tet
};
Quality quality(const TetMesh& mesh, std::size_t tet);

/// Nodes and facets, with names, on one mesh.
struct NamedNodes {
  std::string name;
  std::vector<std::int32_t> nodes;
};
struct NamedSurface {
  std::string name;
  Triangles triangles;
};

/// Least distance between two triangulated surfaces (nodes of each to facets of the other) [m], exact, O(n m) worst
/// case.
double least_gap(const std::vector<Vec3>& xa, const Triangles& a, const std::vector<Vec3>& xb, const Triangles& b);

}  // namespace carus::mesh
