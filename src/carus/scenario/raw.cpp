// SPDX-License-Identifier: Apache-2.0
#include "carus/scenario/raw.hpp"

#include <fmt/format.h>
#include <yaml-cpp/yaml.h>

#include <algorithm>
#include <fstream>
#include <sstream>

namespace carus::scenario {

namespace {

namespace fs = std::filesystem;
using Chain = std::vector<fs::path>;  ///< the files that extend one another, for circles

Raw convert(const YAML::Node& node, const std::string& file, const std::string& path, Problems& problems) {
  Raw raw;
  raw.file = file;
  if (node.IsScalar()) {
    raw.kind = Raw::Kind::scalar;
    raw.text = node.Scalar();
    raw.quoted = node.Tag() == "!";
  } else if (node.IsSequence()) {
    raw.kind = Raw::Kind::list;
    for (std::size_t i = 0; i < node.size(); ++i)
      raw.list.push_back(convert(node[i], file, fmt::format("{}[{}]", path, i), problems));
  } else if (node.IsMap()) {
    raw.kind = Raw::Kind::map;
    for (const auto& entry : node) {
      const std::string key = entry.first.IsScalar() ? entry.first.Scalar() : "?";
      const std::string below = path.empty() ? key : path + "." + key;
      if (raw.find(key) != nullptr)
        problems.push_back(
            fmt::format("{}: {}: given twice; allowed once; delete line {}", file, below, entry.first.Mark().line + 1));
      else
        raw.map.emplace_back(key, convert(entry.second, file, below, problems));
    }
  }
  return raw;
}

/// `over` wins; maps are merged key by key, lists and values replaced.
void merge(Raw& base, Raw over) {
  if (base.kind != Raw::Kind::map || over.kind != Raw::Kind::map) {
    base = std::move(over);
    return;
  }
  for (auto& [key, value] : over.map) merge(base.at_or_add(key), std::move(value));
}

Raw read_file(const fs::path& file, const std::string& wanted_by, Chain chain, Problems& problems);

Raw read_text(const std::string& text, const fs::path& file, Chain chain, Problems& problems) {
  Raw raw;
  try {
    raw = convert(YAML::Load(text), file.string(), "", problems);
  } catch (const YAML::Exception& error) {
    problems.push_back(
        fmt::format("{}: line {}, column {}: bad YAML: {}; write keys as \"key: value\", indented by spaces",
                    file.string(), error.mark.line + 1, error.mark.column + 1, error.msg));
    return raw;
  }
  if (raw.kind == Raw::Kind::nothing) raw.kind = Raw::Kind::map;  // an empty file: all defaults
  const Raw* extends = raw.find("extends");
  if (extends == nullptr || extends->kind != Raw::Kind::scalar || extends->text.empty()) return raw;
  Raw base = read_file(file.parent_path() / extends->text, fmt::format("{}: extends: ", file.string()),
                       std::move(chain), problems);
  if (base.kind == Raw::Kind::map)
    std::erase_if(base.map, [](const auto& e) { return e.first == "extends" || e.first == "name"; });
  merge(base, std::move(raw));
  return base;
}

Raw read_file(const fs::path& file, const std::string& wanted_by, Chain chain, Problems& problems) {
  Raw nothing;
  nothing.kind = Raw::Kind::map;
  if (fs::is_directory(file)) {
    problems.push_back(fmt::format("{}\"{}\" is a folder; allowed a YAML file", wanted_by, file.string()));
    return nothing;
  }
  std::ifstream stream(file);
  if (!stream) {
    problems.push_back(fmt::format("{}\"{}\" cannot be opened; allowed a readable YAML file; check the path", wanted_by,
                                   file.string()));
    return nothing;
  }
  const fs::path canonical = fs::weakly_canonical(file);
  if (std::find(chain.begin(), chain.end(), canonical) != chain.end()) {
    problems.push_back(fmt::format("{}\"{}\" extends itself; allowed a chain that ends", wanted_by, file.string()));
    return nothing;
  }
  chain.push_back(canonical);
  std::ostringstream text;
  text << stream.rdbuf();
  return read_text(text.str(), file, std::move(chain), problems);
}

}  // namespace

const Raw* Raw::find(const std::string& key) const {
  const auto it = std::find_if(map.begin(), map.end(), [&](const auto& e) { return e.first == key; });
  return it == map.end() ? nullptr : &it->second;
}

Raw& Raw::at_or_add(const std::string& key) {
  const auto it = std::find_if(map.begin(), map.end(), [&](const auto& e) { return e.first == key; });
  return it == map.end() ? map.emplace_back(key, Raw{}).second : it->second;
}

Raw read_yaml(const std::string& text, const fs::path& file, Problems& problems) {
  return read_text(text, file, {fs::weakly_canonical(file)}, problems);
}

Raw read_yaml_file(const fs::path& file, Problems& problems) { return read_file(file, "", {}, problems); }

void apply_override(Raw& root, const std::string& assignment, Problems& problems) {
  const std::size_t equals = assignment.find('=');
  if (equals == std::string::npos || equals == 0) {
    problems.push_back(fmt::format(
        "--set: \"{}\" is not an assignment; allowed path.to.key=value; write it like fetus.position=LOA", assignment));
    return;
  }
  Raw value;
  try {
    value = convert(YAML::Load(assignment.substr(equals + 1)), "--set", assignment.substr(0, equals), problems);
  } catch (const YAML::Exception& error) {
    problems.push_back(fmt::format(
        "--set: {}: bad YAML: {}; allowed a value such as 30 kPa, true or a list in brackets", assignment, error.msg));
    return;
  }
  Raw* at = &root;
  std::istringstream path(assignment.substr(0, equals));
  for (std::string key; std::getline(path, key, '.');) {
    if (at->kind != Raw::Kind::map)
      *at = Raw{.kind = Raw::Kind::map, .text = {}, .file = "--set", .list = {}, .map = {}};
    at = &at->at_or_add(key);
  }
  merge(*at, std::move(value));
}

}  // namespace carus::scenario
