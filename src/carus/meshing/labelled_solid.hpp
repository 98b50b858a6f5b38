// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>

#include "carus/mesh/feature_lines.hpp"
#include "carus/mesh/tet_mesh.hpp"

namespace carus::meshing {

/// A labelled solid: what lies at a point, 0 outside.
using LabelFunction = std::function<std::int32_t(const Vec3&)>;

struct Sphere {
  Vec3 centre;
  double radius;  ///< [m]
};

/// What the tetrahedra may look like. Fields are called with a point and the labels of the facet's two sides (a < b) or
/// of the cell.
struct Sizing {
  std::function<double(const Vec3&, std::int32_t a, std::int32_t b)> facet;     ///< edge of a facet [m]
  std::function<double(const Vec3&, std::int32_t a, std::int32_t b)> distance;  ///< facet to surface [m]
  std::function<double(const Vec3&, std::int32_t label)> cell;                  ///< edge of a tet [m]
  double seed_spacing;  ///< spacing of the grid that finds every part of the surface [m]: less than the thinnest part
  double sliver_bound_deg = 12;                  ///< dihedral angle up to which exudation goes on
  std::vector<mesh::FeatureLine> features = {};  ///< lines of the surfaces that become edges of the mesh
};

/// Conforming tetrahedra of a labelled solid by Delaunay refinement (CGAL Mesh_3), then exudation of
/// slivers. Lines are kept by balls along them (Cheng, Dey and Shewchuk 2012), shorter ones where lines come near each
/// other. The same input gives the same mesh bit for bit: nothing is random, nothing depends on time. Sequential;
/// seconds to a minute. Throws InputError if the solid is empty within the sphere.
mesh::TetMesh mesh_labelled_solid(const LabelFunction& solid, const Sphere& bounds, const Sizing& sizing);

}  // namespace carus::meshing
