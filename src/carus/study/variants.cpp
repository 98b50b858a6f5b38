// SPDX-License-Identifier: Apache-2.0
#include "carus/study/variants.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <cmath>
#include <sstream>

#include "carus/core/error.hpp"
#include "carus/results/checkpoint.hpp"
#include "carus/scenario/raw.hpp"
#include "carus/scenario/schema.hpp"
#include "carus/scenario/text.hpp"
#include "carus/scenario/units.hpp"

namespace carus::study {
namespace {

namespace fs = std::filesystem;
using scenario::Problems;
using scenario::Raw;

/// Says what is wrong with one row of a file.
class RowReader {
 public:
  RowReader(fs::path file, Problems& problems) : file_(std::move(file)), problems_(problems) {}

  Variant read(const Raw& raw, std::size_t index) {
    Variant v;
    where_ = fmt::format("variants[{}]", index);
    if (raw.kind != Raw::Kind::map) {
      refuse("is not a map; allowed {name: ..., set: [key=value, ...], scenario: FILE}");
      return v;
    }
    if (const Raw* name = raw.find("name"); name != nullptr && name->kind == Raw::Kind::scalar) v.name = name->text;
    if (v.name.empty()) {
      refuse("has no name; allowed letters, digits, _ and -");
    } else {
      where_ += fmt::format(" ({})", v.name);
      check_name(v.name);
    }
    static const std::vector<std::string> keys{"name", "set", "scenario"};
    for (const auto& [key, value] : raw.map) {
      if (std::find(keys.begin(), keys.end(), key) == keys.end())
        refuse(fmt::format("unknown key {}; did you mean {}?", key, scenario::nearest_word(key, keys)));
    }
    if (const Raw* set = raw.find("set")) read_set(*set, v);
    if (const Raw* other = raw.find("scenario")) read_scenario(*other, v);
    if (raw.find("set") == nullptr && raw.find("scenario") == nullptr)
      refuse("changes nothing; allowed set: [key=value, ...] or scenario: FILE");
    return v;
  }

 private:
  void refuse(const std::string& what) { problems_.push_back(fmt::format("{}: {}: {}", file_.string(), where_, what)); }

  void check_name(const std::string& name) {
    const bool plain =
        std::all_of(name.begin(), name.end(), [](unsigned char c) { return std::isalnum(c) || c == '_' || c == '-'; });
    if (!plain) refuse("the name is a folder's; allowed letters, digits, _ and -");
    if (name == base_row) refuse("the name is taken by the scenario itself; choose another");
    if (std::find(names_.begin(), names_.end(), name) != names_.end())
      refuse("name given twice; each row has a folder of its own; choose another");
    names_.push_back(name);
  }

  void read_set(const Raw& set, Variant& v) {
    if (set.kind != Raw::Kind::list) return refuse("set is not a list; allowed [key=value, ...]");
    for (const Raw& item : set.list) {
      if (item.kind != Raw::Kind::scalar || item.text.find('=') == std::string::npos)
        refuse(fmt::format("set: \"{}\" is not an assignment; allowed path.to.key=value or path.to.key*=factor",
                           item.text));
      else
        v.set.push_back(item.text);
    }
  }

  void read_scenario(const Raw& other, Variant& v) {
    if (other.kind != Raw::Kind::scalar || other.text.empty())
      return refuse("scenario is not a file's name; allowed a YAML file, relative to this one");
    v.scenario = (file_.parent_path() / other.text).lexically_normal();
  }

  fs::path file_;
  Problems& problems_;
  std::string where_;
  std::vector<std::string> names_;
};

/// `key*=factor` as the assignment that it means for a scenario.
std::string multiplied(const std::string& assignment, std::size_t star, const scenario::Scenario& s) {
  const std::string path = assignment.substr(0, star), factor_text = assignment.substr(star + 2);
  const auto factor = scenario::split_quantity(factor_text);
  if (!factor || !factor->unit.empty() || !std::isfinite(factor->number))
    throw InputError(fmt::format("{}: \"{}\" is not a number; allowed path.to.key*=factor", assignment, factor_text));
  Problems problems;
  const Raw root = scenario::read_yaml(scenario::resolved_yaml(s), "resolved.yaml", problems);
  const Raw* at = &root;
  std::istringstream keys(path);
  for (std::string key; at != nullptr && std::getline(keys, key, '.');) at = at->find(key);
  if (at == nullptr)
    throw InputError(fmt::format("{}: unknown key; did you mean {}?", path, scenario::nearest_key(path)));
  const auto value = at->kind == Raw::Kind::scalar ? scenario::split_quantity(at->text) : std::nullopt;
  if (!value)
    throw InputError(fmt::format(
        "{}: \"{}\" cannot be multiplied; allowed keys with a number or quantity; write {}=...", path, at->text, path));
  const std::string product = scenario::format_number(value->number * factor->number);
  return fmt::format("{}={}{}{}", path, product, value->unit.empty() ? "" : " ", value->unit);
}

scenario::Scenario resolve(const fs::path& file, std::vector<std::string> settings,
                           const std::vector<std::string>& own) {
  for (const std::string& assignment : own) {
    const std::size_t star = assignment.find("*=");
    const bool multiplies = star != std::string::npos && star < assignment.find('=');
    settings.push_back(multiplies ? multiplied(assignment, star, scenario::load(file, settings)) : assignment);
  }
  return scenario::load(file, settings);
}

}  // namespace

std::vector<Variant> read_variants(const fs::path& file) {
  Problems problems;
  const Raw root = scenario::read_yaml_file(file, problems);
  if (!problems.empty()) throw InputError(problems);
  static const std::vector<std::string> keys{"description", "variants"};
  for (const auto& [key, value] : root.map) {
    if (std::find(keys.begin(), keys.end(), key) == keys.end())
      problems.push_back(
          fmt::format("{}: {}: unknown key; did you mean {}?", file.string(), key, scenario::nearest_word(key, keys)));
  }
  std::vector<Variant> variants;
  const Raw* list = root.find("variants");
  if (list == nullptr || list->kind != Raw::Kind::list || list->list.empty()) {
    problems.push_back(
        fmt::format("{}: variants: no rows; allowed a list of {{name: ..., set: [key=value, ...]}}", file.string()));
  } else {
    RowReader reader(file, problems);
    for (std::size_t i = 0; i < list->list.size(); ++i) variants.push_back(reader.read(list->list[i], i));
  }
  if (!problems.empty()) throw InputError(problems);
  return variants;
}

fs::path find_variants(const std::string& name, const fs::path& scenario) {
  if (fs::path(name).extension() == ".yaml") return name;
  const fs::path folder = scenario.parent_path() / "studies", file = folder / (name + ".yaml");
  if (fs::exists(file)) return file;
  std::vector<std::string> known;
  if (fs::is_directory(folder)) {
    for (const auto& entry : fs::directory_iterator(folder))
      if (entry.path().extension() == ".yaml") known.push_back(entry.path().stem());
  }
  std::sort(known.begin(), known.end());
  throw InputError(fmt::format(
      "--variants: \"{}\" is no set of variants; allowed {}; or name a file that ends in .yaml", name,
      known.empty() ? fmt::format("none, \"{}\" has no sets", folder.string()) : scenario::enumerated(known)));
}

std::vector<Row> rows_of(const fs::path& file, const std::vector<std::string>& overrides,
                         const std::vector<Variant>& variants) {
  std::vector<Row> rows{{.name = base_row, .set = {}, .scenario = scenario::load(file, overrides), .same_as = {}}};
  std::vector<std::string> hashes{results::hash_of(rows[0].scenario)};
  Problems problems;
  for (const Variant& v : variants) {
    try {
      Row row{.name = v.name,
              .set = v.set,
              .scenario = resolve(v.scenario.empty() ? file : v.scenario, overrides, v.set),
              .same_as = {}};
      hashes.push_back(results::hash_of(row.scenario));
      const auto first = std::find(hashes.begin(), hashes.end(), hashes.back()) - hashes.begin();
      if (first < std::ptrdiff_t(rows.size())) row.same_as = rows[first].name;
      rows.push_back(std::move(row));
    } catch (const InputError& error) {
      for (const std::string& problem : error.problems())
        problems.push_back(fmt::format("row {}: {}", v.name, problem));
      continue;
    }
  }
  if (!problems.empty()) throw InputError(problems);
  return rows;
}

}  // namespace carus::study
