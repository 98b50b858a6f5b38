// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "carus/fem/block_matrix.hpp"
#include "carus/fem/model.hpp"

namespace carus::fem {

/// Average nodal pressure (see nodal_pressure.hpp) in double precision, as an energy with its derivatives:
///
///     E = sum_a V0_a U(e_a),  e_a = sum_{e round a} V_e strain_e/4 / V0_a,  V0_a = sum_{e round a} V_e/4.
///
/// Its Hessian is sum_a U''(e_a)/V0_a b_a b_a^T, b_a = V0_a de_a/dx, plus the elements' p_e d2V_e/dx2, which belong to
/// the elements. The first part couples all nodes round a; it is kept as the rows b_a and applied as such.
class NodalVolume {
 public:
  /// `tets`, `regions` and `volumes` [m^3] of the elements that carry stress.
  NodalVolume(const Model& model, const std::vector<mesh::Tet>& tets, const std::vector<std::int32_t>& regions,
              const std::vector<double>& volumes);

  [[nodiscard]] bool any() const { return !nodes_.empty(); }
  [[nodiscard]] bool averages(std::size_t tet) const { return slots_[tet][0] >= 0; }
  /// Takes the elements' volume strains; returns the energy [J].
  double update(const std::vector<double>& volume_strain);
  /// Mean pressure of a tet's nodes [Pa].
  [[nodiscard]] double pressure(std::size_t tet) const;

  /// Takes the gradients of the elements' volumes, V_e dstrain_e/dx per corner [m^2], at the last update.
  void linearise(const std::vector<std::array<Vec3, 4>>& volume_gradient);
  /// y += sum_a U''/V0_a b_a (b_a . x).
  void add_product(const std::vector<Vec3>& x, std::vector<Vec3>& y) const;
  void add_diagonal(std::vector<Mat3>& diagonal) const;

 private:
  struct Node {
    double bulk, rest_volume;
    bool finite;                       ///< U as of finite strain, or of small strain
    std::int32_t first, last;          ///< its entries: tets round it
    std::int32_t row_first, row_last;  ///< its row of b
  };

  const std::vector<double>& volumes_;
  std::vector<std::array<std::int32_t, 4>> slots_;  ///< per tet: its nodes here, -1 where not averaged
  std::vector<Node> nodes_;
  struct Entry {
    std::int32_t tet;
    std::array<std::int32_t, 4> places;  ///< of its corners in the row
  };
  std::vector<Entry> entries_;
  std::vector<std::int32_t> columns_;  ///< of the rows: mesh nodes
  std::vector<Vec3> rows_;
  std::vector<std::int32_t> column_begin_;                        ///< mesh node -> where it is in the rows
  std::vector<std::pair<std::int32_t, std::int32_t>> column_at_;  ///< (node here, place in rows)
  std::vector<double> strain_, pressure_, stiffness_;
  mutable std::vector<double> weight_;
};

}  // namespace carus::fem
