// SPDX-License-Identifier: Apache-2.0
#include "carus/contact/intersection.hpp"

#include <array>
#include <boost/multiprecision/cpp_int.hpp>
#include <cmath>

#include "carus/contact/broad_phase.hpp"
#include "carus/core/parallel.hpp"

namespace carus::contact {

namespace {

using Exact = boost::multiprecision::cpp_rational;
constexpr std::size_t triangle_chunk = 256;

int sign_of(const Exact& v) { return v.is_zero() ? 0 : v < 0 ? -1 : 1; }

int exact_orientation(const Vec3& a, const Vec3& b, const Vec3& c, const Vec3& d) {
  const auto minus = [&](const Vec3& p) {
    return std::array<Exact, 3>{Exact(p.x()) - Exact(d.x()), Exact(p.y()) - Exact(d.y()), Exact(p.z()) - Exact(d.z())};
  };
  const auto u = minus(a), v = minus(b), w = minus(c);
  return sign_of(u[0] * (v[1] * w[2] - v[2] * w[1]) + u[1] * (v[2] * w[0] - v[0] * w[2]) +
                 u[2] * (v[0] * w[1] - v[1] * w[0]));
}

/// In the plane that drops axis k.
int exact_orientation_2d(const Vec3& a, const Vec3& b, const Vec3& c, int k) {
  const int i = (k + 1) % 3, j = (k + 2) % 3;
  const Exact ux = Exact(a[i]) - Exact(c[i]), uy = Exact(a[j]) - Exact(c[j]);
  const Exact vx = Exact(b[i]) - Exact(c[i]), vy = Exact(b[j]) - Exact(c[j]);
  return sign_of(ux * vy - uy * vx);
}

/// Segments of one line overlap where their boxes do.
bool boxes_meet(const Vec3& p, const Vec3& q, const Vec3& a, const Vec3& b, int i) {
  return std::max(p[i], q[i]) >= std::min(a[i], b[i]) && std::max(a[i], b[i]) >= std::min(p[i], q[i]);
}

bool coplanar_intersect(const Vec3& p, const Vec3& q, const Vec3& a, const Vec3& b, const Vec3& c) {
  int k = 0;
  (b - a).cross(c - a).cwiseAbs().maxCoeff(&k);
  const Vec3 t[3] = {a, b, c};
  int inside[3];
  for (int e = 0; e < 3; ++e) {
    const Vec3 &s = t[e], &r = t[(e + 1) % 3];
    inside[e] = exact_orientation_2d(s, r, p, k);
    const int s1 = inside[e], s2 = exact_orientation_2d(s, r, q, k);
    const int s3 = exact_orientation_2d(p, q, s, k), s4 = exact_orientation_2d(p, q, r, k);
    if (s1 * s2 <= 0 && s3 * s4 <= 0 && boxes_meet(p, q, s, r, (k + 1) % 3) && boxes_meet(p, q, s, r, (k + 2) % 3))
      return true;
  }
  return (inside[0] >= 0 && inside[1] >= 0 && inside[2] >= 0) || (inside[0] <= 0 && inside[1] <= 0 && inside[2] <= 0);
}

bool triangles_intersect(const mesh::Triangle& s, const mesh::Triangle& t, const std::vector<Vec3>& x) {
  const auto in = [](std::int32_t n, const mesh::Triangle& of) { return n == of[0] || n == of[1] || n == of[2]; };
  const auto cuts = [&](const mesh::Triangle& edges, const mesh::Triangle& face) {
    for (int k = 0; k < 3; ++k) {
      const auto p = edges[k], q = edges[(k + 1) % 3];
      if (in(p, face) || in(q, face)) continue;
      if (intersect(x[p], x[q], x[face[0]], x[face[1]], x[face[2]])) return true;
    }
    return false;
  };
  return cuts(s, t) || cuts(t, s);
}

}  // namespace

int orientation(const Vec3& a, const Vec3& b, const Vec3& c, const Vec3& d) {
  const Vec3 u = a - d, v = b - d, w = c - d;
  const double vw0 = v[1] * w[2], vw1 = v[2] * w[1], wu0 = v[2] * w[0], wu1 = v[0] * w[2], uv0 = v[0] * w[1],
               uv1 = v[1] * w[0];
  const double det = u[0] * (vw0 - vw1) + u[1] * (wu0 - wu1) + u[2] * (uv0 - uv1);
  const double permanent = std::abs(u[0]) * (std::abs(vw0) + std::abs(vw1)) +
                           std::abs(u[1]) * (std::abs(wu0) + std::abs(wu1)) +
                           std::abs(u[2]) * (std::abs(uv0) + std::abs(uv1));
  constexpr double bound = 8e-16;  // (7 + 56 eps) eps with eps = 2^-53 of Shewchuk's orient3d, rounded up
  if (det > bound * permanent) return 1;
  if (det < -bound * permanent) return -1;
  return exact_orientation(a, b, c, d);
}

bool intersect(const Vec3& p, const Vec3& q, const Vec3& a, const Vec3& b, const Vec3& c) {
  const int s = orientation(a, b, c, p), t = orientation(a, b, c, q);
  if (s * t > 0) return false;
  if (s == 0 && t == 0) return coplanar_intersect(p, q, a, b, c);
  const int o1 = orientation(p, q, a, b), o2 = orientation(p, q, b, c), o3 = orientation(p, q, c, a);
  return (o1 >= 0 && o2 >= 0 && o3 >= 0) || (o1 <= 0 && o2 <= 0 && o3 <= 0);
}

std::vector<Intersection> intersections(const std::vector<Side>& sides, const std::vector<Touching>& pairs,
                                        const std::vector<Vec3>& x, std::size_t most) {
  std::vector<TriangleTree> trees;
  for (const Side& side : sides) trees.emplace_back(side.triangles, x);
  std::vector<Intersection> out;
  for (int p = 0; p < int(pairs.size()); ++p) {
    const auto &A = sides[pairs[p].a].triangles, &B = sides[pairs[p].b].triangles;
    const bool self = pairs[p].a == pairs[p].b;
    std::vector<std::vector<Intersection>> chunks((A.size() + triangle_chunk - 1) / triangle_chunk);
    parallel::for_chunks(A.size(), triangle_chunk, [&](std::size_t begin, std::size_t end, std::size_t chunk) {
      for (std::size_t i = begin; i < end; ++i)
        trees[pairs[p].b].for_each(trees[pairs[p].a].box(i), [&](std::int32_t j) {
          if (self && j <= std::int32_t(i)) return;
          if (triangles_intersect(A[i], B[j], x)) chunks[chunk].push_back({p, int(i), j});
        });
    });
    for (const auto& chunk : chunks) out.insert(out.end(), chunk.begin(), chunk.end());
  }
  if (out.size() > most) out.resize(most);
  return out;
}

}  // namespace carus::contact
