// SPDX-License-Identifier: Apache-2.0
#include "carus/report/wrench.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <limits>

#include "carus/core/error.hpp"

namespace carus::report {
namespace {

Vec3 vec(const std::array<float, 3>& v) { return {v[0], v[1], v[2]}; }

void sort_unique(std::vector<std::int32_t>& v) {
  std::sort(v.begin(), v.end());
  v.erase(std::unique(v.begin(), v.end()), v.end());
}

const Vec3& vec(const Vec3& v) { return v; }

template <class Points>
Vec3 mean(const Points& x, const std::vector<std::int32_t>& nodes) {
  Vec3 sum = Vec3::Zero();
  for (const auto i : nodes) sum += vec(x[i]);
  return sum / double(nodes.size());
}

double nearest(const Vec3& p, const std::vector<Vec3>& x, const std::vector<std::int32_t>& nodes) {
  double best = std::numeric_limits<double>::infinity();
  for (const auto i : nodes) best = std::min(best, (x[i] - p).squaredNorm());
  return best;
}

}  // namespace

Head::Head(const FrameMesh& mesh, const std::string& file) {
  std::vector<std::int32_t> other;
  mesh::TetMesh fetus{mesh.nodes, {}, {}};
  std::int32_t organ = -1;
  for (std::size_t e = 0; e < mesh.tets.size(); ++e) {
    if (mesh.regions[mesh.labels[e]] == "skull") organ = mesh.organ[e];
  }
  if (organ < 0)
    throw InputError(fmt::format("{}: has no region \"skull\"; its head's path cannot be told from its frames", file));
  for (std::size_t e = 0; e < mesh.tets.size(); ++e) {
    if (mesh.organ[e] != organ) continue;
    fetus.tets.push_back(mesh.tets[e]), fetus.labels.push_back(0);
    const auto& region = mesh.regions[mesh.labels[e]];
    if (region == "skull") skull_.insert(skull_.end(), mesh.tets[e].begin(), mesh.tets[e].end());
    if (region != "skull" && region != "fetal_skin")
      other.insert(other.end(), mesh.tets[e].begin(), mesh.tets[e].end());
  }
  sort_unique(skull_), sort_unique(other);
  skin_ = mesh::nodes_of(mesh::boundary(fetus));
  std::erase_if(skin_, [&](std::int32_t i) {
    return nearest(mesh.nodes[i], mesh.nodes, skull_) >= nearest(mesh.nodes[i], mesh.nodes, other);
  });
  rest_centre_ = mean(mesh.nodes, skull_);
}

Vec3 Head::centre(const FrameState& state) const { return mean(state.x, skull_); }

Wrench Head::contact(const FrameState& state) const {
  Wrench w;
  const Vec3 c = centre(state);
  for (const auto i : skin_) {
    const Vec3 f = vec(state.contact_force[i]);
    w.force += f;
    w.moment += (vec(state.x[i]) - c).cross(f);
  }
  return w;
}

}  // namespace carus::report
