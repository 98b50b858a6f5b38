// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "carus/material/tensor.hpp"

namespace carus::material {

/// U(J) = K/2 (J - 1)^2 [J/m^3] and dU/dJ = K (J - 1) [Pa]; bulk in Pa. volume_strain is J - 1, or its small-strain
/// counterpart: see the laws' volume_strain.
template <class T>
CARUS_INLINE T volumetric_energy(const T& bulk, const T& volume_strain) {
  return Scalar<T>(0.5) * bulk * volume_strain * volume_strain;
}
template <class T>
CARUS_INLINE T volumetric_pressure(const T& bulk, const T& volume_strain) {
  return bulk * volume_strain;
}

/// How finite-strain laws measure volume: J - 1, whose gradient is cof F.
template <class T>
struct FiniteVolume {
  CARUS_INLINE static T volume_strain(const Mat3T<T>& F) { return determinant_minus_one(minus_identity(F)); }
  CARUS_INLINE static Mat3T<T> volume_gradient(const Mat3T<T>& F) { return cofactor(F); }
  CARUS_INLINE static Mat3T<T> volume_gradient_rate(const Mat3T<T>& F, const Mat3T<T>& dF) {
    return cofactor_rate(F, dF);
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
