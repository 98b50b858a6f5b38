// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "carus/anatomy/abdomen.hpp"

namespace carus::meshing {

/// Names on the meshed bodies: surfaces and nodes that loads, supports and measurements ask for.
void name_fetus(anatomy::Body& body);
void name_uterus(anatomy::Body& body, const anatomy::Uterus& uterus);
void name_abdomen(anatomy::Body& body, const anatomy::Abdomen& abdomen, const anatomy::Uterus& uterus);

}  // namespace carus::meshing
