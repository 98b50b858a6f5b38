// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>

#include "carus/core/types.hpp"
#include "carus/material/hooke.hpp"
#include "carus/material/mooney_rivlin.hpp"
#include "carus/material/neo_hooke.hpp"

namespace carus::material {

/// Second derivatives of an isotropic W(F) in the frame of F = U diag(s) V^T (Smith, de Goes and Kim 2019): the
/// stretches couple by `stretch`; each plane (j, k) opposite to axis i has a shear (dF_jk + dF_kj)/sqrt 2 of stiffness
/// shear[i] and a rotation (dF_jk - dF_kj)/sqrt 2 of stiffness turn[i]. All in Pa.
struct PrincipalHessian {
  Mat3 stretch = Mat3::Zero();
  Vec3 shear = Vec3::Zero(), turn = Vec3::Zero();

  PrincipalHessian& operator*=(double factor) {
    stretch *= factor, shear *= factor, turn *= factor;
    return *this;
  }
};

/// Adds an isochoric law at the stretches s > 0. With L = 1/s, W_i = dW/ds_i:
///   shear = (W_j - W_k)/(s_j - s_k), turn = (W_j + W_k)/(s_j + s_k),
/// divided out by hand, so that equal stretches are nothing special.
inline void add_principal(const NeoHooke<double>& law, const Vec3& s, PrincipalHessian& h) {
  const Vec3 L = s.cwiseInverse();
  const double J = s.prod(), I1 = s.squaredNorm(), c = law.c10 / std::cbrt(J * J);
  h.stretch += c * (4.0 / 9.0 * I1 * L * L.transpose() - 4.0 / 3.0 * (s * L.transpose() + L * s.transpose()));
  h.stretch.diagonal() += c * (2.0 + 2.0 / 3.0 * I1 * L.array().square()).matrix();
  for (int i = 0; i < 3; ++i) {
    const double LL = L[(i + 1) % 3] * L[(i + 2) % 3];
    h.shear[i] += c * (2 + 2.0 / 3.0 * I1 * LL);
    h.turn[i] += c * (2 - 2.0 / 3.0 * I1 * LL);
  }
}

inline void add_principal(const MooneyRivlin<double>& law, const Vec3& s, PrincipalHessian& h) {
  add_principal(NeoHooke<double>(law.c10), s, h);
  const Vec3 L = s.cwiseInverse(), L3 = L.array().cube();
  const double J = s.prod(), K = L.squaredNorm(), c = law.c01 * std::cbrt(J * J);
  h.stretch += c * (4.0 / 9.0 * K * L * L.transpose() - 4.0 / 3.0 * (L3 * L.transpose() + L * L3.transpose()));
  h.stretch.diagonal() += c * (6.0 * L.array().pow(4) - 2.0 / 3.0 * K * L.array().square()).matrix();
  for (int i = 0; i < 3; ++i) {
    const double a = L[(i + 1) % 3], b = L[(i + 2) % 3];
    h.shear[i] += c * a * b * (2 * (a * a + a * b + b * b) - 2.0 / 3.0 * K);
    h.turn[i] += c * a * b * (2.0 / 3.0 * K - 2 * (a * a - a * b + b * b));
  }
}

inline void add_principal(const HookeCorotated<double>& law, const Vec3& s, PrincipalHessian& h) {
  h.stretch += 2 * law.mu * (Mat3::Identity() - Mat3::Constant(1.0 / 3.0));
  const double trace = s.sum() - 3;
  for (int i = 0; i < 3; ++i) {
    const double sum = s[(i + 1) % 3] + s[(i + 2) % 3];
    h.shear[i] += 2 * law.mu;
    h.turn[i] += 2 * law.mu * (sum - 2 - 2.0 / 3.0 * trace) / sum;
  }
}

/// Adds U(J): pressure U' [Pa], stiffness U'' [Pa].
inline void add_principal_volume(double pressure, double stiffness, const Vec3& s, PrincipalHessian& h) {
  const Vec3 L = s.cwiseInverse();
  const double J = s.prod();
  h.stretch += (stiffness * J * J + pressure * J) * L * L.transpose();
  h.stretch.diagonal() -= pressure * J * L.array().square().matrix();
  for (int i = 0; i < 3; ++i) {
    h.shear[i] -= pressure * s[i];  // J L_j L_k = s_i
    h.turn[i] += pressure * s[i];
  }
}

/// The nearest positive semi-definite one.
inline void project_positive(PrincipalHessian& h) {
  h.shear = h.shear.cwiseMax(0.0), h.turn = h.turn.cwiseMax(0.0);
  const Mat3& A = h.stretch;
  const double minor = A(0, 0) * A(1, 1) - A(0, 1) * A(1, 0);
  if (A(0, 0) > 0 && minor > 0 && A.determinant() > 0) return;
  const Eigen::SelfAdjointEigenSolver<Mat3> eigen(A);
  const Mat3& Q = eigen.eigenvectors();
  h.stretch = Q * eigen.eigenvalues().cwiseMax(0.0).asDiagonal() * Q.transpose();
}

/// F = U diag(s) V^T with rotations U, V; det F > 0.
struct PrincipalFrame {
  Mat3 U, V;
  Vec3 s;

  explicit PrincipalFrame(const Mat3& F) {
    Eigen::SelfAdjointEigenSolver<Mat3> eigen;
    eigen.computeDirect(F.transpose() * F);
    V = eigen.eigenvectors();
    V.col(2) = V.col(0).cross(V.col(1)).normalized();
    V.col(1) = V.col(2).cross(V.col(0));
    const Mat3 FV = F * V;  // columns s_i u_i, longest last
    U.col(2) = FV.col(2).normalized();
    U.col(1) = (FV.col(1) - U.col(2).dot(FV.col(1)) * U.col(2)).normalized();
    U.col(0) = U.col(1).cross(U.col(2));
    for (int i = 0; i < 3; ++i) s[i] = std::max(U.col(i).dot(FV.col(i)), 1e-12);
  }
};

}  // namespace carus::material
