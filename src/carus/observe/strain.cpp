// SPDX-License-Identifier: Apache-2.0
#include "carus/observe/strain.hpp"

#include <Eigen/Eigenvalues>
#include <Eigen/LU>
#include <cmath>

#include "carus/core/parallel.hpp"

namespace carus::observe {
namespace {

Mat3 edges(const std::vector<Vec3>& x, const mesh::Tet& t) {
  Mat3 D;
  D << x[t[1]] - x[t[0]], x[t[2]] - x[t[0]], x[t[3]] - x[t[0]];
  return D;
}

}  // namespace

Strain::Strain(const mesh::TetMesh& mesh)
    : mesh_(mesh), inverse_rest_(mesh.tets.size()), rest_volume_(mesh.tets.size()) {
  for (std::size_t e = 0; e < mesh.tets.size(); ++e) {
    const Mat3 Dm = edges(mesh.nodes, mesh.tets[e]);
    inverse_rest_[e] = Dm.inverse();
    rest_volume_[e] = Dm.determinant() / 6;
  }
}

Strain::Field Strain::field(const std::vector<Vec3>& x) const {
  Field out{std::vector<double>(mesh_.tets.size()), std::vector<double>(mesh_.tets.size())};
  parallel::for_chunks(mesh_.tets.size(), 4096, [&](std::size_t begin, std::size_t end, std::size_t) {
    Eigen::SelfAdjointEigenSolver<Mat3> eigen;
    for (std::size_t e = begin; e < end; ++e) {
      const Mat3 F = edges(x, mesh_.tets[e]) * inverse_rest_[e];  // F = Ds Dm⁻¹
      eigen.computeDirect(F.transpose() * F, Eigen::EigenvaluesOnly);
      out.J[e] = F.determinant();
      out.stretch[e] = std::sqrt(std::max(0.0, eigen.eigenvalues()[2]));
    }
  });
  return out;
}

}  // namespace carus::observe
