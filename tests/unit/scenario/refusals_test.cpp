// SPDX-License-Identifier: Apache-2.0
// What schema_test.cpp does not derive from the schema: values of the wrong shape, quoted numbers, silence after a
// colon, misspelt keys at every path. Messages are built here from the schema's text alone.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <map>

#include "carus/core/error.hpp"
#include "carus/scenario/scenario.hpp"
#include "carus/scenario/schema.hpp"

namespace carus::scenario {
namespace {

using Messages = std::vector<std::string>;

Messages problems(const std::string& yaml, const Messages& overrides = {}) {
  try {
    parse(yaml, "s.yaml", overrides);
    return {};
  } catch (const InputError& error) {
    return error.problems();
  }
}

/// All maps and lists below a key, by their path; those inside lists' items are left out.
void collect(const Key& key, const std::string& path, std::map<std::string, const Key*>& out) {
  if (!path.empty() && (key.type == Type::object || key.type == Type::array)) out[path] = &key;
  if (key.type != Type::object) return;
  for (const Key& child : key.children) collect(child, path.empty() ? child.name : path + "." + child.name, out);
}
std::map<std::string, const Key*> maps_and_lists() {
  std::map<std::string, const Key*> out;
  collect(schema(), "", out);
  return out;
}

std::string keys_of(const Key& key) {
  std::string out = "the keys ";
  for (const Key& child : key.children) out += (&child == &key.children.front() ? "" : ", ") + child.name;
  return out;
}

TEST(Refusals, EveryMapAndListRefusesOtherShapes) {
  const auto all = maps_and_lists();
  EXPECT_GT(all.size(), 30u);
  for (const auto& [path, key] : all) {
    const bool map = key->type == Type::object;
    const std::string should = map ? "is not a map; allowed " + keys_of(*key)
                                   : "is not a list; allowed a list of items with " + keys_of(key->children.front());
    const std::string hint = fmt::format("; write it below {}, indented", path);
    EXPECT_EQ(problems("", {path + "=3"}), Messages{fmt::format("--set: {}: \"3\" {}{}", path, should, hint)});
    EXPECT_EQ(problems("", {path + "="}), Messages{fmt::format("--set: {}: nothing {}{}", path, should, hint)});
    EXPECT_EQ(problems("", {path + (map ? "=[1]" : "={a: 1}")}),
              Messages{fmt::format("--set: {}: a {} {}{}", path, map ? "list" : "map", should, hint)});
  }
}

TEST(Refusals, EveryItemOfAListRefusesUnknownKeys) {
  for (const auto& [path, key] : maps_and_lists()) {
    if (key->type != Type::array) continue;
    const auto found = problems("", {path + "=[{qqqq: 1}]"});
    ASSERT_EQ(found.size(), 1u) << path;
    EXPECT_EQ(found[0].find(fmt::format("--set: {}[0].qqqq: unknown key; did you mean ", path)), 0u) << found[0];
  }
}

const char* noun(const Key& key) {
  switch (key.type) {
    case Type::text:
      return "text";
    case Type::choice:
      return "one of the choices";
    case Type::boolean:
      return "a boolean";
    case Type::integer:
      return "an integer";
    case Type::number:
      return "a number";
    default:
      return "a quantity";
  }
}

TEST(Refusals, EveryValueRefusesSilenceListsAndMaps) {
  std::size_t cases = 0;
  for (const Leaf& leaf : leaves(schema())) {
    if (leaf.path == "extends" || leaf.path.find("[]") != std::string::npos) continue;
    const Key& key = *leaf.key;
    for (const auto& [value, shown] : {std::pair{"", "nothing"}, {"[1]", "a list"}, {"{a: 1}", "a map"}}) {
      EXPECT_EQ(problems("", {leaf.path + "=" + value}),
                Messages{fmt::format("--set: {}: {} is not {}; allowed {}; the default is \"{}\"", leaf.path, shown,
                                     noun(key), allowed(key), key.fallback)});
      ++cases;
    }
  }
  EXPECT_GT(cases, 400u);
}

TEST(Refusals, ANumberOrBooleanInQuotesIsText) {
  for (const Leaf& leaf : leaves(schema())) {
    const Key& key = *leaf.key;
    if (leaf.path.find("[]") != std::string::npos) continue;
    if (key.type != Type::boolean && key.type != Type::integer && key.type != Type::number) continue;
    EXPECT_EQ(problems("", {fmt::format("{}='{}'", leaf.path, key.fallback)}),
              Messages{fmt::format("--set: {}: \"{}\" is not {}; allowed {}; the default is \"{}\"", leaf.path,
                                   key.fallback, noun(key), allowed(key), key.fallback)});
  }
}

/// A letter left out of the name: the key itself is proposed.
TEST(Refusals, EveryMisspeltKeyFindsItself) {
  for (const Leaf& leaf : leaves(schema())) {
    if (leaf.path.find("[]") != std::string::npos) continue;
    const std::size_t name = leaf.path.rfind('.') + 1;  // npos + 1 is 0
    if (leaf.path.size() - name < 4) continue;          // of k1, a letter less is anything
    std::string wrong = leaf.path;
    wrong.erase(name + 1, 1);
    EXPECT_EQ(problems("", {wrong + "=1"}),
              Messages{fmt::format("--set: {}: unknown key; did you mean {}?", wrong, leaf.path)});
  }
}

TEST(Refusals, AFileNamesItsOwnKeys) {
  const auto bounds = [](const std::string& path) {
    for (const Leaf& leaf : leaves(schema()))
      if (leaf.path == path)
        return fmt::format("allowed {}; the default is \"{}\"", allowed(*leaf.key), leaf.key->fallback);
    return "no key " + path;
  };
  EXPECT_EQ(
      problems("attachments: {canal_bed: {posterior: 5 kPa, laterall: 1 kPa/mm}, canal_blocked: maybe}\n"
               "anatomy: {form: meshes}\n"),
      (Messages{"s.yaml: anatomy.form: unknown key; did you mean anatomy.from?",
                "s.yaml: attachments.canal_bed.laterall: unknown key; did you mean attachments.canal_bed.lateral?",
                "s.yaml: attachments.canal_bed.posterior: \"5 kPa\" has the unit kPa, not one of bed "
                "stiffness (one of Pa/m, kPa/mm); " +
                    bounds("attachments.canal_bed.posterior"),
                "s.yaml: attachments.canal_blocked: \"maybe\" is not a boolean; allowed true or false; the "
                "default is \"true\""}));
}

TEST(Refusals, RelationsBetweenKeysThatNoOtherTestNames) {
  EXPECT_EQ(problems("fetus: {suboccipitobregmatic: 119 mm}\n"),
            Messages{"s.yaml: fetus.suboccipitobregmatic: 119 mm contradicts other keys; allowed at most 116 mm; the "
                     "occipitofrontal diameter is the longest of the three: raise fetus.occipitofrontal"});
  EXPECT_EQ(problems("materials: {skull: {law: hooke_small_strain}}\n"),
            Messages{"s.yaml: materials.skull.youngs_modulus: 0 kPa contradicts other keys; allowed above 0 kPa; "
                     "Hooke's law needs it"});
  EXPECT_EQ(problems("materials: {skull: {law: mooney_rivlin, c10: 0 kPa}}\n"),
            Messages{"s.yaml: materials.skull.c10: 0 kPa contradicts other keys; allowed above 0 kPa; neo-Hooke and "
                     "Mooney-Rivlin need it"});
}

}  // namespace
}  // namespace carus::scenario
