// SPDX-License-Identifier: Apache-2.0
#include "carus/scenario/settings.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "carus/core/error.hpp"
#include "carus/scenario/units.hpp"

namespace carus::scenario {

namespace {

const char* noun(Type type) {
  switch (type) {
    case Type::object:
      return "a map";
    case Type::array:
      return "a list";
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
    case Type::quantity:
      return "a quantity";
  }
  CARUS_ASSERT(false);
}

std::string shown(const Raw& raw) {
  switch (raw.kind) {
    case Raw::Kind::nothing:
      return "nothing";
    case Raw::Kind::list:
      return "a list";
    case Raw::Kind::map:
      return "a map";
    case Raw::Kind::scalar:
      return fmt::format("\"{}\"", raw.text);
  }
  CARUS_ASSERT(false);
}

class Settler {
 public:
  Settler(const Key& root, Settings& settings, Problems& problems, Problems& warnings)
      : root_(root), settings_(settings), problems_(problems), warnings_(warnings) {}

  /// `raw` is null where the user is silent.
  void settle(const Key& key, const std::string& path, const Raw* raw) {
    if (key.type == Type::object) return object(key, path, raw);
    if (key.type == Type::array) return array(key, path, raw);
    if (raw == nullptr) {
      const Raw fallback{.kind = Raw::Kind::scalar, .text = key.fallback, .file = "schema", .list = {}, .map = {}};
      return scalar(key, path, fallback, false);
    }
    settings_.files[path] = raw->file;
    scalar(key, path, *raw, true);
  }

 private:
  void refuse(const Key& key, const std::string& path, const Raw& raw, const std::string& what) {
    std::string hint;
    if (key.type == Type::object || key.type == Type::array)
      hint = fmt::format("write it below {}, indented", path.empty() ? "nothing" : path);
    else if (key.type == Type::choice && raw.kind == Raw::Kind::scalar)
      hint = fmt::format("did you mean \"{}\"?", nearest_word(raw.text, key.choices));
    else
      hint = fmt::format("the default is \"{}\"", key.fallback);
    problems_.push_back(fmt::format("{}: {}: {} {}; allowed {}; {}", raw.file, path.empty() ? "(whole file)" : path,
                                    shown(raw), what, allowed(key), hint));
  }

  void object(const Key& key, const std::string& path, const Raw* raw) {
    if (raw != nullptr && raw->kind != Raw::Kind::map) return refuse(key, path, *raw, "is not a map");
    const auto below = [&](const std::string& name) { return path.empty() ? name : path + "." + name; };
    if (raw != nullptr)
      for (const auto& [name, value] : raw->map)
        if (std::none_of(key.children.begin(), key.children.end(),
                         [&](const Key& child) { return child.name == name; }))
          problems_.push_back(fmt::format("{}: {}: unknown key; did you mean {}?", first_file(value), below(name),
                                          nearest_key(below(name), root_)));
    for (const Key& child : key.children)
      settle(child, below(child.name), raw == nullptr ? nullptr : raw->find(child.name));
  }

  /// A map made by --set has no file of its own: its first value's.
  static std::string first_file(const Raw& raw) {
    return raw.file.empty() && !raw.map.empty() ? first_file(raw.map.front().second) : raw.file;
  }

  void array(const Key& key, const std::string& path, const Raw* raw) {
    settings_.sizes[path] = raw == nullptr ? 0 : raw->list.size();
    if (raw == nullptr) return;
    if (raw->kind != Raw::Kind::list) return refuse(key, path, *raw, "is not a list");
    for (std::size_t i = 0; i < raw->list.size(); ++i)
      settle(key.children.front(), fmt::format("{}[{}]", path, i), &raw->list[i]);
  }

  void scalar(const Key& key, const std::string& path, const Raw& raw, bool by_user) {
    const std::string is_not = fmt::format("is not {}", noun(key.type));
    if (raw.kind != Raw::Kind::scalar) return refuse(key, path, raw, is_not);
    switch (key.type) {
      case Type::text:
        settings_.values[path] = raw.text;
        return;
      case Type::choice:
        if (std::find(key.choices.begin(), key.choices.end(), raw.text) == key.choices.end())
          return refuse(key, path, raw, is_not);
        settings_.values[path] = raw.text;
        return;
      case Type::boolean:
        if (raw.quoted || (raw.text != "true" && raw.text != "false")) return refuse(key, path, raw, is_not);
        settings_.values[path] = raw.text == "true";
        return;
      default:
        number(key, path, raw, by_user);
    }
  }

  void number(const Key& key, const std::string& path, const Raw& raw, bool by_user) {
    const auto parsed = split_quantity(raw.text);
    const bool quantity = key.type == Type::quantity;
    if (!parsed || (!quantity && (raw.quoted || !parsed->unit.empty())))
      return refuse(key, path, raw, fmt::format("is not {}", noun(key.type)));
    if (!std::isfinite(parsed->number)) return refuse(key, path, raw, "is not finite");
    double value = parsed->number, si = value;  // in the key's unit, and in SI
    if (quantity) {
      const Unit& own = *find_unit(key.unit);
      if (parsed->unit.empty())
        return refuse(key, path, raw, fmt::format("has no unit (one of {})", symbols_of(own.dimension)));
      const Unit* unit = find_unit(parsed->unit);
      if (unit == nullptr || unit->dimension != own.dimension)
        return refuse(key, path, raw,
                      fmt::format("has the unit {}, not one of {} (one of {})", parsed->unit, own.dimension,
                                  symbols_of(own.dimension)));
      si = parsed->number * unit->factor;
      if (unit->factor != own.factor) value = si / own.factor;
    }
    if (key.type == Type::integer && value != std::round(value)) return refuse(key, path, raw, "is not an integer");
    // Bounds include themselves, whatever the unit they are written in.
    const double slack = 1e-12 * std::max(std::abs(key.minimum), std::abs(key.maximum));
    if (value < key.minimum - slack || value > key.maximum + slack) return refuse(key, path, raw, "is out of range");
    if (by_user && key.validity && (value < key.validity->minimum - slack || value > key.validity->maximum + slack))
      warnings_.push_back(fmt::format("{}: {}: {} is outside what its source covers; {} to {} {} ({})", raw.file, path,
                                      shown(raw), format_number(key.validity->minimum),
                                      format_number(key.validity->maximum), key.unit, key.validity->source));
    settings_.values[path] = si;
  }

  const Key& root_;
  Settings& settings_;
  Problems& problems_;
  Problems& warnings_;
};

}  // namespace

Settings settle(const Raw& root, Problems& problems, Problems& warnings, const Key& keys) {
  Settings settings;
  Settler(keys, settings, problems, warnings).settle(keys, "", &root);
  return settings;
}

}  // namespace carus::scenario
