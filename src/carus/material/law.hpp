// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "carus/core/error.hpp"
#include "carus/material/hooke.hpp"
#include "carus/material/material.hpp"
#include "carus/material/mooney_rivlin.hpp"
#include "carus/material/neo_hooke.hpp"

namespace carus::material {

/// Calls `visitor(law)` with the isotropic law of a material: the one place that turns the enumeration into code.
template <class T, class Visitor>
CARUS_INLINE decltype(auto) with_law(const Material& m, Visitor&& visitor) {
  const T G = constant<T>(m.shear_modulus());
  switch (m.law) {
    case Law::hooke_small_strain:
      return visitor(HookeSmallStrain<T>(G));
    case Law::hooke_corotated:
      return visitor(HookeCorotated<T>(G));
    case Law::neo_hooke:
      return visitor(NeoHooke<T>(constant<T>(m.c10)));
    case Law::mooney_rivlin:
      return visitor(MooneyRivlin<T>(constant<T>(m.c10), constant<T>(m.c01)));
  }
  CARUS_ASSERT(false);
}

}  // namespace carus::material
