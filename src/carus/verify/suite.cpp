// SPDX-License-Identifier: Apache-2.0
#include "carus/verify/suite.hpp"

namespace carus::verify {

const std::vector<Problem>& problems() {
  static const std::vector<Problem> all{
      {"patch", "Patch: a shaken cube whose boundary follows an affine map; inside, so does everything",
       "the affine map", true, patch},
      {"uniaxial", "Uniaxial stretch 1.5, free sides, each law (small strain: 1.001)",
       "P = dW/dλ in principal stretches, P = 0 sideways", true, uniaxial},
      {"equibiaxial", "Equibiaxial stretch 1.3, free through the thickness, each law (small strain: 1.001)",
       "P = dW/dλ in principal stretches, P = 0 through the thickness", true, equibiaxial},
      {"simple_shear", "Simple shear γ = 0.4, each law (small strain: 0.001)",
       "P = Σ dW/dλ_i n_i N_iᵀ with F = Σ λ_i n_i N_iᵀ; small strain: τ = Gγ", true, simple_shear},
      {"thick_sphere", "Thick-walled sphere inflated until its inner radius is 1.2 times as large; ν 0.499",
       "incompressible neo-Hooke, p = G [2/x + 1/(2x⁴)] between the walls' stretches: Ogden 1984, §5.3.2", true,
       thick_sphere},
      {"bending_block", "Block bent in plane strain by turning its ends; ν 0.3, 0.49, 0.499",
       "M = E κ h³/(12 (1 − ν²)) per thickness: Timoshenko and Goodier 1970, §20", true, bending_block},
      {"cook_membrane", "Cook's membrane in plane strain, its edge moved up as one; ν 0.3, 0.49, 0.499",
       "CalculiX 2.20, 64 × 64 20-node bricks with reduced integration (bench/ccx/cook.py); the geometry: Cook 1974",
       true, cook_membrane},
      {"twisted_column", "Round column turned by 90° over 1.5 diameters, ends kept flat; ν 0.499",
       "incompressible neo-Hooke, torque π/2 G ψ a⁴, axial force −π/4 G ψ² a⁴: Rivlin 1948", false, twisted_column},
      {"cantilever", "Cantilever 10 times as long as high under its own weight, q L³/EI = 5",
       "elastica, EI θ'' = q (L − s) cos θ, by Runge and Kutta's method", false, cantilever},
      {"contact_patch", "Two stacked blocks whose nodes do not meet, under uniform pressure",
       "the same stress everywhere", true, contact_patch},
      {"hertz_plane", "Elastic ball on a rigid plane, a/R = 0.2",
       "Hertz, with Tatara's term for the finite ball: Tatara 1991, J. Eng. Mater. Technol. 113, 285", false,
       hertz_plane},
      {"hertz_spheres", "Two elastic balls, one twice as stiff, meshes that do not match",
       "Hertz, with Tatara's term for either ball", false, hertz_spheres},
      {"curved_slide", "Block sliding down a circular track without friction, from 50°",
       "physical pendulum: ω² = 2 g r (1 − cos θ)/(r² + k²), quarter period K(sin θ/2)/ω₀", true, curved_slide},
      {"wave", "Pulse in a bar held sideways", "c = √((K + 4/3 G)/ρ)", true, wave},
      {"prony_relaxation", "Shear held after a jump, two branches", "G(t)/G = 1 − Σ g (1 − exp(−t/τ))", true,
       prony_relaxation},
      {"prony_creep", "Shear under a constant load, one branch", "γ = τ/(G (1 − g)) [1 − g exp(−t (1 − g)/τ)]", true,
       prony_creep},
      {"elastic_impact", "A free bar runs into one like it, both held sideways",
       "momentum and energy are kept; all momentum passes on, within 2 L/c: Saint-Venant", true, elastic_impact},
      {"ellipsoid_in_tube", "Elastic ellipsoid pushed through a narrowing elastic tube: force by place",
       "the other solver, with its other contact; the error is of the peak", false, ellipsoid_in_tube},
  };
  return all;
}

}  // namespace carus::verify
