// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "carus/fem/element_block.hpp"

namespace carus::fem {

/// Average nodal pressure (Bonet and Burton 1998): linear tets do not lock near incompressibility when the volume ratio
/// is that of the elements round a node, p_a = dU/dJ at J_a = sum V / sum V0, and an element takes the mean of its
/// four. Averages are taken within one region, so that neighbours of unlike stiffness do not share a pressure.
class NodalPressure {
 public:
  NodalPressure(const Model& model, std::vector<Block>& blocks);

  [[nodiscard]] bool any() const { return !nodes_.empty(); }
  /// Volumes round the nodes of one block, from its local positions; of all blocks before `update`. Blocks may be done
  /// side by side.
  void add_volumes(Block& block) const;
  /// From the volumes to Block::pressure.
  void update(std::vector<Block>& blocks) const;
  /// Volumetric energy of the averaged regions, sum of V0_a U(J_a) [J], of the last update.
  [[nodiscard]] double energy() const;

 private:
  struct Node {
    float bulk, rest_volume;
    std::int32_t first, last;  ///< shares
  };
  struct Share {
    std::int32_t block, slot;
  };
  std::vector<Node> nodes_;
  std::vector<Share> shares_;
  mutable std::vector<float> strain_;  ///< J_a - 1 of the last update
};

}  // namespace carus::fem
