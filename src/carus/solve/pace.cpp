// SPDX-License-Identifier: Apache-2.0
#include "carus/solve/pace.hpp"

#include <algorithm>
#include <cmath>

#include "carus/core/error.hpp"

namespace carus::solve {

namespace {

// A rung doubles the kinetic energy; what has just been slow enough is not to be hurried until little moves.
constexpr double room_to_rise = 16;

}  // namespace

Pace::Pace(const PaceOptions& options) : ratio_(options.kinetic_ratio) {
  CARUS_ASSERT(options.slowest > 0 && options.slowest <= 1 && options.fastest >= 1 && options.kinetic_ratio > 0);
  constexpr double hair = 1e-9;  // sqrt(2) and its powers are not exact
  lowest_ = int(std::ceil(2 * std::log2(options.slowest) - hair));
  highest_ = int(std::floor(2 * std::log2(options.fastest) + hair));
}

double Pace::factor() const { return std::exp2(0.5 * rung_); }

bool Pace::judge(double kinetic, double internal, bool steady) {
  const double excess = kinetic > 0 ? kinetic / (ratio_ * std::max(internal, 0.0)) : 0;
  int rung = steady ? rung_ : std::min(rung_, 0);
  if (excess > 1) {
    rung -= int(std::min(64.0, std::ceil(std::log2(excess))));
  } else if (excess < 1 / room_to_rise && (steady || rung < 0)) {
    ++rung;
  }
  rung = std::clamp(rung, lowest_, highest_);
  if (rung == rung_) return false;
  rung_ = rung;
  return true;
}

}  // namespace carus::solve
