// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include <initializer_list>
#include <nlohmann/json.hpp>

#include "carus/core/error.hpp"
#include "carus/scenario/bind.hpp"
#include "carus/scenario/schema.hpp"
#include "carus/scenario/settings.hpp"
#include "carus/scenario/text.hpp"
#include "carus/scenario/units.hpp"

namespace carus::scenario {

namespace {

/// Collects settings from the members of a scenario.
struct Collector {
  Settings settings;

  void operator()(const std::string& path, const double& x) { settings.values[path] = x; }
  void operator()(const std::string& path, const int& x) { settings.values[path] = static_cast<double>(x); }
  void operator()(const std::string& path, const bool& x) { settings.values[path] = x; }
  void operator()(const std::string& path, const std::string& x) { settings.values[path] = x; }

  template <class E>
  void choice(const std::string& path, const E& x, std::initializer_list<std::pair<const char*, E>> names) {
    for (const auto& [name, value] : names)
      if (value == x) settings.values[path] = std::string(name);
  }

  template <class T, class Item>
  void list(const std::string& path, std::vector<T>& x, const Item& item) {
    settings.sizes[path] = x.size();
    for (std::size_t i = 0; i < x.size(); ++i) item(fmt::format("{}[{}]", path, i), x[i]);
  }
};

class Emitter {
 public:
  explicit Emitter(const Settings& settings) : settings_(settings) {}

  void object(const Key& key, const std::string& path, std::size_t depth) {
    const std::string indent(2 * depth, ' ');
    for (const Key& child : key.children) {
      if (path.empty() && child.name == "extends") continue;  // all that was inherited is here
      if (path.empty() && child.name == "kind") {
        text_ += fmt::format("kind: {}\n", child.fallback);
        continue;
      }
      const std::string below = path.empty() ? child.name : path + "." + child.name;
      if (child.type == Type::object) {
        text_ += fmt::format("{}{}:\n", indent, child.name);
        object(child, below, depth + 1);
      } else {
        text_ += fmt::format("{}{}: {}\n", indent, child.name,
                             child.type == Type::array ? list(child, below) : value(child, below));
      }
    }
  }

  [[nodiscard]] const std::string& text() const { return text_; }

  [[nodiscard]] std::string value(const Key& key, const std::string& path) const {
    const auto& v = settings_.values.at(path);
    switch (key.type) {
      case Type::text:
        return nlohmann::json(std::get<std::string>(v)).dump();  // a JSON string is a YAML string
      case Type::choice:
        return std::get<std::string>(v);
      case Type::boolean:
        return std::get<bool>(v) ? "true" : "false";
      case Type::integer:
      case Type::number:
        return format_number(std::get<double>(v));
      case Type::quantity:
        return format_quantity(std::get<double>(v), key.unit);
      case Type::object:
      case Type::array:
        break;
    }
    CARUS_ASSERT(false);
  }

 private:
  /// Flow style: [{g: 0.5, tau: 150 s}], [1 mm, 2 mm, 3 mm].
  [[nodiscard]] std::string list(const Key& key, const std::string& path) const {
    std::vector<std::string> items;
    for (std::size_t i = 0; i < settings_.sizes.at(path); ++i)
      items.push_back(flow(key.children.front(), fmt::format("{}[{}]", path, i)));
    return fmt::format("[{}]", enumerated(items));
  }

  [[nodiscard]] std::string flow(const Key& key, const std::string& path) const {
    if (key.type == Type::array) return list(key, path);
    if (key.type != Type::object) return value(key, path);
    std::vector<std::string> members;
    for (const Key& child : key.children)
      members.push_back(fmt::format("{}: {}", child.name, flow(child, path + "." + child.name)));
    return fmt::format("{{{}}}", enumerated(members));
  }

  const Settings& settings_;
  std::string text_;
};

}  // namespace

std::map<std::string, std::string> anatomy_settings(const Scenario& scenario) {
  Scenario copy = scenario;
  Collector collector;
  bind_resolution(collector, copy);
  bind_anatomy(collector, copy.anatomy);
  const Emitter emitter(collector.settings);
  std::map<std::string, std::string> out;
  for (const Leaf& leaf : leaves(schema()))
    if (collector.settings.values.contains(leaf.path)) out[leaf.path] = emitter.value(*leaf.key, leaf.path);
  return out;
}

std::string settings_yaml(const Settings& settings, const Key& keys) {
  Emitter emitter(settings);
  emitter.object(keys, "", 0);
  return emitter.text();
}

std::string resolved_yaml(const Scenario& scenario) {
  Scenario copy = scenario;  // a visitor may write; this one only reads
  Collector collector;
  bind(collector, copy);
  return settings_yaml(collector.settings, schema());
}

}  // namespace carus::scenario
