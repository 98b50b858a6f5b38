// SPDX-License-Identifier: Apache-2.0
#include "carus/material/material.hpp"

#include <fmt/format.h>

#include <cmath>

namespace carus::material {
namespace {

bool is_hooke(Law law) { return law == Law::hooke_small_strain || law == Law::hooke_corotated; }

}  // namespace

double Material::shear_modulus() const {
  return is_hooke(law) ? youngs_modulus / (2 * (1 + poisson)) : 2 * (law == Law::mooney_rivlin ? c10 + c01 : c10);
}

/// K = 2 G (1 + nu)/(3 (1 - 2 nu)).
double Material::bulk_modulus() const { return 2 * shear_modulus() * (1 + poisson) / (3 * (1 - 2 * poisson)); }

std::vector<std::string> validate(const Material& m, const std::string& where) {
  std::vector<std::string> problems;
  const auto require = [&](bool sound, const char* what, double value, const char* allowed, const char* hint) {
    if (!(sound && std::isfinite(value))) {
      problems.push_back(fmt::format("{}: {} is {:g}, allowed: {}; {}", where, what, value, allowed, hint));
    }
  };
  require(m.density > 0, "density", m.density, "> 0 kg/m^3", "soft tissue has about 1000");
  require(m.poisson > -1 && m.poisson < 0.5, "poisson", m.poisson, "-1 < poisson < 0.5",
          "use 0.45 to 0.499 for nearly incompressible tissue");
  if (is_hooke(m.law)) {
    require(m.youngs_modulus > 0, "youngs_modulus", m.youngs_modulus, "> 0 Pa", "Hooke's law needs it");
  } else if (m.law == Law::neo_hooke) {
    require(m.c10 > 0, "c10", m.c10, "> 0 Pa", "it is half the shear modulus");
  } else {
    require(m.c10 >= 0, "c10", m.c10, ">= 0 Pa", "a negative value makes large strains unstable");
    require(m.c01 >= 0, "c01", m.c01, ">= 0 Pa", "a negative value makes large strains unstable");
    require(m.c10 + m.c01 > 0, "c10 + c01", m.c10 + m.c01, "> 0 Pa", "it is half the shear modulus");
  }
  require(m.fibre_k1 >= 0, "fibre_k1", m.fibre_k1, ">= 0 Pa", "0 switches the fibres off");
  require(m.fibre_k2 > 0, "fibre_k2", m.fibre_k2, "> 0", "small values make the fibres nearly linear");
  double sum = 0;
  for (std::size_t i = 0; i < m.prony.size(); ++i) {
    const auto at = fmt::format("prony[{}]", i);
    require(m.prony[i].g >= 0 && m.prony[i].g <= 1, (at + ".g").c_str(), m.prony[i].g, "0 to 1",
            "it is a share of the instantaneous stiffness");
    require(m.prony[i].tau > 0, (at + ".tau").c_str(), m.prony[i].tau, "> 0 s", "it is a relaxation time");
    sum += m.prony[i].g;
  }
  require(sum < 1, "the sum of prony g", sum, "< 1", "what is left is the stiffness at rest");
  return problems;
}

}  // namespace carus::material
