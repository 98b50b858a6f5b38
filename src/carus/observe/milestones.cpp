// SPDX-License-Identifier: Apache-2.0
#include "carus/observe/milestones.hpp"

#include <algorithm>
#include <array>
#include <limits>

namespace carus::observe {

std::optional<std::size_t> Table::find(const std::string& name) const {
  const auto it = std::find(names.begin(), names.end(), name);
  if (it == names.end()) return std::nullopt;
  return std::size_t(it - names.begin());
}

double Table::at(std::size_t row, const std::string& name) const {
  const auto c = find(name);
  return c ? rows[row][*c] : std::numeric_limits<double>::quiet_NaN();
}

Values Table::column(const std::string& name) const {
  Values values;
  if (const auto c = find(name)) {
    for (const auto& row : rows) values.push_back(row[*c]);
  }
  return values;
}

std::vector<Milestone> milestones(const Table& table) {
  constexpr std::array definitions{
      std::pair{"engagement", "widest_past_inlet_mm"},    std::pair{"spines", "station_mm"},
      std::pair{"widest_at_spines", "widest_station_mm"}, std::pair{"crowning", "widest_past_vulva_mm"},
      std::pair{"birth", "skull_past_vulva_mm"},          std::pair{"body_out", "fetus_past_vulva_mm"}};
  std::vector<Milestone> found;
  const auto time = table.column("time_s");
  for (const auto& [name, column] : definitions) {
    const auto v = table.column(column);
    for (std::size_t i = 0; i < v.size(); ++i) {
      if (!(v[i] > 0)) continue;
      const double t = i == 0 ? time[0] : time[i - 1] + (time[i] - time[i - 1]) * v[i - 1] / (v[i - 1] - v[i]);
      found.push_back({name, t, i});
      break;
    }
  }
  std::stable_sort(found.begin(), found.end(), [](const auto& a, const auto& b) { return a.row < b.row; });
  return found;
}

}  // namespace carus::observe
