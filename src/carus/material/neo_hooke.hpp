// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "carus/material/volumetric.hpp"

namespace carus::material {

/// Neo-Hooke in the paper's form (Buttin et al. 2013, section 3.3): W = C10 (I1bar - 3) + U(J), I1bar = J^(-2/3) F:F,
/// G = 2 C10. The paper gives no volumetric term; U is volumetric.hpp's.
template <class T>
struct NeoHooke : FiniteVolume<T> {
  T c10;  ///< [Pa]

  explicit NeoHooke(const T& c10_) : c10(c10_) {}

  /// Isochoric energy density [J/m^3].
  CARUS_INLINE T energy(const Mat3T<T>& F) const { return c10 * isochoric_trace_minus_3(right_strain(F)); }

  /// P = 2 C10 J^(-2/3) (F - I1/3 F^-T) + pressure cof F.
  ///
  /// With H = F - I, C = cof F - I, j = J - 1, D = I1/3 - 1 the bracket is ((1+j) H - (1+D) C + (j - D) I)/J: no
  /// difference of numbers near 1 is left, so that P keeps its relative accuracy near rest, in single precision too.
  CARUS_INLINE void first_piola(const Mat3T<T>& F, const T& J_minus_1, const T& pressure, Mat3T<T>& P) const {
    using S = Scalar<T>;
    const Mat3T<T> H = minus_identity(F);
    const Mat3T<T> C = cofactor_minus_identity(H);
    const T D = (S(2) * trace(H) + contract(H, H)) * S(1.0 / 3.0);
    const T J = J_minus_1 + S(1);
    const T r = rcbrt(J);
    const T scale = S(2) * c10 * r * r * (r * r * r);  // 2 C10 J^(-5/3)
    // Both parts multiply C and I: gather their factors first.
    const T on_H = scale * J, on_C = pressure - scale * (D + S(1)), on_I = pressure + scale * (J_minus_1 - D);
    P = plus_diagonal<T>(H * on_H + C * on_C, on_I);
  }

  /// dP of the isochoric part along dF.
  CARUS_INLINE Mat3T<T> first_piola_rate(const Mat3T<T>& F, const Mat3T<T>& dF) const {
    using S = Scalar<T>;
    const Mat3T<T> F_inv_T = transpose<T>(inverse(F));
    const T r = rcbrt(determinant(F)), t = contract(F_inv_T, dF);
    const T I1_3 = contract(F, F) * S(1.0 / 3.0), dI1_3 = contract(F, dF) * S(2.0 / 3.0);
    const Mat3T<T> bracket = F - F_inv_T * I1_3;
    const Mat3T<T> d_bracket = dF - F_inv_T * dI1_3 + inverse_transpose_fall(F_inv_T, dF) * I1_3;
    return (d_bracket - bracket * T(t * S(2.0 / 3.0))) * T(S(2) * c10 * r * r);
  }
};

/// The same as a function, for kernels: c10 [Pa]; J_minus_1 = det F - 1; pressure = dU/dJ [Pa], the element's or a
/// nodal average.
template <class T>
CARUS_INLINE void first_piola(const Mat3T<T>& F, const T& c10, const T& J_minus_1, const T& pressure, Mat3T<T>& P) {
  NeoHooke<T>(c10).first_piola(F, J_minus_1, pressure, P);
}

}  // namespace carus::material
