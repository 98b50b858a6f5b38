// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cmath>

namespace carus::contact {

/// Clamped logarithmic barrier (Li et al. 2020) on the distance itself, per area: with s = d/reach,
///
///     b(d) = -pressure reach (s - 1)^2 ln s  for 0 < s < 1, else 0;    C2 at s = 1, +inf as s -> 0.
///
/// At s = 1/2 two surfaces feel 1.2 times `pressure`, at 1/10 nearly 13 times.
struct Barrier {
  double reach;     ///< [m]
  double pressure;  ///< [Pa]

  [[nodiscard]] double value(double d) const {  ///< [J/m^2]; d > 0
    if (d >= reach) return 0;
    const double s = d / reach;
    return -pressure * reach * (s - 1) * (s - 1) * std::log(s);
  }
  [[nodiscard]] double first(double d) const {  ///< db/dd [Pa], <= 0
    if (d >= reach) return 0;
    const double s = d / reach;
    return -pressure * (2 * (s - 1) * std::log(s) + (s - 1) * (s - 1) / s);
  }
  [[nodiscard]] double second(double d) const {  ///< d2b/dd2 [Pa/m], >= 0
    if (d >= reach) return 0;
    const double s = d / reach;
    return pressure / reach * (-2 * std::log(s) - 4 * (s - 1) / s + (s - 1) * (s - 1) / (s * s));
  }
};

/// Fades a pair of edges out as they become parallel, where their distance has a kink: m = (2 - q) q with
/// q = |u x v|^2/(10^-3 |u0|^2 |v0|^2) below 1, else 1 (Li et al. 2020, eq. 25).
struct Mollifier {
  double threshold;  ///< [m^4]

  [[nodiscard]] double value(double cross2) const {
    const double q = cross2 / threshold;
    return q < 1 ? (2 - q) * q : 1;
  }
  [[nodiscard]] double first(double cross2) const {
    const double q = cross2 / threshold;
    return q < 1 ? 2 * (1 - q) / threshold : 0;
  }
};

/// Smoothed Coulomb friction: the potential whose derivative rises from 0 to 1 as the slip y grows to `full`:
/// f = y^2/full - y^3/(3 full^2) + full/3 below, y above (Li et al. 2020, eq. 29).
struct SmoothSlip {
  double full;  ///< [m] > 0

  [[nodiscard]] double value(double y) const {
    return y < full ? y * y / full - y * y * y / (3 * full * full) + full / 3 : y;
  }
  /// f'(y)/y, finite at 0.
  [[nodiscard]] double first_over_slip(double y) const { return y < full ? (2 - y / full) / full : 1 / y; }
};

}  // namespace carus::contact
