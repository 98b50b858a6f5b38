// SPDX-License-Identifier: Apache-2.0
#include "carus/contact/broad_phase.hpp"

#include <algorithm>
#include <numeric>

namespace carus::contact {

namespace {

constexpr std::int32_t leaf_size = 4;

}  // namespace

TriangleTree::TriangleTree(const mesh::Triangles& triangles, const std::vector<Vec3>& rest)
    : order_(triangles.size()), items_(triangles.size()) {
  std::iota(order_.begin(), order_.end(), 0);
  std::vector<Vec3> centres;
  for (const auto& t : triangles) centres.push_back((rest[t[0]] + rest[t[1]] + rest[t[2]]) / 3);
  if (triangles.empty()) return;
  nodes_.push_back({{}, -1, 0, std::int32_t(triangles.size())});
  for (std::size_t i = 0; i < nodes_.size(); ++i) split(std::int32_t(i), centres);
  refit(triangles, rest, rest);
}

void TriangleTree::split(std::int32_t i, const std::vector<Vec3>& centres) {
  const auto first = nodes_[i].first, last = nodes_[i].last;
  if (last - first <= leaf_size) return;
  Box box;
  for (auto k = first; k < last; ++k) box.extend(centres[order_[k]]);
  int axis = 0;
  box.sizes().maxCoeff(&axis);
  const auto middle = first + (last - first) / 2;
  std::nth_element(order_.begin() + first, order_.begin() + middle, order_.begin() + last, [&](auto a, auto b) {
    return centres[a][axis] != centres[b][axis] ? centres[a][axis] < centres[b][axis] : a < b;
  });
  nodes_[i].left = std::int32_t(nodes_.size());
  nodes_.push_back({{}, -1, first, middle});
  nodes_.push_back({{}, -1, middle, last});
}

void TriangleTree::refit(const mesh::Triangles& triangles, const std::vector<Vec3>& x, const std::vector<Vec3>& y) {
  for (std::size_t t = 0; t < triangles.size(); ++t) {
    items_[t].setEmpty();
    for (const auto n : triangles[t]) items_[t].extend(x[n]).extend(y[n]);
  }
  for (std::size_t i = nodes_.size(); i-- > 0;) {  // children come after their parents
    Node& node = nodes_[i];
    node.box.setEmpty();
    if (node.left >= 0) {
      node.box.extend(nodes_[std::size_t(node.left)].box);
      node.box.extend(nodes_[std::size_t(node.left) + 1].box);
    } else {
      for (auto k = node.first; k < node.last; ++k) node.box.extend(items_[std::size_t(order_[k])]);
    }
  }
}

}  // namespace carus::contact
