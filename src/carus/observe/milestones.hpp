// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "carus/observe/observer.hpp"

namespace carus::observe {

/// Outputs so far: names, and one row of values each.
struct Table {
  std::vector<std::string> names;
  std::vector<Values> rows;
  [[nodiscard]] std::optional<std::size_t> find(const std::string& name) const;
  [[nodiscard]] double at(std::size_t row, const std::string& name) const;  ///< NaN if there is no such column
  [[nodiscard]] Values column(const std::string& name) const;               ///< empty if there is none
};

/// A cardinal event of a birth.
struct Milestone {
  std::string name;  ///< "engagement", "spines", "widest_at_spines", "crowning", "birth", "body_out"
  double time;       ///< [s of labour] of the first crossing, linear between outputs
  std::size_t row;   ///< the first output after it
};

/// The first crossings so far, by time. Engagement: the head's widest plane passes the inlet; spines: its leading point
/// passes the interspinous plane; crowning: its widest plane passes the vulva; birth: the last node of the skull has;
/// body_out: of the fetus.
std::vector<Milestone> milestones(const Table& table);

}  // namespace carus::observe
