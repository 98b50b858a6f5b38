// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <string>
#include <vector>

namespace carus::material {

enum class Law { hooke_small_strain, hooke_corotated, neo_hooke, mooney_rivlin };

/// One term of a Prony series: a Maxwell branch on the isochoric response.
struct PronyTerm {
  double g;    ///< share of the instantaneous isochoric stiffness, 0..1
  double tau;  ///< relaxation time [s of labour]
};

/// A material by value. Isochoric part by `law`; volumetric part K/4 (J^2 - 1 - 2 ln J) with K from `poisson`
/// (small-strain equivalent).
struct Material {
  Law law = Law::neo_hooke;
  double density = 1000;      ///< [kg/m^3]
  double c10 = 0, c01 = 0;    ///< [Pa]; shear modulus G = 2 (c10 + c01)
  double youngs_modulus = 0;  ///< [Pa], Hooke only
  double poisson = 0.45;      ///< -, small-strain equivalent; sets the bulk modulus
  double fibre_k1 = 0;        ///< [Pa], transversely isotropic term k1/(2 k2) (exp(k2 <I4-1>^2) - 1)
  double fibre_k2 = 1;        ///< -
  std::vector<PronyTerm> prony;
  bool average_nodal_pressure = false;

  [[nodiscard]] double shear_modulus() const;  ///< G [Pa]
  [[nodiscard]] double bulk_modulus() const;   ///< K [Pa]
};

/// Every problem of a material, each with value, allowed range and hint, as "`where`: ..."; empty when it is sound.
[[nodiscard]] std::vector<std::string> validate(const Material& material, const std::string& where);

}  // namespace carus::material
