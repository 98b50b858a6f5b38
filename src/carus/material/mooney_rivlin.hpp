// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "carus/material/volumetric.hpp"

namespace carus::material {

/// Mooney-Rivlin: W = C10 (I1bar - 3) + C01 (I2bar - 3) + U(J), I2bar = J^(-4/3) (I1^2 - C:C)/2, G = 2 (C10 + C01)
/// (Holzapfel 2000, eq. 6.146).
template <class T>
struct MooneyRivlin : FiniteVolume<T> {
  T c10, c01;  ///< [Pa]

  MooneyRivlin(const T& c10_, const T& c01_) : c10(c10_), c01(c01_) {}

  /// Isochoric energy density [J/m^3].
  CARUS_INLINE T energy(const Mat3T<T>& F) const {
    const Mat3T<T> G = right_strain(F);
    return c10 * isochoric_trace_minus_3(G) + c01 * isochoric_trace_minus_3(cofactor_minus_identity(G));
  }

  /// P = dev(2 C10 J^(-2/3) B + 2 C01 J^(-4/3) (I1 B - B^2)) F^-T + pressure cof F.
  /// With G = B - I, dev(I1 B - B^2) = dev((1 + tr G) G - G^2): nothing cancels near rest.
  CARUS_INLINE void first_piola(const Mat3T<T>& F, const T& J_minus_1, const T& pressure, Mat3T<T>& P) const {
    using S = Scalar<T>;
    const Mat3T<T> G = left_strain(F);
    const T r = rcbrt(T(J_minus_1 + S(1)));
    const T r2 = r * r, by_J = S(2) * r2 * r;
    const T on_G = by_J * r2 * (c10 + c01 * r2 * (trace(G) + S(1)));
    const T on_G2 = -by_J * c01 * r2 * r2;
    const Mat3T<T> tau_by_J = deviator<T>(G * on_G + multiply(G, G) * on_G2);
    P = multiply<T>(plus_diagonal(tau_by_J, pressure), cofactor(F));
  }

  /// dP of the isochoric part along dF.
  CARUS_INLINE Mat3T<T> first_piola_rate(const Mat3T<T>& F, const Mat3T<T>& dF) const {
    using S = Scalar<T>;
    const T third = constant<T>(1.0 / 3.0);
    const Mat3T<T> F_inv_T = transpose<T>(inverse(F)), fall = inverse_transpose_fall(F_inv_T, dF);
    const T r = rcbrt(determinant(F)), t = contract(F_inv_T, dF), s1 = S(2) * r * r, s2 = s1 * r * r;
    const Mat3T<T> C = transpose_multiply(F, F);
    const Mat3T<T> dC = transpose_multiply(dF, F) + transpose_multiply(F, dF);
    const T I1 = trace(C), dI1 = trace(dC);
    const T I2 = S(0.5) * (I1 * I1 - contract(C, C)), dI2 = I1 * dI1 - contract(C, dC);

    const Mat3T<T> Q1 = F - F_inv_T * T(I1 * third);
    const Mat3T<T> dQ1 = dF - F_inv_T * T(dI1 * third) + fall * T(I1 * third);
    const Mat3T<T> Q2 = F * I1 - multiply(F, C) - F_inv_T * T(I2 * S(2) * third);
    const Mat3T<T> dQ2 = F * dI1 + dF * I1 - multiply(dF, C) - multiply(F, dC) - F_inv_T * T(dI2 * S(2) * third) +
                         fall * T(I2 * S(2) * third);
    return (dQ1 - Q1 * T(t * S(2) * third)) * T(c10 * s1) + (dQ2 - Q2 * T(t * S(4) * third)) * T(c01 * s2);
  }
};

}  // namespace carus::material
