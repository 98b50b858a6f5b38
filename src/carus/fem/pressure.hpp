// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "carus/fem/model.hpp"

namespace carus::fem {

/// Adds the nodal forces of a load at pressure p [Pa] on the current surface: -p n dA (follower), or its part along the
/// load's direction (directed). A third of each facet's force to each of its nodes.
inline void add_pressure_forces(const PressureLoad& load, double p, const std::vector<Vec3>& x, std::vector<Vec3>& f) {
  for (const mesh::Triangle& t : load.surface) {
    const Vec3 u = x[t[1]] - x[t[0]], w = x[t[2]] - x[t[0]];
    const Vec3 area2(u.y() * w.z() - u.z() * w.y(), u.z() * w.x() - u.x() * w.z(), u.x() * w.y() - u.y() * w.x());
    Vec3 g = -p / 6 * area2;
    if (load.directed) g = g.dot(load.direction) * load.direction;
    for (const auto n : t) f[n] += g;
  }
}

}  // namespace carus::fem
