// SPDX-License-Identifier: Apache-2.0
#pragma once

namespace carus::units {

inline constexpr double mm = 1e-3;                             ///< m
inline constexpr double kPa = 1e3;                             ///< Pa
inline constexpr double mmHg = 133.322387;                     ///< Pa
inline constexpr double deg = 3.14159265358979323846 / 180.0;  ///< rad
inline constexpr double minute = 60.0;                         ///< s

}  // namespace carus::units
