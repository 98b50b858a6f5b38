// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>

#include "carus/core/types.hpp"
#include "carus/material/material.hpp"

/// References of the verification problems, derived by hand in principal stretches: no code of the solvers.
namespace carus::verify {

/// Nominal principal stresses P_i = dW/dlambda_i [Pa] of an isotropic law at the principal stretches.
Vec3 principal_stress(const material::Material& m, const Vec3& stretch);

/// P = sum P_i n_i N_i^T with the singular value decomposition F = sum lambda_i n_i N_i^T [Pa]. Not for small strain.
Mat3 nominal_stress(const material::Material& m, const Mat3& F);

/// Root of a rising function between two bounds.
double root(const std::function<double(double)>& f, double low, double high);

/// Pressure in a thick sphere of incompressible neo-Hooke that has grown from inner radius to inner_now [Pa]: Ogden
/// 1984, Non-linear elastic deformations, section 5.3.2.
double sphere_pressure(double inner, double outer, double G, double inner_now);

/// Tip of an inextensible beam under a dead load per length, clamped at the origin along x, load along -z: EI theta'' =
/// q (L - s) cos theta, theta(0) = 0, theta'(L) = 0; fourth-order Runge-Kutta and shooting.
struct Tip {
  double x, z;
};
Tip elastica(double length, double bending_stiffness, double load_per_length);

/// Approach of a ball of radius R pressed on a rigid plane by F, to its middle [m]: Hertz with Tatara's term for the
/// finite ball (J. Eng. Mater. Technol. 113, 1991, 285).
double hertz_approach(double F, double R, double E, double nu);
/// Approach of the middles of two such balls pressed on each other.
double hertz_approach_of_two(double F, double R, double E1, double E2, double nu);
/// The force of an approach to the plane.
double hertz_force(double approach, double R, double E, double nu);

}  // namespace carus::verify
