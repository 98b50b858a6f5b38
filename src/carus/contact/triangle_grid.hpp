// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cmath>
#include <cstdint>
#include <vector>

#include "carus/mesh/tet_mesh.hpp"

namespace carus::contact {

/// Uniform grid over the boxes of triangles, each widened by `reach`: the cell of a point lists every triangle within
/// reach.
class TriangleGrid {
 public:
  /// Cost: a few tens of nanoseconds per triangle and cell it covers.
  void build(const std::vector<Vec3>& x, const mesh::Triangles& triangles, double reach);

  /// Calls f(triangle) in rising order for every triangle that may lie within reach of p.
  template <class F>
  void for_each_near(const Vec3& p, F&& f) const {
    const Vec3 r = (p - low_) / cell_;
    const int i = int(std::floor(r.x())), j = int(std::floor(r.y())), k = int(std::floor(r.z()));
    if (i < 0 || j < 0 || k < 0 || i >= n_[0] || j >= n_[1] || k >= n_[2]) return;
    const std::size_t c = std::size_t((k * n_[1] + j) * n_[0] + i);
    for (std::int32_t q = begin_[c]; q < begin_[c + 1]; ++q) f(items_[std::size_t(q)]);
  }

 private:
  Vec3 low_ = Vec3::Zero();
  double cell_ = 1;
  int n_[3] = {0, 0, 0};
  std::vector<std::int32_t> begin_, items_;
};

}  // namespace carus::contact
