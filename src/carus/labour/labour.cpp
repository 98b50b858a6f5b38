// SPDX-License-Identifier: Apache-2.0
#include "carus/labour/labour.hpp"

#include <algorithm>
#include <cmath>

#include "carus/core/types.hpp"

namespace carus::labour {
namespace {

/// 0 at x <= 0, 1 at x >= 1, (1 - cos(pi x))/2 between: continuous with its slope.
double ramp(double x) { return 0.5 - 0.5 * std::cos(pi * std::clamp(x, 0.0, 1.0)); }

/// Time within the contraction under way [s]; negative before the first.
double phase(const Contractions& c, double t) { return t < c.first ? -1 : std::fmod(t - c.first, c.period); }

/// A plateau of 1 from `rise` to `duration - fall`. A fall that starts before the rise is over cuts it off, still
/// smoothly.
double bump(double x, double duration, double rise, double fall) {
  if (x <= 0 || x >= duration) return 0;
  return ramp(x / rise) * ramp((duration - x) / fall);
}

/// `efforts` bumps, one in the middle of each equal share of the plateau, ramped over a quarter of themselves.
double efforts_activity(const Push& p, const Contractions& c, double x) {
  const double share = (c.duration - c.rise - c.fall) / p.efforts;
  const double length = std::min(p.effort_duration, share);
  if (!(length > 0)) return 0;
  const double into = x - c.rise;
  const double number = std::clamp(std::floor(into / share), 0.0, double(p.efforts - 1));
  return bump(into - number * share - 0.5 * (share - length), length, 0.25 * length, 0.25 * length);
}

}  // namespace

double contraction_activity(const Contractions& c, double t) { return bump(phase(c, t), c.duration, c.rise, c.fall); }

double contraction_pressure(const Contractions& c, double t) {
  return c.base + c.amplitude * contraction_activity(c, t);
}

double push_pressure(const Push& p, const Contractions& c, double t) {
  if (!p.enabled) return 0;
  return p.amplitude * (p.efforts > 1 ? efforts_activity(p, c, phase(c, t)) : contraction_activity(c, t));
}

double tone_pressure(const ResidualTone& tone, double /*t*/) { return tone.enabled ? tone.pressure : 0; }

int contractions_begun(const Contractions& c, double t) {
  return t < c.first ? 0 : 1 + static_cast<int>(std::floor((t - c.first) / c.period));
}

}  // namespace carus::labour
