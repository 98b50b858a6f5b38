// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <fstream>

#include "carus/observe/milestones.hpp"

namespace carus::results {

/// curves.csv and the same table in memory. Every row is flushed; numbers read back to the same doubles.
class Curves {
 public:
  /// A fresh file, or with `keep` the first rows of the one that is there. Throws InputError if it does not fit.
  Curves(const std::filesystem::path& file, std::vector<std::string> names);
  Curves(const std::filesystem::path& file, std::vector<std::string> names, std::size_t keep);

  void append(const observe::Values& row);
  [[nodiscard]] const observe::Table& table() const { return table_; }

 private:
  std::ofstream out_;
  observe::Table table_;
};

/// Reads a curves.csv; a torn last line is left out.
observe::Table read_curves(const std::filesystem::path& file);

}  // namespace carus::results
