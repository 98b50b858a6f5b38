// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <vector>

#include "carus/fem/model.hpp"

namespace carus::observe {

/// Cauchy stress of every tet, in doubles and apart from any solver; with the nodal averages of pressure where a
/// region has them. Elastic only: of regions with relaxation, active strain or fibres it would not be the whole stress,
/// and is NaN; of rigid regions it is 0.
class Stress {
 public:
  explicit Stress(const fem::Model& model);

  using Sym = std::array<double, 6>;  ///< xx, yy, zz, xy, yz, zx [Pa]
  struct Field {
    std::vector<Sym> tet;           ///< per tet
    std::vector<double> von_mises;  ///< [Pa] per tet
    std::vector<double> pressure;   ///< [Pa] -tr/3, per tet
    std::vector<Sym> node;          ///< mean of the deformable tets round a node, by rest volume; 0 where there is none
  };
  /// `x`: current nodes [m]. Linear; does not depend on the number of threads.
  [[nodiscard]] Field field(const std::vector<Vec3>& x) const;

 private:
  [[nodiscard]] std::vector<double> averaged_pressures(const std::vector<Vec3>& x) const;

  const fem::Model& model_;
  std::vector<double> rest_volume_;
  std::vector<Mat3> inverse_edges_;
};

}  // namespace carus::observe
