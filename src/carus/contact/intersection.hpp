// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "carus/contact/potential.hpp"

namespace carus::contact {

/// Sign of the volume of the tet a, b, c, d, exact: +1 where d lies on the side of abc from which it runs clockwise, 0
/// where the four are coplanar. A bound on the rounding decides nearly all cases (Shewchuk 1997), rational arithmetic
/// the rest.
int orientation(const Vec3& a, const Vec3& b, const Vec3& c, const Vec3& d);

/// Whether a closed segment and a closed triangle have a point in common, exact.
bool intersect(const Vec3& p, const Vec3& q, const Vec3& a, const Vec3& b, const Vec3& c);

struct Intersection {
  int pair;           ///< of sides
  int first, second;  ///< triangles of the pair's sides a and b
};

/// Triangles of touching sides that cut or touch each other, exact; at most `most`. Neighbours that share a node are
/// tested by the edges that do not. Independent of how the contact is computed: what it says of a state is proof.
std::vector<Intersection> intersections(const std::vector<Side>& sides, const std::vector<Touching>& pairs,
                                        const std::vector<Vec3>& x, std::size_t most = 20);

}  // namespace carus::contact
