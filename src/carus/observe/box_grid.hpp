// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cstdint>
#include <vector>

#include "carus/core/types.hpp"

namespace carus::observe {

using Box = Eigen::AlignedBox3d;

/// Boxes binned into a uniform grid over their common hull, for queries by point or box.
class BoxGrid {
 public:
  /// `boxes` are kept by index; `cell` [m] is enlarged where the grid would exceed 4 cells per box.
  BoxGrid(const std::vector<Box>& boxes, double cell) {
    for (const auto& b : boxes) hull_.extend(b);
    if (boxes.empty()) return;
    const Vec3 size = hull_.sizes();
    const double most = 4.0 * double(boxes.size()) + 8;
    while ((size / cell).array().ceil().max(1).prod() > most) cell *= 1.26;
    cell_ = cell;
    for (int k = 0; k < 3; ++k) n_[k] = std::max(1, int(std::ceil(size[k] / cell)));
    start_.assign(std::size_t(n_[0]) * n_[1] * n_[2] + 1, 0);
    for (const auto& b : boxes) each_cell(b, [&](std::size_t c) { ++start_[c + 1]; });
    for (std::size_t c = 1; c < start_.size(); ++c) start_[c] += start_[c - 1];
    items_.resize(start_.back());
    auto next = start_;
    for (std::size_t i = 0; i < boxes.size(); ++i) {
      each_cell(boxes[i], [&](std::size_t c) { items_[next[c]++] = std::int32_t(i); });
    }
  }

  /// f(index) for every box that may touch `query`; an index can come more than once.
  template <class F>
  void visit(const Box& query, F&& f) const {
    if (start_.empty() || !hull_.intersects(query)) return;
    each_cell(hull_.intersection(query), [&](std::size_t c) {
      for (auto k = start_[c]; k < start_[c + 1]; ++k) f(items_[k]);
    });
  }

 private:
  template <class F>
  void each_cell(const Box& b, F&& f) const {
    const auto lo = cell_of(b.min()), hi = cell_of(b.max());
    for (int k = lo[2]; k <= hi[2]; ++k)
      for (int j = lo[1]; j <= hi[1]; ++j)
        for (int i = lo[0]; i <= hi[0]; ++i) f((std::size_t(k) * n_[1] + j) * n_[0] + i);
  }
  [[nodiscard]] std::array<int, 3> cell_of(const Vec3& p) const {
    std::array<int, 3> c{};
    for (int k = 0; k < 3; ++k) c[k] = std::clamp(int((p[k] - hull_.min()[k]) / cell_), 0, n_[k] - 1);
    return c;
  }

  Box hull_;
  double cell_ = 1;
  std::array<int, 3> n_{1, 1, 1};
  std::vector<std::uint32_t> start_;
  std::vector<std::int32_t> items_;
};

}  // namespace carus::observe
