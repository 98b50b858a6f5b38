// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include "carus/report/folder.hpp"
#include "carus/results/figures.hpp"

namespace carus::report {

/// A run held against the paper's validation parameters and the bands that it is judged by, computed from its curves.
struct Verdict {
  std::vector<results::Band> rows;  ///< number 0: the paper's, first
  int inside = 0, outside = 0, not_asked = 0;
  bool met = false;  ///< nothing that is asked is outside, and the run could be judged and has ended
  std::string line;  ///< the same in words
};
Verdict judge(const Folder& folder);

/// As a table for a terminal, the verdict its last line.
std::string as_text(const Folder& folder, const Verdict& verdict);

}  // namespace carus::report
