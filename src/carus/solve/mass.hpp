// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include "carus/fem/model.hpp"

namespace carus::solve {

/// Lumped nodal masses [kg], as they are and with what the time step asks for.
struct Masses {
  std::vector<double> unscaled, scaled;
  double critical_step = 0;     ///< [s] least over the unscaled elements
  std::string limiting_region;  ///< where it is
  double added_fraction = 0;    ///< added over unscaled mass
};

/// Critical step of an element with lumped mass: 2/omega, omega^2 <= 4 c^2 sum |grad N|^2, c^2 = (K + 4/3 G)/rho [s].
double critical_step(const fem::Model& model, std::size_t tet);

/// Each element whose safety * critical step is below dt is made heavier by the square of the ratio.
Masses scaled_masses(const fem::Model& model, double dt, double safety);

}  // namespace carus::solve
