// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include "carus/general/build.hpp"

namespace carus::general {

/// The model as a deck for CalculiX (ccx), in SI: linear tetrahedra C3D4, NLGEOM, one static step from 0 to the values
/// at the end of the duration; reactions and displacements of each watched set go to the .dat file. neo-Hooke and
/// Mooney-Rivlin keep C10 and C01 with D1 = 2/K (there U = (J - 1)^2/D1, here K/4 (J^2 - 1 - 2 ln J): the same near J =
/// 1); small-strain Hooke is *ELASTIC without NLGEOM. Throws InputError naming all that a deck cannot say: contact,
/// ties, rotations, relaxation, corotated Hooke, average nodal pressure, directed pressures, rigid regions.
std::string ccx_deck(const scenario::ModelScenario& scenario, const GeneralModel& model);

}  // namespace carus::general
