// SPDX-License-Identifier: Apache-2.0
#include "carus/verify/statics.hpp"

#include <algorithm>
#include <map>

#if __has_include("carus/solve/implicit.hpp")
#include "carus/solve/implicit.hpp"
#define CARUS_IMPLICIT
#endif
#include "carus/core/error.hpp"

namespace carus::verify {

Equilibrium equilibrium(const fem::Model& model, int increments, double length) {
#ifdef CARUS_IMPLICIT
  solve::ImplicitOptions o;
  o.time_step = 1.0 / increments, o.least_time_step = 1e-4 / increments;
  o.newton_tolerance = 1e-8 * length;  // what the last correction may still move: errors of a problem are far above
  o.linear_tolerance = 1e-2;
  o.drag = 0;
  o.threads = 0;
  solve::Implicit s(model, o);
  s.advance_to(1);
  auto seen = s.observe();
  return {s.state().x, seen.reaction, seen};
#else
  static_cast<void>(model), static_cast<void>(increments), static_cast<void>(length);
  throw InputError("no implicit solver in this build");
#endif
}

std::vector<std::int32_t> nodes_where(const mesh::TetMesh& mesh, const std::function<bool(const Vec3& X)>& where) {
  std::vector<std::int32_t> nodes;
  for (std::size_t i = 0; i < mesh.nodes.size(); ++i) {
    if (where(mesh.nodes[i])) nodes.push_back(std::int32_t(i));
  }
  return nodes;
}

void impose(fem::Model& model, std::uint8_t axes, const std::function<bool(const Vec3& X)>& where,
            const std::function<Vec3(const Vec3& X)>& displacement) {
  // Nodes of one displacement make one motion.
  std::map<std::array<double, 3>, std::size_t> motion_of;
  for (const auto n : nodes_where(model.mesh, where)) {
    const Vec3 u = displacement(model.mesh.nodes[n]);
    const auto [it, fresh] = motion_of.try_emplace({u.x(), u.y(), u.z()}, model.motions.size());
    if (fresh) {
      fem::Motion motion;
      motion.axes = axes;
      motion.displacement = [u](double t) -> Vec3 { return std::min(1.0, t) * u; };
      model.motions.push_back(std::move(motion));
    }
    model.motions[it->second].nodes.push_back(n);
  }
}

Vec3 sum(const std::vector<Vec3>& f, const mesh::TetMesh& mesh, const std::function<bool(const Vec3& X)>& where) {
  Vec3 total = Vec3::Zero();
  for (const auto n : nodes_where(mesh, where)) total += f[n];
  return total;
}

}  // namespace carus::verify
