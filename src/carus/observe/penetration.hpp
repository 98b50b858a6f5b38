// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "carus/fem/model.hpp"

namespace carus::observe {

/// Where two contact surfaces stand, by an exact search that shares nothing with the solver's contact.
struct Penetration {
  double least_gap = 0;        ///< [m] over both passes, at most `search`; negative: deepest penetration
  std::int32_t node = -1;      ///< the node that has it
  int penetrated = 0;          ///< nodes that lie inside the other body
};

/// Nodes of each surface of a pair against the facets of the other (both passes). A node is inside if a tet of the other's body that
/// does not contain the node as a corner holds it; its depth is then the exact distance to the nearest facet of the surface.
/// Self-contact (a == b) counts penetration only: a gap to one's own neighbours means nothing.
class PenetrationCheck {
 public:
  /// `search` [m]: gaps beyond it are not looked for.
  PenetrationCheck(const fem::Model& model, double search);
  /// One entry per Model::contact_pairs.
  [[nodiscard]] std::vector<Penetration> check(const std::vector<Vec3>& x) const;

 private:
  struct Side {
    std::vector<std::int32_t> nodes;  // of the surface
    std::vector<std::int32_t> tets;   // of the connected body behind the surface
  };
  void pass(const std::vector<Vec3>& x, int from, int onto, Penetration& out) const;

  const fem::Model& model_;
  double search_;
  std::vector<Side> sides_;  // one per contact surface
};

}  // namespace carus::observe
