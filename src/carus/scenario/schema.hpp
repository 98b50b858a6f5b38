// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string>
#include <vector>

namespace carus::scenario {

enum class Type { object, array, text, choice, boolean, integer, number, quantity };

/// What a source covers; a value outside is a warning.
struct Validity {
  double minimum, maximum;  ///< in the key's unit
  std::string source;
};

/// One key of schema/scenario.schema.json, its only description.
struct Key {
  std::string name;
  Type type = Type::object;
  std::string description;
  std::string unit;                 ///< of a quantity: bounds are stated in it
  double minimum = 0, maximum = 0;  ///< physical bounds of integers, numbers and quantities, inclusive
  std::optional<Validity> validity;
  std::string fallback;  ///< the default, as a scenario file would write it
  std::vector<std::string> choices;
  std::vector<Key> children;  ///< of an object its keys in the schema's order, of an array the one form of its items
};

const Key& schema();        ///< of a birth, built once from the embedded file; thread-safe
const char* schema_json();  ///< its text
const Key& model_schema();  ///< of a general model: schema/model.schema.json
const char* model_schema_json();

/// "30 mm to 80 mm", "true or false", "OA, LOA, ...": what a message and the reference call allowed.
std::string allowed(const Key& key);

/// All keys that hold a value, by their path ("loads.push.amplitude"; items of arrays as "materials.skull.prony[].g").
struct Leaf {
  std::string path;
  const Key* key;
};
std::vector<Leaf> leaves(const Key& root);

/// The known key nearest to an unknown one: by edit distance of the whole path, or of the name with siblings preferred.
std::string nearest_key(const std::string& path, const Key& root = schema());
/// The nearest of some words.
std::string nearest_word(const std::string& word, const std::vector<std::string>& words);

/// docs/reference/scenario.md: every key with unit, bounds, default and source.
std::string schema_markdown();
/// docs/reference/model.md: the same of a general model.
std::string model_schema_markdown();

}  // namespace carus::scenario
