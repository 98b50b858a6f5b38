// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <string>
#include <utility>
#include <vector>

namespace carus::scenario {

/// What the user wrote, before anything is known of its meaning, with the file that each value came from.
struct Raw {
  enum class Kind { nothing, scalar, list, map };
  Kind kind = Kind::nothing;
  std::string text;  ///< of a scalar
  bool quoted = false;
  std::string file;
  std::vector<Raw> list;
  std::vector<std::pair<std::string, Raw>> map;

  [[nodiscard]] const Raw* find(const std::string& key) const;
  Raw& at_or_add(const std::string& key);
};

using Problems = std::vector<std::string>;

/// YAML text, merged over what it extends. Bad YAML, duplicate keys, missing files and circles of `extends` go to
/// `problems`.
Raw read_yaml(const std::string& text, const std::filesystem::path& file, Problems& problems);
Raw read_yaml_file(const std::filesystem::path& file, Problems& problems);

/// Sets `path.to.key=value`, where the value is YAML.
void apply_override(Raw& root, const std::string& assignment, Problems& problems);

}  // namespace carus::scenario
