// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <array>

#include "carus/mesh/closest_point.hpp"
#include "carus/mesh/tet_mesh.hpp"

namespace carus::contact {

/// Two nearest points as weights on the four nodes of a stencil, positive on the one side and negative on the other:
/// the vector between them is sum c_k x_k. Point and triangle: (point, three corners); two edges: (two ends, two ends).
using Coefficients = std::array<double, 4>;
using Corners = std::array<Vec3, 4>;

inline Vec3 between(const Coefficients& c, const Corners& x) {
  return c[0] * x[0] + c[1] * x[1] + c[2] * x[2] + c[3] * x[3];
}

inline Coefficients nearest_point_triangle(const Corners& x) {
  const Vec3 w = mesh::closest_point_weights(x[0], x[1], x[2], x[3]);
  return {1, -w[0], -w[1], -w[2]};
}

/// Nearest points of two segments (Ericson 2005, section 5.1.9); where they are parallel, any of the nearest.
inline Coefficients nearest_edge_edge(const Corners& x) {
  const Vec3 u = x[1] - x[0], v = x[3] - x[2], r = x[0] - x[2];
  const double a = u.squaredNorm(), e = v.squaredNorm(), b = u.dot(v), c = u.dot(r), f = v.dot(r);
  const double denominator = a * e - b * b;  // >= 0
  double s = denominator > 1e-14 * a * e ? std::clamp((b * f - c * e) / denominator, 0.0, 1.0) : 0.0;
  double t = (b * s + f) / e;
  if (t < 0)
    t = 0, s = std::clamp(-c / a, 0.0, 1.0);
  else if (t > 1)
    t = 1, s = std::clamp((b - c) / a, 0.0, 1.0);
  return {1 - s, s, t - 1, -t};
}

}  // namespace carus::contact
