// SPDX-License-Identifier: Apache-2.0
#include "carus/contact/ccd.hpp"

namespace carus::contact {

namespace {

constexpr double kept = 0.1;       // share of the distance that is left
constexpr double caution = 0.9;    // of what the distance allows
constexpr int max_advances = 200;  // then what has been proved by then is taken

double distance(const Corners& x, bool edges) {
  return between(edges ? nearest_edge_edge(x) : nearest_point_triangle(x), x).norm();
}

}  // namespace

double conservative_step(Corners x, Corners p, bool edges, double most) {
  const Vec3 mean = 0.25 * (p[0] + p[1] + p[2] + p[3]);
  for (Vec3& v : p) v -= mean;
  const double speed =
      edges ? std::sqrt(std::max(p[0].squaredNorm(), p[1].squaredNorm())) +
                  std::sqrt(std::max(p[2].squaredNorm(), p[3].squaredNorm()))
            : p[0].norm() + std::sqrt(std::max({p[1].squaredNorm(), p[2].squaredNorm(), p[3].squaredNorm()}));
  double d = distance(x, edges);
  const double goal = kept * d;
  if ((d - goal) >= most * speed) return most;
  double t = 0, advance = (1 - kept) * d / speed;
  for (int k = 0; k < max_advances; ++k) {
    for (int i = 0; i < 4; ++i) x[i] += advance * p[i];
    d = distance(x, edges);
    if (k > 0 && d < goal) break;
    t += advance;
    if (t >= most) return most;
    advance = caution * d / speed;
    if (d <= goal) break;
  }
  return t;
}

}  // namespace carus::contact
