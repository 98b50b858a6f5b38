// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "carus/fem/model.hpp"
#include "carus/solve/pcg.hpp"

namespace carus::solve {

/// What a model's nodes may do. The unknowns are one entry per node and then one per hinge, whose first component is
/// its angle. Motions of the nodes are u = T q: blocked axes and directions take no part, a hinge's nodes turn with it,
/// a tied node goes with its facet.
class Freedom {
 public:
  explicit Freedom(const fem::Model& model);

  [[nodiscard]] std::size_t unknowns() const { return nodes_ + model_.hinges.size(); }
  [[nodiscard]] std::size_t nodes() const { return nodes_; }
  /// Nodes move somehow, by themselves, by a hinge, a tie or a motion.
  [[nodiscard]] bool moves(std::size_t node) const { return moves_[node]; }

  /// u = T q at the positions x; u has an entry per node.
  void expand(const Unknowns& q, const std::vector<Vec3>& x, std::vector<Vec3>& u) const;
  /// r = T^T f.
  void reduce(const std::vector<Vec3>& f, const std::vector<Vec3>& x, Unknowns& r) const;
  /// Diagonal blocks of T^T A T from those of A, without what couples a hinge's or a tie's nodes.
  void reduce_diagonal(const std::vector<Mat3>& d, const std::vector<Vec3>& x, std::vector<Mat3>& out) const;
  /// Sets what is blocked in diagonal blocks to the identity.
  void fill_blocked(std::vector<Mat3>& d) const;
  /// Positions of the hinges' nodes at the given angles, and of the tied nodes.
  void place(const std::vector<double>& hinge_angle, std::vector<Vec3>& x) const;
  /// Imposed axes of a node; 0 where nothing is imposed.
  [[nodiscard]] std::uint8_t imposed(std::size_t node) const { return imposed_[node]; }

 private:
  [[nodiscard]] Vec3 project(std::size_t node, Vec3 u) const;

  const fem::Model& model_;
  std::size_t nodes_;
  std::vector<std::uint8_t> fixed_;  ///< axes that no unknown moves
  std::vector<std::uint8_t> imposed_;
  std::vector<std::uint8_t> moves_;
};

}  // namespace carus::solve
