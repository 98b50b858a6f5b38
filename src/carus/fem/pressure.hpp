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

/// y += K u with the symmetric part of K = -df/dx of those forces. On a closed surface under one pressure K is
/// symmetric itself: then the load has a potential, p times the enclosed volume.
inline void add_pressure_stiffness(const PressureLoad& load, double p, const std::vector<Vec3>& x,
                                   const std::vector<Vec3>& u, std::vector<Vec3>& y) {
  const auto along = [&](const Vec3& g) { return load.directed ? Vec3(g.dot(load.direction) * load.direction) : g; };
  for (const mesh::Triangle& t : load.surface) {
    const Vec3 a = x[t[1]] - x[t[0]], b = x[t[2]] - x[t[0]];
    const Vec3 g = p / 12 * along((u[t[1]] - u[t[0]]).cross(b) + a.cross(u[t[2]] - u[t[0]]));
    const Vec3 s = p / 12 * along(u[t[0]] + u[t[1]] + u[t[2]]);
    const Vec3 g1 = b.cross(s), g2 = s.cross(a);
    y[t[0]] += g - g1 - g2;
    y[t[1]] += g + g1;
    y[t[2]] += g + g2;
  }
}

}  // namespace carus::fem
