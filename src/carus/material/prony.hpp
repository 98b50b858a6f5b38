// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "carus/material/tensor.hpp"

namespace carus::material {

// Finite linear viscoelasticity on the isochoric second Piola-Kirchhoff stress (Simo 1987; Holzapfel 2000,
// section 6.10):
//   S(t) = S_vol + (1 - sum g) S_iso + sum g h,   dh/dt + h/tau = d(S_iso)/dt.
// A material's constants are its INSTANTANEOUS moduli: a load applied within much less than tau meets S_iso itself, and
// a held strain relaxes to (1 - sum g) S_iso.

/// Symmetric 3x3.
template <class T>
struct Sym3T {
  T xx, yy, zz, yz, xz, xy;
};

/// Factors of one branch for one time step, computed once for all elements.
struct PronyFactors {
  double g;      ///< share of the instantaneous stiffness
  double decay;  ///< exp(-dt/tau)
  double ramp;   ///< (1 - exp(-dt/tau))/(dt/tau), 1 as dt -> 0

  /// dt > 0 and tau > 0 in the same unit.
  static PronyFactors of(double g, double tau, double dt) {
    const double x = dt / tau;
    return {g, std::exp(-x), -std::expm1(-x) / x};
  }
};

/// One branch over one step, exact where S_iso varies linearly within it: h <- decay h + ramp (S_now - S_before).
/// Adds g (h - S_now) to `S`, which starts as S_now; `before` is the caller's to renew, once for all branches.
template <class T>
CARUS_INLINE void relax(const PronyFactors& branch, const Sym3T<T>& now, const Sym3T<T>& before, Sym3T<T>& h,
                        Sym3T<T>& S) {
  using R = Scalar<T>;
  const R g = static_cast<R>(branch.g), decay = static_cast<R>(branch.decay), ramp = static_cast<R>(branch.ramp);
  const auto component = [&](T Sym3T<T>::*c) __attribute__((always_inline)) {
    h.*c = decay * (h.*c) + ramp * (now.*c - before.*c);
    S.*c += g * (h.*c - now.*c);
  };
  component(&Sym3T<T>::xx), component(&Sym3T<T>::yy), component(&Sym3T<T>::zz);
  component(&Sym3T<T>::yz), component(&Sym3T<T>::xz), component(&Sym3T<T>::xy);
}

template <class T>
CARUS_INLINE Sym3T<T> difference(const Sym3T<T>& a, const Sym3T<T>& b) {
  return {a.xx - b.xx, a.yy - b.yy, a.zz - b.zz, a.yz - b.yz, a.xz - b.xz, a.xy - b.xy};
}
/// S:A of a symmetric A.
template <class T>
CARUS_INLINE T contract(const Sym3T<T>& S, const Mat3T<T>& A) {
  return S.xx * A.m00 + S.yy * A.m11 + S.zz * A.m22 + Scalar<T>(2) * (S.yz * A.m12 + S.xz * A.m02 + S.xy * A.m01);
}

/// S = F^-1 P of an isochoric P; F^-1 = (cof F)^T/J.
template <class T>
CARUS_INLINE Sym3T<T> second_piola(const Mat3T<T>& cofactor_F, const T& J, const Mat3T<T>& P) {
  const T by_J = constant<T>(1) / J;
  const Mat3T<T> S = transpose_multiply(cofactor_F, P);
  return {S.m00 * by_J, S.m11 * by_J, S.m22 * by_J, S.m12 * by_J, S.m02 * by_J, S.m01 * by_J};
}
/// P = F S.
template <class T>
CARUS_INLINE Mat3T<T> first_piola_of(const Mat3T<T>& F, const Sym3T<T>& S) {
  return multiply(F, Mat3T<T>{S.xx, S.xy, S.xz, S.xy, S.yy, S.yz, S.xz, S.yz, S.zz});
}

}  // namespace carus::material
