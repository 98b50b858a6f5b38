// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Geometry>
#include <cstdint>
#include <vector>

#include "carus/mesh/tet_mesh.hpp"

namespace carus::contact {

/// Hierarchy of boxes over triangles. Its topology follows from the rest positions; `refit` follows the motion.
class TriangleTree {
 public:
  using Box = Eigen::AlignedBox3d;

  TriangleTree(const mesh::Triangles& triangles, const std::vector<Vec3>& rest);

  /// Boxes of the triangles on their way from x to y. Linear.
  void refit(const mesh::Triangles& triangles, const std::vector<Vec3>& x, const std::vector<Vec3>& y);
  [[nodiscard]] const Box& box(std::size_t triangle) const { return items_[triangle]; }

  /// Calls f(triangle) for all whose boxes meet `query`, always in the same order.
  template <class F>
  void for_each(const Box& query, F&& f) const {
    if (nodes_.empty()) return;
    std::int32_t stack[64];
    int top = 0;
    stack[top++] = 0;
    while (top > 0) {
      const Node& node = nodes_[std::size_t(stack[--top])];
      if (!node.box.intersects(query)) continue;
      if (node.left < 0) {
        for (auto k = node.first; k < node.last; ++k)
          if (items_[std::size_t(order_[k])].intersects(query)) f(order_[k]);
        continue;
      }
      stack[top++] = node.left + 1;
      stack[top++] = node.left;
    }
  }

 private:
  struct Node {
    Box box;
    std::int32_t left = -1;  ///< the right child follows it; -1: leaf
    std::int32_t first = 0, last = 0;
  };
  void split(std::int32_t node, const std::vector<Vec3>& centres);

  std::vector<Node> nodes_;
  std::vector<std::int32_t> order_;
  std::vector<Box> items_;
};

}  // namespace carus::contact
