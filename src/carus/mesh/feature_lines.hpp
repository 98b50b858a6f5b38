// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "carus/mesh/surface.hpp"

namespace carus::mesh {

/// A line that a mesh keeps as edges of its tets, from corner to corner; a closed one without a corner ends in the
/// point it begins with.
struct FeatureLine {
  std::vector<Vec3> points;  ///< [m]; two at least
  double edge = 0;           ///< wanted length of the mesh's edges along it [m]
};

double length(const FeatureLine& line);  ///< [m]

/// A closed surface, and what to take of it.
struct Featured {
  const Surface* surface;
  double edge;  ///< of the FeatureLine's; where lines of several surfaces run together the finest has its way [m]
};

/// Edges of closed surfaces across which the normal turns by more than `angle` [rad], joined into lines that meet in
/// their ends only: where edges of several surfaces cross, touch or run together they are cut and counted once. What is
/// nearer than a twentieth of the finest edge is taken for one. Lines that end in nothing and are shorter than their
/// edge are left out. O(n log n) for edges that are short against the whole.
std::vector<FeatureLine> feature_lines(const std::vector<Featured>& surfaces, double angle);

}  // namespace carus::mesh
