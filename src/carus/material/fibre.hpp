// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "carus/material/volumetric.hpp"

namespace carus::material {

/// Transversely isotropic term of one fibre family, to be added to an isotropic law:
/// W = k1/(2 k2) (exp(k2 e^2) - 1), e = <I4bar - 1>, I4bar = J^(-2/3) a.C a (Holzapfel, Gasser and Ogden 2000, eq. 65).
/// Fibres bear tension only; the stress is continuous at e = 0, its derivative jumps there by 4 k1 (dev a (x) a) (x)
/// (dev a (x) a).
template <class T>
struct Fibre : FiniteVolume<T> {
  T k1, k2;    ///< [Pa], -; k2 > 0
  Vec3T<T> a;  ///< unit fibre direction at rest

  Fibre(const T& k1_, const T& k2_, const Vec3T<T>& a_) : k1(k1_), k2(k2_), a(a_) {}

  /// Energy density [J/m^3].
  CARUS_INLINE T energy(const Mat3T<T>& F) const {
    const T e = positive_part(stretch(F, this->volume_strain(F)).e);
    return k1 / (Scalar<T>(2) * k2) * (exp(T(k2 * e * e)) - Scalar<T>(1));
  }

  /// P += 2 k1 e exp(k2 e^2) J^(-2/3) (F a (x) a - I4/3 F^-T); e takes the exact J - 1 near rest.
  CARUS_INLINE void add_first_piola(const Mat3T<T>& F, const T& J_minus_1, Mat3T<T>& P) const {
    using S = Scalar<T>;
    const Stretch s = stretch(F, J_minus_1);
    const T e = positive_part(s.e), scale = S(2) * k1 * e * exp(T(k2 * e * e)) * s.r * s.r;
    P += outer(s.f, a) * scale - cofactor(F) * T(scale * s.I4 * s.r * s.r * s.r * S(1.0 / 3.0));
  }
  CARUS_INLINE void add_first_piola(const Mat3T<T>& F, Mat3T<T>& P) const {
    add_first_piola(F, this->volume_strain(F), P);
  }
  /// The same term as a law of its own, with pressure cof F.
  CARUS_INLINE void first_piola(const Mat3T<T>& F, const T& J_minus_1, const T& pressure, Mat3T<T>& P) const {
    P = cofactor(F) * pressure;
    add_first_piola(F, J_minus_1, P);
  }

  /// dP along dF, without the volumetric part.
  CARUS_INLINE Mat3T<T> first_piola_rate(const Mat3T<T>& F, const Mat3T<T>& dF) const {
    using S = Scalar<T>;
    const Stretch s = stretch(F, this->volume_strain(F));
    const Mat3T<T> F_inv_T = transpose<T>(inverse(F));
    const T t = contract(F_inv_T, dF), third = constant<T>(1.0 / 3.0), r2 = s.r * s.r;
    const Vec3T<T> df = multiply(dF, a);
    const T dI4 = S(2) * dot(s.f, df), de = r2 * (dI4 - S(2) * third * t * s.I4);
    const T e = positive_part(s.e), stiff = exp(T(k2 * e * e));
    const T psi = S(2) * k1 * e * stiff * r2;
    // d(e exp(k2 e^2)) = (1 + 2 k2 e^2) exp(k2 e^2) de where the fibre is taut.
    const T taut = positive_part(s.e) / (e + constant<T>(1e-30));
    const T d_psi = S(2) * k1 * taut * (S(1) + S(2) * k2 * e * e) * stiff * de * r2 - psi * S(2) * third * t;
    const Mat3T<T> Q = outer(s.f, a) - F_inv_T * T(s.I4 * third);
    const Mat3T<T> dQ = outer(df, a) - F_inv_T * T(dI4 * third) + inverse_transpose_fall(F_inv_T, dF) * T(s.I4 * third);
    return Q * d_psi + dQ * psi;
  }

 private:
  struct Stretch {
    Vec3T<T> f;  ///< F a
    T r, I4, e;  ///< J^(-1/3), |F a|^2, I4bar - 1
  };
  /// I4bar - 1 = (r^2 - 1) + r^2 (I4 - 1), r - 1 = -(J - 1) r^3/(1 + r + r^2), I4 - 1 = u.(2 a + u) with u = (F - I) a.
  CARUS_INLINE Stretch stretch(const Mat3T<T>& F, const T& J_minus_1) const {
    using S = Scalar<T>;
    const Vec3T<T> f = multiply(F, a), u = multiply(minus_identity(F), a);
    const T r = rcbrt(T(J_minus_1 + S(1))), I4_minus_1 = S(2) * dot(u, a) + dot(u, u);
    const T r_minus_1 = -J_minus_1 * r * r * r / (S(1) + r + r * r);
    return {f, r, I4_minus_1 + S(1), r_minus_1 * (r + S(1)) + r * r * I4_minus_1};
  }
};

}  // namespace carus::material
