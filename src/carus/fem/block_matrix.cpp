// SPDX-License-Identifier: Apache-2.0
#include "carus/fem/block_matrix.hpp"

#include <algorithm>

#include "carus/core/parallel.hpp"

namespace carus::fem {

namespace {

constexpr std::size_t row_chunk = 512;

}  // namespace

BlockMatrix::BlockMatrix(const std::vector<mesh::Tet>& tets, std::size_t node_count)
    : row_begin_(node_count + 1, 0),
      diagonal_(node_count, 0),
      around_begin_(node_count + 1, 0),
      around_(4 * tets.size()) {
  for (const auto& t : tets)
    for (const auto n : t) ++around_begin_[std::size_t(n) + 1];
  for (std::size_t i = 0; i < node_count; ++i) around_begin_[i + 1] += around_begin_[i];
  auto next = around_begin_;
  for (std::size_t e = 0; e < tets.size(); ++e)
    for (int a = 0; a < 4; ++a) around_[std::size_t(next[std::size_t(tets[e][a])]++)] = std::int32_t(4 * e) + a;

  places_.resize(around_.size());
  std::vector<std::int32_t> row;
  for (std::size_t i = 0; i < node_count; ++i) {
    row.assign(1, std::int32_t(i));
    for (auto k = around_begin_[i]; k < around_begin_[i + 1]; ++k)
      for (const auto n : tets[std::size_t(around_[k] / 4)]) row.push_back(n);
    std::sort(row.begin(), row.end());
    row.erase(std::unique(row.begin(), row.end()), row.end());
    const auto place = [&](std::int32_t n) {
      return row_begin_[i] + std::int32_t(std::lower_bound(row.begin(), row.end(), n) - row.begin());
    };
    for (auto k = around_begin_[i]; k < around_begin_[i + 1]; ++k)
      for (int b = 0; b < 4; ++b) places_[k][b] = place(tets[std::size_t(around_[k] / 4)][b]);
    diagonal_[i] = place(std::int32_t(i));
    columns_.insert(columns_.end(), row.begin(), row.end());
    row_begin_[i + 1] = std::int32_t(columns_.size());
  }
  blocks_.resize(columns_.size());
}

void BlockMatrix::assemble(const std::vector<TetMatrix>& parts) {
  parallel::for_chunks(diagonal_.size(), row_chunk, [&](std::size_t begin, std::size_t end, std::size_t) {
    for (auto k = row_begin_[begin]; k < row_begin_[end]; ++k) blocks_[k].setZero();
    for (auto k = around_begin_[begin]; k < around_begin_[end]; ++k) {
      const TetMatrix& part = parts[std::size_t(around_[k] / 4)];
      const int a = around_[k] % 4;
      for (int b = 0; b < 4; ++b) {
        Mat3& block = blocks_[places_[k][b]];
        if (a <= b)
          block += part[tet_block(a, b)];
        else
          block += part[tet_block(b, a)].transpose();
      }
    }
  });
}

void BlockMatrix::multiply(const std::vector<Vec3>& x, std::vector<Vec3>& y) const {
  parallel::for_chunks(diagonal_.size(), row_chunk, [&](std::size_t begin, std::size_t end, std::size_t) {
    for (std::size_t i = begin; i < end; ++i) {
      Vec3 sum = Vec3::Zero();
      for (auto k = row_begin_[i]; k < row_begin_[i + 1]; ++k) sum.noalias() += blocks_[k] * x[columns_[k]];
      y[i] = sum;
    }
  });
}

}  // namespace carus::fem
