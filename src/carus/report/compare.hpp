// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "carus/report/folder.hpp"

namespace carus::report {

/// A figure of several runs side by side.
struct ComparisonRow {
  std::string what, unit;
  std::vector<std::optional<double>> values;  ///< per run
};
/// Figures of the runs from their curves, and their differences to the first are the reader's. Figures that need the
/// timetable are absent where a run's scenario cannot be read.
std::vector<ComparisonRow> compare(const std::vector<const Folder*>& runs);

}  // namespace carus::report
