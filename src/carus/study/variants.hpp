// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "carus/scenario/scenario.hpp"

namespace carus::study {

/// One row of a file of variants, as written.
struct Variant {
  std::string name;                ///< also its folder's
  std::vector<std::string> set;    ///< key=value, or key*=factor
  std::filesystem::path scenario;  ///< empty: the study's
};

/// Reads
///
///     description: what the set asks
///     variants:
///       - {name: half_drag, set: [numerics.drag_factor*=0.5]}
///       - {name: strict, scenario: ../paper_strict.yaml}      # relative to this file
///
/// Throws InputError with all problems, each naming file and row: unknown keys, names that are missing, given twice or
/// no folder's, rows that change nothing.
std::vector<Variant> read_variants(const std::filesystem::path& file);

/// What `--variants` means: the file itself if it ends in .yaml, else studies/NAME.yaml beside the scenario. Throws
/// InputError naming the sets that are there.
std::filesystem::path find_variants(const std::string& name, const std::filesystem::path& scenario);

/// One birth of a study.
struct Row {
  std::string name;
  std::vector<std::string> set;  ///< as written
  scenario::Scenario scenario;
  std::string same_as;  ///< an earlier row with the very same scenario, whose results are this row's
};

inline constexpr const char* base_row = "base";

/// The base row, which is the scenario with `overrides`, and one row per variant, whose own settings come after the
/// overrides and win. `key*=factor` multiplies what the key has by then. Throws InputError with the problems of all
/// rows, each naming its row.
std::vector<Row> rows_of(const std::filesystem::path& scenario, const std::vector<std::string>& overrides,
                         const std::vector<Variant>& variants);

}  // namespace carus::study
