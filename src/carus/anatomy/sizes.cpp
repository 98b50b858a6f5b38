// SPDX-License-Identifier: Apache-2.0
#include "carus/anatomy/sizes.hpp"

#include <fmt/format.h>

#include "carus/core/error.hpp"

namespace carus::anatomy {

MeshSize mesh_size(const std::string& resolution) {
  if (resolution == "coarse") return {.fetus = 0.0130, .uterus = 0.0130, .abdomen_inner = 0.0150, .abdomen_outer = 0.034, .bone = 0.016};
  if (resolution == "paper") return {.fetus = 0.0070, .uterus = 0.0090, .abdomen_inner = 0.0080, .abdomen_outer = 0.022, .bone = 0.0068};
  if (resolution == "fine") return {.fetus = 0.0056, .uterus = 0.0065, .abdomen_inner = 0.0060, .abdomen_outer = 0.016, .bone = 0.0055};
  throw InputError(fmt::format("resolution: \"{}\" is none of coarse, paper, fine; hint: paper is the reference", resolution));
}

}  // namespace carus::anatomy
