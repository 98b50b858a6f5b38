// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <array>
#include <cmath>

#include "carus/core/types.hpp"

/// Signed distances [m], negative inside, of the simple solids that organs are put together from. Exact or first-order
/// near the surface.
namespace carus::anatomy {

/// 0 below a, 1 above b, C1 between.
inline double smooth_step(double a, double b, double x) {
  const double t = std::clamp((x - a) / (b - a), 0.0, 1.0);
  return t * t * (3 - 2 * t);
}

/// Ellipsoid about the origin: d ~ |x/r| (|x/r| - 1) / |x/r^2|, exact to first order at the surface.
inline double ellipsoid(const Vec3& x, const Vec3& r) {
  const double k0 = x.cwiseQuotient(r).norm(), k1 = x.cwiseQuotient(r.cwiseProduct(r)).norm();
  return k1 > 0 ? k0 * (k0 - 1) / k1 : -r.minCoeff();
}

/// Ellipse about the origin in the plane, likewise.
inline double ellipse(double x, double y, double a, double b) {
  const double k0 = std::hypot(x / a, y / b), k1 = std::hypot(x / (a * a), y / (b * b));
  return k1 > 0 ? k0 * (k0 - 1) / k1 : -std::min(a, b);
}

/// Segment a-b with a radius that goes from ra to rb.
inline double capsule(const Vec3& x, const Vec3& a, const Vec3& b, double ra, double rb) {
  const Vec3 ab = b - a;
  const double t = std::clamp((x - a).dot(ab) / ab.squaredNorm(), 0.0, 1.0);
  return (x - a - t * ab).norm() - (ra + t * (rb - ra));
}

/// Rectangle [x0,x1] x [y0,y1] in the plane.
inline double rectangle(double x, double y, double x0, double x1, double y0, double y1) {
  const double dx = std::max(x0 - x, x - x1), dy = std::max(y0 - y, y - y1);
  return std::min(std::max(dx, dy), 0.0) + std::hypot(std::max(dx, 0.0), std::max(dy, 0.0));
}

/// The common part of two solids, its edge rounded with radius r.
inline double rounded_intersection(double a, double b, double r) {
  return std::min(std::max(a, b) + r, 0.0) + std::hypot(std::max(a + r, 0.0), std::max(b + r, 0.0)) - r;
}

/// Union with a fillet of size k: bulges by at most k/4 where both surfaces meet.
inline double smooth_union(double a, double b, double k) {
  const double h = std::max(k - std::abs(a - b), 0.0) / k;
  return std::min(a, b) - h * h * k / 4;
}

}  // namespace carus::anatomy
