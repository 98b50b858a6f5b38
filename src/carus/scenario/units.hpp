// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string>
#include <string_view>

namespace carus::scenario {

/// A unit that scenario files may write: a value in it times `factor` is SI.
struct Unit {
  std::string_view symbol, dimension;
  double factor;
};

/// The unit of that symbol or null. Blanks and middle dots do not matter: "N m/rad" is "Nm/rad".
const Unit* find_unit(std::string_view symbol);

/// All symbols of a dimension, e.g. "m, cm, mm".
std::string symbols_of(std::string_view dimension);

/// A decimal number followed by text (a unit, or nothing). Infinite and NaN are numbers here; the caller refuses them.
struct NumberAndUnit {
  double number;
  std::string unit;
};
std::optional<NumberAndUnit> split_quantity(std::string_view text);

/// The shortest text in `unit` that reads back to exactly `si`; in the SI unit of its dimension where that unit has
/// none.
std::string format_quantity(double si, std::string_view unit);
std::string format_number(double value);  ///< shortest text that reads back to the same double

}  // namespace carus::scenario
