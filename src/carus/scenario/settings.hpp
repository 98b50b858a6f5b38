// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <map>
#include <string>
#include <variant>

#include "carus/scenario/raw.hpp"
#include "carus/scenario/schema.hpp"

namespace carus::scenario {

/// Every value of a scenario by its path: booleans, numbers and quantities in SI, choices and texts.
struct Settings {
  std::map<std::string, std::variant<bool, double, std::string>> values;
  std::map<std::string, std::size_t> sizes;  ///< of lists; their items are "path[i].key"
  std::map<std::string, std::string> files;  ///< where a value was set; absent for defaults
};

/// Checks what was written against the schema, converts units once and fills in the defaults. Each problem reads
/// "FILE: key.path: VALUE is ...; allowed ...; hint"; a value outside what its source covers is a warning.
Settings settle(const Raw& root, Problems& problems, Problems& warnings, const Key& keys = schema());

/// Every key of `keys` with its value and unit, as YAML; parses back to the same settings.
std::string settings_yaml(const Settings& settings, const Key& keys);

}  // namespace carus::scenario
