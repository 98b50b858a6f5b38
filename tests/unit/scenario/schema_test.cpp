// SPDX-License-Identifier: Apache-2.0
#include "carus/scenario/schema.hpp"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <set>

#include "carus/core/error.hpp"
#include "carus/scenario/scenario.hpp"
#include "carus/scenario/units.hpp"

namespace carus::scenario {
namespace {

/// One bad value of a key and what must be said of it.
struct Case {
  std::string value, message;
};

/// The bad values that a key's description in the schema implies. The messages are built here from the schema's text
/// alone.
std::vector<Case> bad_values(const Key& key) {
  const std::string unit = key.unit.empty() ? "" : " " + key.unit;
  const std::string range = fmt::format("allowed {}{} to {}{}; the default is \"{}\"", format_number(key.minimum), unit,
                                        format_number(key.maximum), unit, key.fallback);
  const auto out = [&](double value) {
    const std::string text = format_number(value) + unit;
    return Case{text, fmt::format("\"{}\" is out of range; {}", text, range)};
  };
  switch (key.type) {
    case Type::text:
      return {{"[1]", fmt::format("a list is not text; allowed any text; the default is \"{}\"", key.fallback)}};
    case Type::boolean:
      return {{"maybe",
               fmt::format("\"maybe\" is not a boolean; allowed true or false; the default is \"{}\"", key.fallback)}};
    case Type::choice: {
      std::string choices;
      for (const std::string& c : key.choices) choices += (choices.empty() ? "" : ", ") + c;
      const std::string wrong = key.choices.back() + "x";
      return {{wrong, fmt::format("\"{}\" is not one of the choices; allowed {}; did you mean \"{}\"?", wrong, choices,
                                  key.choices.back())}};
    }
    case Type::integer:
      return {out(key.minimum - 1),
              out(key.maximum + 1),
              {"1.5", "\"1.5\" is not an integer; " + range},
              {".inf", "\".inf\" is not finite; " + range}};
    case Type::number:
      return {out(key.minimum - 1),
              out(key.maximum + 1),
              {"much", "\"much\" is not a number; " + range},
              {".nan", "\".nan\" is not finite; " + range}};
    case Type::quantity: {
      const std::string dimension(find_unit(key.unit)->dimension), symbols = symbols_of(dimension);
      const std::string wrong = dimension == "time" ? "mm" : "s";
      return {out(key.minimum - 1),
              out(key.maximum + 1),
              {"1", fmt::format("\"1\" has no unit (one of {}); {}", symbols, range)},
              {"1 " + wrong, fmt::format("\"1 {}\" has the unit {}, not one of {} (one of {}); {}", wrong, wrong,
                                         dimension, symbols, range)},
              {".nan" + unit, fmt::format("\".nan{}\" is not finite; {}", unit, range)},
              {"much", "\"much\" is not a quantity; " + range}};
    }
    case Type::object:
    case Type::array:
      break;
  }
  ADD_FAILURE() << "not a leaf";
  return {};
}

/// The override that puts a value at a path: items of lists as a list of one.
std::string override_of(const std::string& path, const std::string& value) {
  const std::size_t item = path.find("[].");
  if (item == std::string::npos) return fmt::format("{}={}", path, value);
  return fmt::format("{}=[{{{}: {}}}]", path.substr(0, item), path.substr(item + 3), value);
}

TEST(Schema, EveryKeyRefusesBadValuesWithItsExactMessage) {
  std::size_t cases = 0;
  for (const Leaf& leaf : leaves(schema())) {
    const auto bad = bad_values(*leaf.key);
    EXPECT_FALSE(bad.empty()) << leaf.path;
    for (const Case& c : bad) {
      const std::size_t item = leaf.path.find("[]");
      const std::string path = item == std::string::npos
                                   ? leaf.path
                                   : fmt::format("{}[0]{}", leaf.path.substr(0, item), leaf.path.substr(item + 2));
      try {
        parse("", "s.yaml", {override_of(leaf.path, c.value)});
        ADD_FAILURE() << leaf.path << " took " << c.value;
      } catch (const InputError& error) {
        EXPECT_EQ(error.what(), fmt::format("--set: {}: {}", path, c.message));
      }
      ++cases;
    }
  }
  EXPECT_GT(cases, 800u);  // 190 keys or so, up to six cases each: the table did not shrink unnoticed
}

TEST(Schema, EveryKeyIsDescribedBoundedAndItsDefaultInside) {
  for (const Leaf& leaf : leaves(schema())) {
    const Key& key = *leaf.key;
    EXPECT_FALSE(key.description.empty()) << leaf.path;
    if (key.type == Type::integer || key.type == Type::number || key.type == Type::quantity) {
      EXPECT_LT(key.minimum, key.maximum) << leaf.path;
      if (key.validity) {
        EXPECT_LE(key.minimum, key.validity->minimum) << leaf.path;
        EXPECT_GE(key.maximum, key.validity->maximum) << leaf.path;
        EXPECT_FALSE(key.validity->source.empty()) << leaf.path;
      }
    }
    if (key.type == Type::quantity) {
      EXPECT_NE(find_unit(key.unit), nullptr) << leaf.path;
    }
  }
  EXPECT_NO_THROW(parse("", "s.yaml"));  // all defaults pass the schema
}

TEST(Schema, BoundsThemselvesAreAllowedInAnyUnit) {
  for (const char* radius : {"25 mm", "0.025 m", "2.5 cm", "80 mm", "8 cm", "0.08 m"})
    EXPECT_NO_THROW(parse("", "s.yaml", {std::string("canal.radius=") + radius})) << radius;
  EXPECT_THROW(parse("", "s.yaml", {"canal.radius=24.999999 mm"}), InputError);
}

/// Every key reaches a member and comes back: changing it changes exactly its line of the resolved scenario.
TEST(Schema, EveryKeyIsBoundToItsOwnMember) {
  const auto lines = [](const std::string& text) {
    std::vector<std::string> out(1);
    for (const char c : text)
      if (c == '\n')
        out.emplace_back();
      else
        out.back() += c;
    return out;
  };
  const auto before = lines(resolved_yaml(parse("", "s.yaml")));
  const std::vector<std::string> bones{"pelvis.surfaces.innominate_right", "pelvis.surfaces.innominate_left",
                                       "pelvis.surfaces.sacrum", "pelvis.surfaces.coccyx"};
  for (const Leaf& leaf : leaves(schema())) {
    const Key& key = *leaf.key;
    if (leaf.path == "extends" || leaf.path == "kind" || leaf.path == "solver.kind" ||
        leaf.path.find("[]") != std::string::npos)
      continue;
    // Those that name files, which are read: refused below.
    if (leaf.path == "pelvis.from" || std::find(bones.begin(), bones.end(), leaf.path) != bones.end()) continue;
    std::string value;
    switch (key.type) {
      case Type::text:
        value = "other";
        break;
      case Type::boolean:
        value = key.fallback == "true" ? "false" : "true";
        break;
      case Type::choice:
        value = key.fallback == key.choices.front() ? key.choices.back() : key.choices.front();
        break;
      default: {
        // A little off the default, on the side with more room, so that relations between keys hold.
        const double now = split_quantity(key.fallback)->number, span = key.maximum - key.minimum;
        double to = now + (now + 1e-3 * span < key.maximum ? 1e-3 : -1e-3) * span;
        if (key.type == Type::integer) to = now + 1;
        value = format_number(to) + (key.unit.empty() ? "" : " " + key.unit);
      }
    }
    std::vector<std::string> overrides{leaf.path + "=" + value};
    const std::string region = leaf.path.substr(0, leaf.path.rfind('.'));
    if (leaf.path.ends_with(".law") || leaf.path.ends_with(".c01")) continue;  // bound by a relation: below
    if (leaf.path.ends_with(".fibre.k1") && region.find("uter") == std::string::npos &&
        region.find("vaginal") == std::string::npos && region.find("lower") == std::string::npos)
      continue;  // refused outside the uterus
    const auto after = lines(resolved_yaml(parse("", "s.yaml", overrides)));
    ASSERT_EQ(after.size(), before.size());
    std::size_t changed = 0;
    for (std::size_t i = 0; i < before.size(); ++i)
      if (before[i] != after[i]) {
        ++changed;
        EXPECT_NE(after[i].find(key.name + ":"), std::string::npos) << leaf.path;
      }
    EXPECT_EQ(changed, 1u) << leaf.path << " = " << value;
  }
  EXPECT_THROW(parse("", "s.yaml", {"pelvis.from=other"}), InputError);
  for (const auto& bone : bones) {
    try {
      static_cast<void>(parse("", "s.yaml", {bone + "=other"}));
      ADD_FAILURE() << bone;
    } catch (const InputError& error) {
      EXPECT_NE(std::string(error.what()).find(bone + ": " + std::filesystem::absolute("other").string()),
                std::string::npos)
          << error.what();
    }
  }
  const Scenario s = parse("", "s.yaml", {"materials.skull.law=mooney_rivlin", "materials.skull.c01=2 kPa"});
  EXPECT_EQ(s.materials.at("skull").law, material::Law::mooney_rivlin);
  EXPECT_DOUBLE_EQ(s.materials.at("skull").c01, 2000);
}

TEST(Schema, UnknownKeysAreRefusedInEveryMap) {
  std::set<std::string> parents;
  for (const Leaf& leaf : leaves(schema())) {
    const std::size_t dot = leaf.path.rfind('.');
    parents.insert(dot == std::string::npos ? "" : leaf.path.substr(0, dot + 1));
  }
  for (const std::string& parent : parents) {
    if (parent.find("[]") != std::string::npos) continue;
    try {
      parse("", "s.yaml", {parent + "qqqq=1"});
      ADD_FAILURE() << parent;
    } catch (const InputError& error) {
      EXPECT_EQ(std::string(error.what()).find("--set: " + parent + "qqqq: unknown key; did you mean "), 0u)
          << error.what();
    }
  }
}

TEST(Units, QuantitiesReadBackExactly) {
  std::set<std::string> symbols{"mm", "kPa", "1/min"};
  for (const Leaf& leaf : leaves(schema()))
    if (!leaf.key->unit.empty()) symbols.insert(leaf.key->unit);
  for (const std::string& symbol : symbols)
    // 55/7 is no double times 1e6: of kPa/mm only Pa/m can write it.
    for (const double si :
         {0.0, 1.0 / 3, 1e-5, 12345.678, -0.0457, 6666.119350000001, std::nextafter(0.046, 1.0), 55.0 / 7}) {
      const std::string text = format_quantity(si, symbol);
      const auto parsed = split_quantity(text);
      ASSERT_TRUE(parsed) << text;
      EXPECT_EQ(parsed->number * find_unit(parsed->unit)->factor, si) << text;
    }
  EXPECT_EQ(format_quantity(0.0468, "mm"), "46.8 mm");
  EXPECT_EQ(format_quantity(1920, "s"), "1920 s");
}

}  // namespace
}  // namespace carus::scenario
