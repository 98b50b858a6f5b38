// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "carus/mesh/tet_mesh.hpp"

namespace carus::fem {

/// Symmetric 12x12 matrix of one tet, as 3x3 blocks (a, b), a <= b, in the order 00 01 02 03 11 12 13 22 23 33.
using TetMatrix = std::array<Mat3, 10>;
/// Where block (a, b), a <= b, is in a TetMatrix.
constexpr int tet_block(int a, int b) { return a * (7 - a) / 2 + b; }

/// Sparse symmetric matrix of 3x3 blocks over the nodes of a set of tets. Rows hold both halves, so that each row
/// belongs to one thread and sums come in an order of their own.
class BlockMatrix {
 public:
  /// `tets` of a mesh with `node_count` nodes.
  BlockMatrix(const std::vector<mesh::Tet>& tets, std::size_t node_count);

  /// Sum of the tets' matrices.
  void assemble(const std::vector<TetMatrix>& parts);
  /// y = A x; y is overwritten.
  void multiply(const std::vector<Vec3>& x, std::vector<Vec3>& y) const;
  [[nodiscard]] const Mat3& diagonal(std::size_t node) const { return blocks_[std::size_t(diagonal_[node])]; }

  /// The pattern: row i has columns() from row_begin()[i] to row_begin()[i + 1], in rising order.
  [[nodiscard]] const std::vector<std::int32_t>& row_begin() const { return row_begin_; }
  [[nodiscard]] const std::vector<std::int32_t>& columns() const { return columns_; }
  /// Tets round a node, as 4 tet + corner; from around_begin()[i] to around_begin()[i + 1].
  [[nodiscard]] const std::vector<std::int32_t>& around_begin() const { return around_begin_; }
  [[nodiscard]] const std::vector<std::int32_t>& around() const { return around_; }
  /// For each entry of around(): where in the row the tet's four corners are.
  [[nodiscard]] const std::vector<std::array<std::int32_t, 4>>& places() const { return places_; }

 private:
  std::vector<std::int32_t> row_begin_, columns_, diagonal_, around_begin_, around_;
  std::vector<std::array<std::int32_t, 4>> places_;
  std::vector<Mat3> blocks_;
};

}  // namespace carus::fem
