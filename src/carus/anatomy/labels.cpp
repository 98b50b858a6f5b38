// SPDX-License-Identifier: Apache-2.0
#include "carus/anatomy/anatomy.hpp"

namespace carus::anatomy {

const char* name_of(std::int32_t label) {
  switch (label) {
    case outside:
      return "outside";
    case skull:
      return "skull";
    case fetal_body:
      return "fetal_body";
    case fetal_skin:
      return "fetal_skin";
    case uterine_fundus:
      return "uterine_fundus";
    case uterine_body:
      return "uterine_body";
    case lower_segment:
      return "lower_segment";
    case vaginal_canal:
      return "vaginal_canal";
    case abdomen:
      return "abdomen";
    case levator_ani:
      return "levator_ani";
    case perineal_body:
      return "perineal_body";
    case innominate_right:
      return "innominate_right";
    case innominate_left:
      return "innominate_left";
    case sacrum:
      return "sacrum";
    case coccyx:
      return "coccyx";
    default:
      return "unknown";
  }
}

}  // namespace carus::anatomy
