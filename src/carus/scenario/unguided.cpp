// SPDX-License-Identifier: Apache-2.0
#include "carus/scenario/unguided.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>

#include "carus/fem/constraints.hpp"

namespace carus::scenario {
namespace {

constexpr std::array fetal{"skull", "fetal_body", "fetal_skin", "neck"};
constexpr std::array uterine{"uterine_fundus", "uterine_body", "lower_segment", "vaginal_canal"};

template <class Names>
bool among(const Names& names, const std::string& name) {
  return std::any_of(names.begin(), names.end(), [&](const char* n) { return name == n; });
}

}  // namespace

std::vector<std::string> guided_fetus(const fem::Model& model) {
  const auto has = [&](const auto& names) {
    return std::any_of(model.regions.begin(), model.regions.end(), [&](const auto& r) { return among(names, r.name); });
  };
  if (!has(fetal) || !has(uterine)) return {};
  const auto held = fem::constrained_axes(model);
  std::vector<std::size_t> guided(model.regions.size(), 0);
  for (std::size_t e = 0; e < model.mesh.tets.size(); ++e) {
    for (const auto n : model.mesh.tets[e]) guided[std::size_t(model.mesh.labels[e])] += held[n] != 0;
  }
  std::vector<std::string> problems;
  for (std::size_t r = 0; r < model.regions.size(); ++r) {
    if (guided[r] > 0 && among(fetal, model.regions[r].name))
      problems.push_back(fmt::format(
          "the motion of \"{}\" is prescribed in a birth; allowed for everything but the fetus: its path must follow "
          "from forces and contact",
          model.regions[r].name));
  }
  return problems;
}

}  // namespace carus::scenario
