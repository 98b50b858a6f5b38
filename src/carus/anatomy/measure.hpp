// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "carus/anatomy/anatomy.hpp"

namespace carus::anatomy {

/// Fills `requested` and `measured`: pelvimetry and biometry taken on the meshes [m, rad], mass [kg], volumes [m^3];
/// and warnings about what is impossible or unusual. Needs parameters, bodies and landmarks.
void measure(Anatomy& a);

}  // namespace carus::anatomy
