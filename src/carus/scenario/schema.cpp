// SPDX-License-Identifier: Apache-2.0
#include "carus/scenario/schema.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <nlohmann/json.hpp>
#include <numeric>

#include "carus/core/error.hpp"
#include "carus/scenario/text.hpp"
#include "carus/scenario/units.hpp"

namespace carus::scenario {

namespace embedded {
extern const char* const scenario_schema;
extern const char* const model_schema;
}  // namespace embedded

namespace {

using Json = nlohmann::ordered_json;

/// How a scenario file would write a JSON default.
std::string written(const Json& value) {
  if (value.is_string()) return value.get<std::string>();
  if (value.is_number_float()) return format_number(value.get<double>());
  return value.dump();
}

Type type_of(const Json& node) {
  const std::string type = node.at("type");
  if (type == "object") return Type::object;
  if (type == "array") return Type::array;
  if (type == "boolean") return Type::boolean;
  if (type == "integer") return Type::integer;
  if (type == "number") return Type::number;
  CARUS_ASSERT(type == "string");
  return node.contains("x-unit") ? Type::quantity : node.contains("enum") ? Type::choice : Type::text;
}

/// `node` read as the key `name`; `override_default`, where not null, is the default of a $ref: it wins over the
/// referred one's.
Key compile(const Json& root, const std::string& name, const Json& node, const Json& override_default) {
  if (node.contains("$ref")) {
    // "#/definitions/x" of this file, or of the birth's, where the general model takes its materials from.
    const std::string reference = node.at("$ref");
    const std::string pointer = reference.substr(reference.find('#') + 1);
    Json referred = (reference.starts_with('#') ? root : Json::parse(schema_json())).at(Json::json_pointer(pointer));
    if (node.contains("description")) referred["description"] = node.at("description");
    return compile(root, name, referred, node.value("default", Json()));
  }
  Key key;
  key.name = name;
  key.type = type_of(node);
  key.description = node.value("description", "");
  key.unit = node.value("x-unit", "");
  key.minimum = node.value("minimum", 0.0);
  key.maximum = node.value("maximum", 0.0);
  if (node.contains("x-validity")) {
    const Json& v = node.at("x-validity");
    key.validity = Validity{v.at("minimum"), v.at("maximum"), v.at("source")};
  }
  const Json fallback = override_default.is_null() ? node.value("default", Json()) : override_default;
  if (key.type == Type::object) {
    for (const auto& [child, form] : node.at("properties").items())
      key.children.push_back(compile(root, child, form, fallback.is_null() ? Json() : fallback.value(child, Json())));
  } else if (key.type == Type::array) {
    key.children.push_back(compile(root, "", node.at("items"), Json()));
  } else {
    CARUS_ASSERT(!fallback.is_null());
    key.fallback = written(fallback);
    if (node.contains("enum")) key.choices = node.at("enum").get<std::vector<std::string>>();
  }
  return key;
}

/// Levenshtein distance.
std::size_t distance(const std::string& a, const std::string& b) {
  std::vector<std::size_t> row(b.size() + 1);
  std::iota(row.begin(), row.end(), 0);
  for (std::size_t i = 0; i < a.size(); ++i) {
    std::size_t diagonal = row[0];
    row[0] = i + 1;
    for (std::size_t j = 0; j < b.size(); ++j) {
      const std::size_t change = diagonal + (a[i] == b[j] ? 0 : 1);
      diagonal = row[j + 1];
      row[j + 1] = std::min({change, row[j] + 1, diagonal + 1});
    }
  }
  return row.back();
}

std::string join(const std::string& parent, const std::string& name) {
  return parent.empty() ? name : parent + "." + name;
}

void collect(const Key& key, const std::string& path, bool with_objects, std::vector<Leaf>& out) {
  if (key.type == Type::object) {
    if (with_objects && !path.empty()) out.push_back({path, &key});
    for (const Key& child : key.children) collect(child, join(path, child.name), with_objects, out);
  } else if (key.type == Type::array) {
    if (with_objects) out.push_back({path, &key});
    collect(key.children.front(), path + "[]", with_objects, out);
  } else {
    out.push_back({path, &key});
  }
}

}  // namespace

const char* schema_json() { return embedded::scenario_schema; }

const Key& schema() {
  static const Key root = [] {
    const Json json = Json::parse(schema_json());
    return compile(json, "", json, Json());
  }();
  return root;
}

const char* model_schema_json() { return embedded::model_schema; }

const Key& model_schema() {
  static const Key root = [] {
    const Json json = Json::parse(model_schema_json());
    return compile(json, "", json, Json());
  }();
  return root;
}

std::string allowed(const Key& key) {
  switch (key.type) {
    case Type::object: {
      std::vector<std::string> names;
      for (const Key& child : key.children) names.push_back(child.name);
      return "the keys " + enumerated(names);
    }
    case Type::array:
      return fmt::format("a list of items with {}", allowed(key.children.front()));
    case Type::text:
      return "any text";
    case Type::choice:
      return enumerated(key.choices);
    case Type::boolean:
      return "true or false";
    case Type::integer:
    case Type::number:
      return fmt::format("{} to {}", format_number(key.minimum), format_number(key.maximum));
    case Type::quantity:
      return fmt::format("{} {} to {} {}", format_number(key.minimum), key.unit, format_number(key.maximum), key.unit);
  }
  CARUS_ASSERT(false);
}

std::vector<Leaf> leaves(const Key& root) {
  std::vector<Leaf> out;
  collect(root, "", false, out);
  return out;
}

std::string nearest_key(const std::string& path, const Key& root) {
  std::string plain;  // without the indices of items
  for (bool index = false; const char c : path) {
    if (c == ']') index = false;
    if (!index) plain += c;
    if (c == '[') index = true;
  }
  const auto split = [](const std::string& p) {
    const std::size_t dot = p.rfind('.');
    return dot == std::string::npos ? std::pair{std::string(), p} : std::pair{p.substr(0, dot), p.substr(dot + 1)};
  };
  const auto [parent, name] = split(plain);
  std::vector<Leaf> known;
  collect(root, "", true, known);
  const std::string* best = nullptr;
  std::size_t least = 0;
  for (const Leaf& leaf : known) {
    const auto [its_parent, its_name] = split(leaf.path);
    // A name known elsewhere is worth two letters less than a sibling's.
    const std::size_t cost =
        std::min(distance(plain, leaf.path), distance(name, its_name) + (parent == its_parent ? 0 : 2));
    if (best == nullptr || cost < least) best = &leaf.path, least = cost;
  }
  return *best;
}

std::string nearest_word(const std::string& word, const std::vector<std::string>& words) {
  return *std::min_element(words.begin(), words.end(),
                           [&](const auto& a, const auto& b) { return distance(word, a) < distance(word, b); });
}

}  // namespace carus::scenario
