// SPDX-License-Identifier: Apache-2.0
#include "carus/mesh/surface.hpp"

#include <Eigen/Geometry>
#include <cmath>
#include <numeric>

namespace carus::mesh {
namespace {

std::int32_t root(std::vector<std::int32_t>& parent, std::int32_t i) {
  while (parent[i] != i) i = parent[i] = parent[parent[i]];
  return i;
}

}  // namespace

double volume(const Surface& s) {
  if (s.nodes.empty()) return 0;
  const Vec3 o = box(s).center();  // near the surface: less is lost by cancellation
  double v = 0;
  for (const auto& t : s.triangles) v += (s.nodes[t[0]] - o).dot((s.nodes[t[1]] - o).cross(s.nodes[t[2]] - o)) / 6;
  return v;
}

double area(const Surface& s) {
  double a = 0;
  for (const auto& t : s.triangles)
    a += (s.nodes[t[1]] - s.nodes[t[0]]).cross(s.nodes[t[2]] - s.nodes[t[0]]).norm() / 2;
  return a;
}

Eigen::AlignedBox3d box(const Surface& s) {
  Eigen::AlignedBox3d b;
  for (const auto& x : s.nodes) b.extend(x);
  return b;
}

Parts parts(const Surface& s) {
  std::vector<std::int32_t> parent(s.nodes.size());
  std::iota(parent.begin(), parent.end(), 0);
  for (const auto& t : s.triangles)
    for (int k = 1; k < 3; ++k) parent[root(parent, t[k])] = root(parent, t[0]);
  Parts p;
  std::vector<std::int32_t> number(s.nodes.size(), -1);
  for (const auto& t : s.triangles) {
    auto& n = number[root(parent, t[0])];
    if (n < 0) n = p.count++;
    p.of.push_back(n);
  }
  return p;
}

double winding_number(const Surface& s, const Vec3& x) {
  // Solid angle of a triangle (van Oosterom and Strackee 1983):
  //   tan(w/2) = a.(b x c) / (|a||b||c| + (a.b)|c| + (b.c)|a| + (c.a)|b|)
  double sum = 0;
  for (const auto& t : s.triangles) {
    const Vec3 a = s.nodes[t[0]] - x, b = s.nodes[t[1]] - x, c = s.nodes[t[2]] - x;
    const double la = a.norm(), lb = b.norm(), lc = c.norm();
    sum += std::atan2(a.dot(b.cross(c)), la * lb * lc + a.dot(b) * lc + b.dot(c) * la + c.dot(a) * lb);
  }
  return sum / (2 * pi);
}

}  // namespace carus::mesh
