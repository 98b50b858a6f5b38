// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include "carus/scenario/schema.hpp"
#include "carus/scenario/units.hpp"

namespace carus::scenario {

namespace {

std::string cell(const std::string& text) {
  std::string out;
  for (const char c : text) out += c == '|' ? std::string("\\|") : std::string(1, c);
  return out;
}

std::string row(const Key& key, const std::string& name) {
  const std::string validity = key.validity ? fmt::format("{}–{} ({})", format_number(key.validity->minimum),
                                                          format_number(key.validity->maximum), key.validity->source)
                                            : "";
  return fmt::format("| `{}` | {} | {} | {} | {} |\n", name,
                     key.fallback.empty() ? "" : fmt::format("`{}`", key.fallback), cell(allowed(key)), cell(validity),
                     cell(key.description));
}

void rows(const Key& key, const std::string& name, std::string& out) {
  for (const Key& child : key.children) {
    const std::string below = name.empty() ? child.name : name + "." + child.name;
    if (child.type == Type::object)
      rows(child, below, out);
    else if (child.type == Type::array && child.children.front().type == Type::object)
      rows(child.children.front(), below + "[]", out);
    else if (child.type == Type::array)
      out += fmt::format("| `{}[]` |  | {} |  | {} |\n", below, cell(allowed(child.children.front())),
                         cell(child.description));
    else
      out += row(child, below);
  }
}

constexpr const char* head = "| key | default | allowed | covered by its source | what |\n|---|---|---|---|---|\n";

/// Regions differ only in their defaults: one table of forms, one of values.
void materials(const Key& key, std::string& out) {
  out += fmt::format("{}\n\n{}", key.description, head);
  rows(key.children.front(), "REGION", out);
  out +=
      "\nDefaults by region, where they differ from the first one's:\n\n| region | defaults | what |\n|---|---|---|\n";
  const std::vector<Leaf> first = leaves(key.children.front());
  for (const Key& region : key.children) {
    const std::vector<Leaf> own = leaves(region);
    std::string values;
    for (std::size_t i = 0; i < own.size(); ++i)
      if (&region == &key.children.front() ? own[i].path == "c10" : own[i].key->fallback != first[i].key->fallback)
        values += fmt::format("{}{} `{}`", values.empty() ? "" : ", ", own[i].path, own[i].key->fallback);
    out += fmt::format("| `{}` | {} | {} |\n", region.name, values, cell(region.description));
  }
}

}  // namespace

namespace {

std::string markdown(const Key& root, const std::string& intro) {
  std::string out = intro + root.description + "\n\n## Top level\n\n" + head;
  for (const Key& section : root.children)
    if (section.type != Type::object && section.type != Type::array) out += row(section, section.name);
  for (const Key& section : root.children) {
    if (section.type != Type::object && section.type != Type::array) continue;
    out += fmt::format("\n## {}\n\n", section.name);
    if (section.name == "materials") {
      materials(section, out);
      continue;
    }
    out += fmt::format("{}\n\n{}", section.description, head);
    if (section.type == Type::array)
      rows(section.children.front(), section.name + "[]", out);
    else
      rows(section, section.name, out);
  }
  return out;
}

}  // namespace

std::string schema_markdown() {
  return markdown(schema(), "# Scenario keys\n\nGenerated from `schema/scenario.schema.json`; do not edit. ");
}

std::string model_schema_markdown() {
  return markdown(model_schema(),
                  "# Keys of a general model\n\nGenerated from `schema/model.schema.json`; do not edit. ");
}

}  // namespace carus::scenario
