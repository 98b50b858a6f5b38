// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "carus/mesh/tet_mesh.hpp"

namespace carus::observe {

/// Deformation of every tet, in doubles and apart from any solver.
class Strain {
 public:
  explicit Strain(const mesh::TetMesh& mesh);

  struct Field {
    std::vector<double> J;        ///< volume ratio det F per tet
    std::vector<double> stretch;  ///< largest principal stretch, √λ_max(FᵀF), per tet
  };
  /// `x`: current nodes [m]. Parallel; does not depend on the number of threads.
  [[nodiscard]] Field field(const std::vector<Vec3>& x) const;
  [[nodiscard]] const std::vector<double>& rest_volume() const { return rest_volume_; }  ///< [m^3] per tet

 private:
  const mesh::TetMesh& mesh_;
  std::vector<Mat3> inverse_rest_;  // Dm^-1
  std::vector<double> rest_volume_;
};

}  // namespace carus::observe
