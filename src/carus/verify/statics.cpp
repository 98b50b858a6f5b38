// SPDX-License-Identifier: Apache-2.0
#include "carus/verify/statics.hpp"

#include <algorithm>
#include <map>

#include "carus/solve/implicit.hpp"

namespace carus::verify {

Equilibrium equilibrium(const fem::Model& model, int increments, double length) {
  solve::ImplicitOptions o;
  o.time_step = 1.0 / increments, o.least_time_step = 1e-4 / increments;
  o.newton_tolerance = 1e-7 * length;  // what the last correction may still move: errors of a problem are far above
  o.linear_tolerance = 1e-2;
  o.drag = 0;
  o.threads = 0;
  solve::Implicit s(model, o);
  s.advance_to(1);
  auto seen = s.observe();
  return {s.state().x, seen.reaction, seen};
}

Equilibrium relaxed(const fem::Model& model, double duration, double time_step, double drag) {
  auto o = real_time(duration, time_step, drag);
  o.threads = 0;
  solve::Explicit s(model, o);
  s.advance_to(duration);
  auto seen = s.observe();
  return {s.state().x, seen.reaction, seen};
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
