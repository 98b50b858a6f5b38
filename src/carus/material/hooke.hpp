// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "carus/material/volumetric.hpp"

namespace carus::material {

/// Hooke, small strain: W = mu |dev eps|^2 + K/2 (tr eps)^2, eps = sym(F - I). Valid for small rotations only: volume
/// is measured by tr eps, and `pressure` multiplies I, the limit of cof F.
template <class T>
struct HookeSmallStrain {
  T mu;  ///< shear modulus [Pa]

  explicit HookeSmallStrain(const T& mu_) : mu(mu_) {}

  CARUS_INLINE static T volume_strain(const Mat3T<T>& F) { return trace(minus_identity(F)); }
  CARUS_INLINE static Mat3T<T> volume_gradient(const Mat3T<T>&) { return identity<T>(); }
  CARUS_INLINE static Mat3T<T> volume_gradient_rate(const Mat3T<T>&, const Mat3T<T>&) { return Mat3T<T>{}; }
  CARUS_INLINE static T volume_pressure(const T& bulk, const T& e) { return bulk * e; }
  CARUS_INLINE static T volume_energy(const T& bulk, const T& e) { return Scalar<T>(0.5) * bulk * e * e; }
  CARUS_INLINE static T volume_stiffness(const T& bulk, const T&) { return bulk; }

  /// Deviatoric energy density [J/m^3].
  CARUS_INLINE T energy(const Mat3T<T>& F) const {
    const Mat3T<T> e = deviatoric_strain(minus_identity(F));
    return mu * contract(e, e);
  }
  /// P = 2 mu dev eps + pressure I; the volume argument is not needed.
  CARUS_INLINE void first_piola(const Mat3T<T>& F, const T&, const T& pressure, Mat3T<T>& P) const {
    P = plus_diagonal<T>(deviatoric_strain(minus_identity(F)) * T(Scalar<T>(2) * mu), pressure);
  }
  CARUS_INLINE Mat3T<T> first_piola_rate(const Mat3T<T>&, const Mat3T<T>& dF) const {
    return deviatoric_strain(dF) * T(Scalar<T>(2) * mu);
  }

 private:
  CARUS_INLINE static Mat3T<T> deviatoric_strain(const Mat3T<T>& H) {
    return deviator<T>((H + transpose(H)) * constant<T>(0.5));
  }
};

/// Rotation R of F = R S, det F > 0: Newton's iteration for the polar factor (Higham 1986), R <- (R + R^-T)/2, each
/// step scaled to det R = 1 (Byers and Xu 2008), where R^-T = cof R. Quadratic; six steps reach rounding for principal
/// stretches in 1/5..5.
template <class T>
CARUS_INLINE Mat3T<T> polar_rotation(const Mat3T<T>& F) {
  Mat3T<T> R = F;
  for (int step = 0; step < 6; ++step) {
    R *= rcbrt(determinant(R));
    R = (R + cofactor(R)) * constant<T>(0.5);
  }
  return R;
}

/// Hooke, corotated: W = mu |dev(S - I)|^2 + U(J), S = R^T F: linear elasticity in the material's own rotated frame, so
/// that rigid rotation costs nothing. Volume by J, as in the other finite laws.
template <class T>
struct HookeCorotated : FiniteVolume<T> {
  T mu;  ///< shear modulus [Pa]

  explicit HookeCorotated(const T& mu_) : mu(mu_) {}

  /// Deviatoric energy density [J/m^3].
  CARUS_INLINE T energy(const Mat3T<T>& F) const {
    const Mat3T<T> E = deviatoric_stretch(F, polar_rotation(F));
    return mu * contract(E, E);
  }
  /// P = 2 mu R dev(S - I) + pressure cof F; J is not needed.
  CARUS_INLINE void first_piola(const Mat3T<T>& F, const T&, const T& pressure, Mat3T<T>& P) const {
    P = deviatoric_stretch(F, polar_rotation(F)) * T(Scalar<T>(2) * mu) + cofactor(F) * pressure;
  }
  /// dP of the isochoric part along dF. dR = R W with W skew, and W S + S W = R^T dF - dF^T R; for axial vectors
  /// (tr(S) I - S) w = axial(R^T dF - dF^T R).
  CARUS_INLINE Mat3T<T> first_piola_rate(const Mat3T<T>& F, const Mat3T<T>& dF) const {
    const T third = constant<T>(1.0 / 3.0);
    const Mat3T<T> R = polar_rotation(F), S = transpose_multiply(R, F), A = transpose_multiply(R, dF);
    const Vec3T<T> w = multiply<T>(inverse(plus_diagonal<T>(S * constant<T>(-1), trace(S))),
                                   Vec3T<T>{A.m21 - A.m12, A.m02 - A.m20, A.m10 - A.m01});
    const Mat3T<T> W{T{}, -w.z, w.y, w.z, T{}, -w.x, -w.y, w.x, T{}};
    const Mat3T<T> dR = multiply(R, W);
    const T theta = trace(minus_identity(S)), d_theta = trace(A);
    return (dF - dR - (R * d_theta + dR * theta) * third) * T(Scalar<T>(2) * mu);
  }

 private:
  /// R dev(S - I) = F - R - tr(S - I)/3 R.
  CARUS_INLINE static Mat3T<T> deviatoric_stretch(const Mat3T<T>& F, const Mat3T<T>& R) {
    const Mat3T<T> E = F - R;
    return E - R * T(contract(R, E) * Scalar<T>(1.0 / 3.0));
  }
};

}  // namespace carus::material
