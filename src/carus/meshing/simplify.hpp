// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "carus/mesh/surface.hpp"

namespace carus::meshing {

/// Fewer triangles for a closed surface by edge collapse, cheapest first, each new node where it keeps the
/// volume and moves the surface least (Lindstrom and Turk 1998; CGAL). Collapses that would change the topology are not
/// made.
///
/// One pass: `node_counts` must fall, and each gives one surface, the state of the pass when it came to that many
/// nodes. A count at or above the surface's own gives the surface itself; where no edge can be collapsed any more, the
/// last state. O(n log n): 3.5 million triangles in one to two minutes of one core and 0.6 GB. Deterministic.
std::vector<mesh::Surface> simplify(const mesh::Surface& surface, const std::vector<std::size_t>& node_counts);

/// The same for one count, and sound: where triangles come to cut through each other (a few in ten thousand do where a
/// solid is thin) the pass is made again and keeps the edges that it found there at four times the nodes; for that
/// more nodes may be left than asked for. Throws NumericalFailure if the surface itself is not sound.
mesh::Surface simplify_soundly(const mesh::Surface& surface, std::size_t node_count);

/// The coarsest simplification whose distance from the surface, both ways, stays within `largest_distance` [m] at all
/// samples; found by bisection of the number of nodes, to 3 % of it.
mesh::Surface simplify_within(const mesh::Surface& surface, double largest_distance);

}  // namespace carus::meshing
