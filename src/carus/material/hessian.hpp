// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Eigenvalues>

#include "carus/core/types.hpp"
#include "carus/material/volumetric.hpp"

namespace carus::material {

/// Second derivatives with respect to F, whose entries are numbered down the columns: F_ij is 3 j + i.
using Mat9 = Eigen::Matrix<double, 9, 9>;

inline Mat3T<double> to_tensor(const Mat3& A) {
  return {A(0, 0), A(0, 1), A(0, 2), A(1, 0), A(1, 1), A(1, 2), A(2, 0), A(2, 1), A(2, 2)};
}
inline Mat3 to_eigen(const Mat3T<double>& A) {
  return Mat3{{A.m00, A.m01, A.m02}, {A.m10, A.m11, A.m12}, {A.m20, A.m21, A.m22}};
}

/// W(F) [J/m^3] and P = dW/dF [Pa] of a law with U = bulk/2 (J - 1)^2; det F > 0.
template <class Law>
double energy(const Law& law, double bulk, const Mat3& F) {
  const auto f = to_tensor(F);
  return law.energy(f) + Law::volume_energy(bulk, law.volume_strain(f));
}
template <class Law>
Mat3 first_piola(const Law& law, double bulk, const Mat3& F) {
  const auto f = to_tensor(F);
  const double strain = law.volume_strain(f);
  Mat3T<double> P;
  law.first_piola(f, strain, Law::volume_pressure(bulk, strain), P);
  return to_eigen(P);
}
/// dP [Pa] along dF: the isochoric part, and U'' (n : dF) n + U' dn with n = d(J - 1)/dF.
template <class Law>
Mat3 first_piola_rate(const Law& law, double bulk, const Mat3& F, const Mat3& dF) {
  const auto f = to_tensor(F), df = to_tensor(dF);
  const auto n = law.volume_gradient(f);
  const double strain = law.volume_strain(f), p = Law::volume_pressure(bulk, strain);
  return to_eigen(law.first_piola_rate(f, df) + n * (Law::volume_stiffness(bulk, strain) * contract(n, df)) +
                  law.volume_gradient_rate(f, df) * p);
}

/// dP_dF [Pa], symmetric.
template <class Law>
Mat9 dP_dF(const Law& law, double bulk, const Mat3& F) {
  Mat9 A;
  for (int k = 0; k < 9; ++k) {
    Mat3 dF = Mat3::Zero();
    dF(k % 3, k / 3) = 1;
    const Mat3 dP = first_piola_rate(law, bulk, F, dF);
    A.col(k) = Eigen::Map<const Eigen::Vector<double, 9>>(dP.data());
  }
  return 0.5 * (A + A.transpose());
}

/// The nearest positive semi-definite matrix: negative eigenvalues set to 0 (Teran et al. 2005), for projected Newton.
inline Mat9 project_positive(const Mat9& A) {
  const Eigen::SelfAdjointEigenSolver<Mat9> eigen(A);
  const auto& Q = eigen.eigenvectors();
  return Q * eigen.eigenvalues().cwiseMax(0.0).asDiagonal() * Q.transpose();
}

}  // namespace carus::material
