// SPDX-License-Identifier: Apache-2.0
// The schema is a valid JSON Schema in the eyes of an independent validator, and takes what Carus itself resolves.
// GCC 12 reports a false overlap inside valijson ("text" + std::string, GCC bug 105651).
#pragma GCC diagnostic ignored "-Wrestrict"

#include <fmt/format.h>
#include <gtest/gtest.h>
#include <yaml-cpp/yaml.h>

#include <nlohmann/json.hpp>
#include <valijson/adapters/nlohmann_json_adapter.hpp>
#include <valijson/schema.hpp>
#include <valijson/schema_parser.hpp>
#include <valijson/validator.hpp>

#include "carus/scenario/scenario.hpp"
#include "carus/scenario/schema.hpp"

namespace carus::scenario {
namespace {

using nlohmann::json;
using Adapter = valijson::adapters::NlohmannJsonAdapter;

json to_json(const YAML::Node& node) {
  if (node.IsMap()) {
    json out = json::object();
    for (const auto& entry : node) out[entry.first.Scalar()] = to_json(entry.second);
    return out;
  }
  if (node.IsSequence()) {
    json out = json::array();
    for (const auto& item : node) out.push_back(to_json(item));
    return out;
  }
  // A plain scalar that is JSON (true, 0.5) is that; all else is text.
  const json value = node.Tag() == "!" ? json(json::value_t::discarded) : json::parse(node.Scalar(), nullptr, false);
  return value.is_discarded() ? json(node.Scalar()) : value;
}

bool valid(const json& document) {
  const json text = json::parse(schema_json());
  valijson::Schema schema;
  valijson::SchemaParser(valijson::SchemaParser::kDraft7).populateSchema(Adapter(text), schema);
  valijson::Validator validator;
  return validator.validate(schema, Adapter(document), nullptr);
}

TEST(JsonSchema, AcceptsEveryResolvedScenario) {
  for (const char* file : {"reference.yaml", "paper_strict.yaml", "physiological.yaml"}) {
    const std::string path = fmt::format("{}/scenarios/{}", CARUS_SOURCE_DIR, file);
    const Scenario s = load(path);
    EXPECT_TRUE(valid(to_json(YAML::Load(resolved_yaml(s))))) << file;
    EXPECT_TRUE(valid(to_json(YAML::LoadFile(path)))) << file;
  }
}

TEST(JsonSchema, RefusesWhatCarusRefuses) {
  EXPECT_FALSE(valid({{"reslution", "paper"}}));
  EXPECT_FALSE(valid({{"resolution", "medium"}}));
  EXPECT_FALSE(valid({{"numerics", {{"safety", 2.0}}}}));
  EXPECT_FALSE(valid({{"canal", {{"radius", 46}}}}));  // a quantity is text with its unit
  EXPECT_FALSE(valid({{"materials", {{"skull", {{"c99", "1 kPa"}}}}}}));
}

}  // namespace
}  // namespace carus::scenario
