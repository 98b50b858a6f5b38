// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include "carus/core/types.hpp"

namespace carus::imaging {

/// Coordinates as a file has them: how long its unit is and where its axes point.
struct Convention {
  double unit;  ///< [m]
  Mat3 to_ras;  ///< a signed permutation: RAS = to_ras * file
};

/// The convention of a unit ("m", "cm", "mm", "um") and a frame: where +x, +y and +z point, each by one of R L
/// (right, left), A P (anterior, posterior), S I (superior, inferior), as in "RAS", "LPS" or "LSA". A frame may be
/// left-handed; surfaces are then turned inside out with it, and back. Throws InputError naming `where`.
Convention convention(const std::string& unit, const std::string& frame, const std::string& where);

}  // namespace carus::imaging
