// SPDX-License-Identifier: Apache-2.0
#include "carus/contact/triangle_grid.hpp"

#include <algorithm>

namespace carus::contact {

namespace {

template <class F>
void for_each_cell(const Vec3& lo, const Vec3& hi, const Vec3& low, double cell, const int n[3], F&& f) {
  int a[3], b[3];
  for (int k = 0; k < 3; ++k) {
    a[k] = std::clamp(int(std::floor((lo[k] - low[k]) / cell)), 0, n[k] - 1);
    b[k] = std::clamp(int(std::floor((hi[k] - low[k]) / cell)), 0, n[k] - 1);
  }
  for (int k = a[2]; k <= b[2]; ++k) {
    for (int j = a[1]; j <= b[1]; ++j) {
      for (int i = a[0]; i <= b[0]; ++i) f(std::size_t((k * n[1] + j) * n[0] + i));
    }
  }
}

}  // namespace

void TriangleGrid::build(const std::vector<Vec3>& x, const mesh::Triangles& triangles, double reach) {
  Vec3 lo = Vec3::Constant(1e30), hi = -lo;
  double edges = 0;
  std::vector<std::pair<Vec3, Vec3>> boxes(triangles.size());
  for (std::size_t t = 0; t < triangles.size(); ++t) {
    const Vec3 &a = x[triangles[t][0]], &b = x[triangles[t][1]], &c = x[triangles[t][2]];
    boxes[t] = {a.cwiseMin(b).cwiseMin(c).array() - reach, a.cwiseMax(b).cwiseMax(c).array() + reach};
    lo = lo.cwiseMin(boxes[t].first), hi = hi.cwiseMax(boxes[t].second);
    edges += (b - a).norm();
  }
  // Cells of about a facet with its reach: fewer are long lists, more are many copies. At most 2^21 of them.
  cell_ = std::max(edges / double(std::max<std::size_t>(triangles.size(), 1)), 0.6 * reach);
  const Vec3 size = hi - lo;
  while (size.x() / cell_ * (size.y() / cell_) * (size.z() / cell_) > 2e6) cell_ *= 1.3;
  low_ = lo;
  for (int k = 0; k < 3; ++k) n_[k] = triangles.empty() ? 0 : int(size[k] / cell_) + 1;
  begin_.assign(std::size_t(n_[0]) * std::size_t(n_[1]) * std::size_t(n_[2]) + 1, 0);
  for (const auto& [l, h] : boxes) for_each_cell(l, h, low_, cell_, n_, [&](std::size_t c) { ++begin_[c + 1]; });
  for (std::size_t c = 1; c < begin_.size(); ++c) begin_[c] += begin_[c - 1];
  items_.resize(std::size_t(begin_.back()));
  std::vector<std::int32_t> next(begin_.begin(), begin_.end() - 1);
  for (std::size_t t = 0; t < boxes.size(); ++t) {
    for_each_cell(boxes[t].first, boxes[t].second, low_, cell_, n_,
                  [&](std::size_t c) { items_[std::size_t(next[c]++)] = std::int32_t(t); });
  }
}

}  // namespace carus::contact
