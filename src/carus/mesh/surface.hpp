// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include "carus/mesh/tet_mesh.hpp"

namespace carus::mesh {

/// A triangulated surface of its own. Closed and outward oriented once `closed` has accepted it.
struct Surface {
  std::vector<Vec3> nodes;  ///< [m]
  Triangles triangles;
};

double volume(const Surface& s);  ///< enclosed, by the divergence theorem: negative where it is inside out [m^3]
double area(const Surface& s);    ///< [m^2]
Eigen::AlignedBox3d box(const Surface& s);

/// Which connected part (by shared nodes) each triangle belongs to, numbered from 0 in the order of the triangles.
struct Parts {
  std::vector<std::int32_t> of;
  std::int32_t count = 0;
};
Parts parts(const Surface& s);

/// Tells in which of some closed surface's parts a point lies: the sum of signed solid angles over 4 pi, 1 within an
/// outward oriented shell, 0 outside. Exact wherever the point is not on the surface; linear in the triangles.
double winding_number(const Surface& s, const Vec3& x);

/// A surface made fit to be a solid's boundary, and what was done to it for that.
struct Closed {
  Surface surface;
  std::vector<std::string> repairs;  ///< one line each; empty if the input was sound
};

/// Repairs what is safe to repair: merges coincident nodes, drops degenerate and repeated triangles and unused nodes,
/// closes holes of at most `largest_hole` edges, orients every part consistently, outward or, where it is a cavity
/// within another, inward. Throws InputError, with count and place of the first, for what is not: NaN, indices out of
/// range, larger holes, edges of more than two triangles, parts that cannot be oriented, nothing left. `name` begins
/// the messages. O(n log n), plus O(parts^2 n / parts) for nested parts.
Closed closed(Surface s, const std::string& name, int largest_hole = 6);

}  // namespace carus::mesh
