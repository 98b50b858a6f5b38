// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "carus/solve/explicit.hpp"
#include "carus/verify/models.hpp"

namespace carus::verify {

/// Where a model comes to rest, by the implicit solver: loads run over t = 0..1 in equal increments, tight tolerances.
struct Equilibrium {
  std::vector<Vec3> x;
  std::vector<Vec3> reaction;
  solve::Observables seen;
};
Equilibrium equilibrium(const fem::Model& model, int increments, double length);

/// The same by the explicit solver: loads over the first half of `duration` (give them so, up to t = duration/2), then
/// rest; drag near twice the lowest angular frequency [1/s].
Equilibrium relaxed(const fem::Model& model, double duration, double time_step, double drag);

/// Nodes that `where` selects.
std::vector<std::int32_t> nodes_where(const mesh::TetMesh& mesh, const std::function<bool(const Vec3& X)>& where);

/// Moves nodes along some axes by `displacement` of the rest position, times t up to 1.
void impose(fem::Model& model, std::uint8_t axes, const std::function<bool(const Vec3& X)>& where,
            const std::function<Vec3(const Vec3& X)>& displacement);

/// Sum over the nodes that `where` selects.
Vec3 sum(const std::vector<Vec3>& f, const mesh::TetMesh& mesh, const std::function<bool(const Vec3& X)>& where);

/// Within a nanometre.
inline bool on(double a, double b) { return std::abs(a - b) < 1e-9; }

}  // namespace carus::verify
