// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include "carus/fem/model.hpp"

namespace carus::scenario {

/// In a birth nothing may be prescribed for the fetus: where its head goes follows from forces and contact alone. A
/// model is a birth where it has fetal and uterine regions, by their names in anatomy::Label (a neck is fetal too). One
/// problem for each fetal region with a node that a motion moves or an axis blocks; none for other models.
std::vector<std::string> guided_fetus(const fem::Model& model);

}  // namespace carus::scenario
