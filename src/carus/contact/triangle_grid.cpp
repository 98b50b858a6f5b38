// SPDX-License-Identifier: Apache-2.0
#include "carus/contact/triangle_grid.hpp"

namespace carus::contact {

void TriangleGrid::build(const std::vector<Vec3>& x, const mesh::Triangles& triangles, double reach) {
  begin_.clear();
  hull_.setEmpty();
  boxes_.resize(triangles.size());
  of_.resize(triangles.size());
  double edges = 0;
  for (std::size_t t = 0; t < triangles.size(); ++t) {
    const Vec3 &a = x[triangles[t][0]], &b = x[triangles[t][1]], &c = x[triangles[t][2]];
    boxes_[t] = Box(a.cwiseMin(b).cwiseMin(c), a.cwiseMax(b).cwiseMax(c));
    hull_.extend(boxes_[t]);
    const Vec3 normal = (b - a).cross(c - a).normalized();
    // Positions are below a few metres: single precision is off by less than a micrometre.
    of_[t] = {boxes_[t].center().cast<float>(), (0.5 * boxes_[t].sizes().array() + 1e-6).matrix().cast<float>(),
              normal.cast<float>(), std::int32_t(t)};
    edges += (b - a).norm();
  }
  if (triangles.empty()) return;
  // Cells of a facet or the reach: fewer are long lists, more are many cells to visit. At most 2e6 of them.
  cell_ = std::max(edges / double(triangles.size()), reach);
  const Vec3 size = hull_.sizes();
  while (((size / cell_).array() + 1).prod() > 2e6) cell_ *= 1.3;
  for (int k = 0; k < 3; ++k) n_[k] = int(size[k] / cell_) + 1;
  begin_.assign(std::size_t(n_[0]) * std::size_t(n_[1]) * std::size_t(n_[2]) + 1, 0);
  for (const Box& b : boxes_) for_each_cell(b, [&](std::size_t c) { ++begin_[c + 1]; });
  for (std::size_t c = 1; c < begin_.size(); ++c) begin_[c] += begin_[c - 1];
  items_.resize(std::size_t(begin_.back()));
  next_.assign(begin_.begin(), begin_.end() - 1);
  for (std::size_t t = 0; t < boxes_.size(); ++t) {
    for_each_cell(boxes_[t], [&](std::size_t c) { items_[std::size_t(next_[c]++)] = of_[t]; });
  }
  cones_.resize(begin_.size() - 1);
  for (std::size_t c = 0; c < cones_.size(); ++c) {
    Eigen::Vector3f sum = Eigen::Vector3f::Zero();
    for (std::int32_t q = begin_[c]; q < begin_[c + 1]; ++q) sum += items_[std::size_t(q)].normal;
    Cone& cone = cones_[c] = {sum.normalized(), 0};
    float least = 1;
    for (std::int32_t q = begin_[c]; q < begin_[c + 1]; ++q)
      least = std::min(least, items_[std::size_t(q)].normal.dot(cone.axis));
    cone.sine = least > 0 ? std::sqrt(1 - least * least) + rounding : 2;  // 2: no direction has all of them ahead
  }
}

}  // namespace carus::contact
