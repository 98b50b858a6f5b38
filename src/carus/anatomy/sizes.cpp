// SPDX-License-Identifier: Apache-2.0
#include "carus/anatomy/sizes.hpp"

#include <fmt/format.h>

#include "carus/core/error.hpp"

namespace carus::anatomy {

MeshSize mesh_size(const std::string& resolution) {
  if (resolution == "coarse")
    return {.fetus = 0.0140, .uterus = 0.0130, .abdomen_inner = 0.0150, .abdomen_outer = 0.042, .bone = 0.017};
  if (resolution == "paper")
    return {.fetus = 0.0066, .uterus = 0.0090, .abdomen_inner = 0.0105, .abdomen_outer = 0.028, .bone = 0.0074};
  if (resolution == "fine")
    return {.fetus = 0.0056, .uterus = 0.0065, .abdomen_inner = 0.0075, .abdomen_outer = 0.020, .bone = 0.0065};
  throw InputError(
      fmt::format("resolution: \"{}\" is none of coarse, paper, fine; hint: paper is the reference", resolution));
}

}  // namespace carus::anatomy
