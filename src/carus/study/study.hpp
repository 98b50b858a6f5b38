// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "carus/results/birth_run.hpp"
#include "carus/study/measures.hpp"
#include "carus/study/variants.hpp"

namespace carus::study {

/// One line of the table.
struct Entry {
  std::string name;
  std::vector<std::string> set;
  std::string same_as;  ///< the row that its numbers are from
  bool kept = false;    ///< its results were there before
  Measures measures;
  std::optional<double> difference;  ///< [%] largest_difference_percent against the base; of the base itself empty
};

struct Table {
  std::string scenario, variants;  ///< files
  std::string version, commit;
  std::vector<Entry> entries;  ///< of the rows done so far, the base first
  bool interrupted = false;
};

std::string markdown(const Table& table);
std::string json(const Table& table);

struct Options {
  std::filesystem::path out;
  std::string scenario, variants, version, commit;  ///< for the table
  /// Runs one birth into its folder, from its checkpoint if `resume`. Throws InputError if it cannot begin.
  std::function<results::Outcome(const scenario::Scenario&, const std::filesystem::path& folder, bool resume)> run;
  std::function<void(const std::string&)> tell;  ///< gets one line per row
};

/// Runs each row into OUT/NAME and writes OUT/study.md and OUT/study.json after each. Rows whose whole results are
/// there are kept, half-done ones go on from their checkpoint; a row that fails or is refused is a line of the table;
/// an interruption ends the study.
Table run(const std::vector<Row>& rows, const Options& options);

}  // namespace carus::study
