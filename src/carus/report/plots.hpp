// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "carus/report/folder.hpp"

namespace carus::report {

/// A horizontal line or band in a plot: what the paper or the literature gives. A value has low == high.
struct Mark {
  std::optional<double> low, high;
  std::string label, source;
};
struct Line {
  std::string column, label;
};
struct PlotReference {
  std::string label, source;
  std::vector<double> time, value;
};
/// Curves drawn together, with what they are held against.
struct Plot {
  std::string id, title, figure, unit;
  std::vector<Line> lines;
  std::vector<Mark> marks;
  std::vector<PlotReference> references;
};

/// The projection on the line from start to end that the trajectory plot shows; a column of its own.
inline constexpr const char* axis_column = "head_axis_mm";

/// The plots whose curves `folder` holds; lines of absent columns are left out. Appends `axis_column` to `curves` if
/// the head's pose is there.
std::vector<Plot> plots_of(const Folder& folder, observe::Table& curves);

/// "mm", "deg", "mm/s" ... from a column's name; "" for ratios and counts.
std::string unit_of(const std::string& column);

}  // namespace carus::report
