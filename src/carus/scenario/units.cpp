// SPDX-License-Identifier: Apache-2.0
#include "carus/scenario/units.hpp"

#include <fmt/format.h>

#include <array>
#include <charconv>
#include <cmath>
#include <limits>

#include "carus/core/error.hpp"
#include "carus/core/units.hpp"

namespace carus::scenario {

namespace {

// The first unit of a dimension is its SI unit.
constexpr std::array table{
    Unit{"m", "length", 1},
    Unit{"cm", "length", 1e-2},
    Unit{"mm", "length", units::mm},
    Unit{"rad", "angle", 1},
    Unit{"deg", "angle", units::deg},
    Unit{"s", "time", 1},
    Unit{"ms", "time", 1e-3},
    Unit{"us", "time", 1e-6},
    Unit{"min", "time", units::minute},
    Unit{"h", "time", 3600},
    Unit{"Pa", "pressure", 1},
    Unit{"kPa", "pressure", units::kPa},
    Unit{"MPa", "pressure", 1e6},
    Unit{"GPa", "pressure", 1e9},
    Unit{"mmHg", "pressure", units::mmHg},
    Unit{"kg/m^3", "density", 1},
    Unit{"g/cm^3", "density", 1e3},
    Unit{"Pa/m", "bed stiffness", 1},
    Unit{"kPa/mm", "bed stiffness", 1e6},
    Unit{"N/m", "stiffness", 1},
    Unit{"kN/m", "stiffness", 1e3},
    Unit{"N/mm", "stiffness", 1e3},
    Unit{"N m/rad", "rotational stiffness", 1},
    Unit{"N m/deg", "rotational stiffness", 1 / units::deg},
    Unit{"N m s/rad", "rotational damping", 1},
    Unit{"N m s/deg", "rotational damping", 1 / units::deg},
    Unit{"m/s", "speed", 1},
    Unit{"mm/s", "speed", units::mm},
    Unit{"m/s^2", "acceleration", 1},
    Unit{"1/s", "rate", 1},
    Unit{"1/min", "rate", 1 / units::minute},
};

std::string squeezed(std::string_view symbol) {
  std::string out;
  for (std::size_t i = 0; i < symbol.size(); ++i) {
    if (symbol[i] == ' ' || symbol[i] == '*') continue;
    if (symbol.substr(i, 2) == "·") {
      ++i;
      continue;
    }
    out += symbol[i];
  }
  return out;
}

/// Reads back exactly, in the way that the loader reads.
bool reads_back(const std::string& text, double factor, double si) {
  double number = 0;
  std::from_chars(text.data(), text.data() + text.size(), number);
  return number * factor == si;
}

}  // namespace

const Unit* find_unit(std::string_view symbol) {
  const std::string wanted = squeezed(symbol);
  for (const Unit& unit : table)
    if (squeezed(unit.symbol) == wanted) return &unit;
  return nullptr;
}

std::string symbols_of(std::string_view dimension) {
  std::string out;
  for (const Unit& unit : table)
    if (unit.dimension == dimension) out += (out.empty() ? "" : ", ") + std::string(unit.symbol);
  return out;
}

std::optional<NumberAndUnit> split_quantity(std::string_view text) {
  const auto trim = [](std::string_view s) {
    while (!s.empty() && s.front() == ' ') s.remove_prefix(1);
    while (!s.empty() && s.back() == ' ') s.remove_suffix(1);
    return s;
  };
  text = trim(text);
  if (text.starts_with('+')) text.remove_prefix(1);
  // YAML writes .inf and .nan; from_chars knows the words without the dot.
  std::string_view digits = text;
  const bool minus = digits.starts_with('-');
  if (minus) digits.remove_prefix(1);
  for (const std::string_view word : {".inf", ".Inf", ".INF", ".nan", ".NaN", ".NAN"})
    if (digits.starts_with(word)) {
      const double inf = std::numeric_limits<double>::infinity();
      const double value = (word[1] == 'n' || word[1] == 'N') ? std::nan("") : minus ? -inf : inf;
      return NumberAndUnit{value, std::string(trim(digits.substr(4)))};
    }
  double number = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), number);
  if (error == std::errc::invalid_argument) return std::nullopt;
  if (error == std::errc::result_out_of_range) number = std::numeric_limits<double>::infinity();  // 1e999
  return NumberAndUnit{number, std::string(trim(text.substr(end - text.data())))};
}

std::string format_number(double value) {
  for (int digits = 1; digits <= 17; ++digits) {
    std::string text = fmt::format("{:.{}g}", value, digits);
    // Plain decimals where they are as short: 1920 rather than 1.92e+03.
    if (text.find('e') != std::string::npos && std::abs(value) >= 1 && std::abs(value) < 1e15)
      text = fmt::format("{:.0f}", value);
    if (reads_back(text, 1, value)) return text;
  }
  return fmt::format("{}", value);
}

std::string format_quantity(double si, std::string_view symbol) {
  const Unit* unit = find_unit(symbol);
  CARUS_ASSERT(unit != nullptr);
  const double value = si / unit->factor;
  for (const double candidate : {value, std::nextafter(value, -HUGE_VAL), std::nextafter(value, HUGE_VAL)})
    for (int digits = 1; digits <= 17; ++digits) {
      double rounded = 0;
      const std::string text = fmt::format("{:.{}g}", candidate, digits);
      std::from_chars(text.data(), text.data() + text.size(), rounded);
      if (rounded * unit->factor == si) return fmt::format("{} {}", format_number(rounded), unit->symbol);
    }
  for (const Unit& other : table)
    if (other.dimension == unit->dimension) return fmt::format("{} {}", format_number(si), other.symbol);
  CARUS_ASSERT(false);
}

}  // namespace carus::scenario
