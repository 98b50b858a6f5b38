// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "carus/material/tensor.hpp"

namespace carus::material {

/// How finite-strain laws measure and resist a change of volume. e = J - 1, whose gradient is cof F;
///
///     U(J) = K/4 (J^2 - 1 - 2 ln J),  dU/dJ = K/2 (J - 1/J) = K e (1 + e/2)/(1 + e)      (Simo and Taylor 1991)
///
/// U'' = K at rest, and the pressure grows without bound as J -> 0: soft tissue crushed against bone stiffens before it
/// inverts, which K/2 (J - 1)^2 does not see to. bulk in Pa.
template <class T>
struct FiniteVolume {
  CARUS_INLINE static T volume_strain(const Mat3T<T>& F) { return determinant_minus_one(minus_identity(F)); }
  CARUS_INLINE static Mat3T<T> volume_gradient(const Mat3T<T>& F) { return cofactor(F); }
  CARUS_INLINE static Mat3T<T> volume_gradient_rate(const Mat3T<T>& F, const Mat3T<T>& dF) {
    return cofactor_rate(F, dF);
  }
  CARUS_INLINE static T volume_pressure(const T& bulk, const T& e) {
    return bulk * e * (Scalar<T>(1) + Scalar<T>(0.5) * e) / (Scalar<T>(1) + e);
  }
  /// U [J/m^3] and U'' [Pa]; double only.
  CARUS_INLINE static T volume_energy(const T& bulk, const T& e) {
    return 0.25 * bulk * (2 * e + e * e - 2 * std::log1p(e));
  }
  CARUS_INLINE static T volume_stiffness(const T& bulk, const T& e) {
    return 0.5 * bulk * (1 + 1 / ((1 + e) * (1 + e)));
  }
};

/// F^T F - I = H + H^T + H^T H, H = F - I, exact near rest.
template <class T>
CARUS_INLINE Mat3T<T> right_strain(const Mat3T<T>& F) {
  const Mat3T<T> H = minus_identity(F);
  return H + transpose(H) + transpose_multiply(H, H);
}
/// F F^T - I, exact near rest.
template <class T>
CARUS_INLINE Mat3T<T> left_strain(const Mat3T<T>& F) {
  return right_strain<T>(transpose(F));
}

/// tr(A) det(A)^(-1/3) - 3 for A = I + G symmetric positive definite: I1bar - 3 for A = C, I2bar - 3 for A = cof C.
///
/// A = a (I + d) with a = tr(A)/3 and d traceless gives det A = a^3 (1 - q), q = |d|^2/2 - det d, so the value is
/// 3 ((1-q)^(-1/3) - 1) = 3 q r^3/(1 + r + r^2) with r = (1-q)^(-1/3): of relative accuracy however small the strain.
template <class T>
CARUS_INLINE T isochoric_trace_minus_3(const Mat3T<T>& G) {
  using S = Scalar<T>;
  const T a = trace(G) * S(1.0 / 3.0) + S(1);
  const Mat3T<T> d = deviator(G) * T(constant<T>(1) / a);
  const T q = S(0.5) * contract(d, d) - determinant(d);
  const T r = rcbrt(T(S(1) - q));
  return S(3) * q * r * r * r / (S(1) + r + r * r);
}

/// -d(F^-T) along dF = F^-T dF^T F^-T.
template <class T>
CARUS_INLINE Mat3T<T> inverse_transpose_fall(const Mat3T<T>& F_inv_T, const Mat3T<T>& dF) {
  return multiply(F_inv_T, transpose_multiply(dF, F_inv_T));
}

}  // namespace carus::material
