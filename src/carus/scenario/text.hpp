// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

namespace carus::scenario {

/// "a, b, c". Not fmt::join: GCC 12 sees a write past the end inside it and warnings are errors here.
inline std::string enumerated(const std::vector<std::string>& words) {
  std::string out;
  for (const std::string& word : words) {
    if (!out.empty()) out += ", ";
    out += word;
  }
  return out;
}

}  // namespace carus::scenario
