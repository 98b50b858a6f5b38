// SPDX-License-Identifier: Apache-2.0
#include "carus/report/wrench.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <limits>

#include "carus/core/error.hpp"
#include "carus/report/fields.hpp"

namespace carus::report {
namespace {

Vec3 vec(const std::array<float, 3>& v) { return {v[0], v[1], v[2]}; }

void sort_unique(std::vector<std::int32_t>& v) {
  std::sort(v.begin(), v.end());
  v.erase(std::unique(v.begin(), v.end()), v.end());
}

Vec3 mean(const std::vector<std::array<float, 3>>& x, const std::vector<std::int32_t>& nodes) {
  Vec3 sum = Vec3::Zero();
  for (const auto i : nodes) sum += vec(x[i]);
  return sum / double(nodes.size());
}

double nearest(const Vec3& p, const std::vector<std::array<float, 3>>& x, const std::vector<std::int32_t>& nodes) {
  double best = std::numeric_limits<double>::infinity();
  for (const auto i : nodes) best = std::min(best, (vec(x[i]) - p).squaredNorm());
  return best;
}

}  // namespace

Head::Head(const FrameMesh& mesh, const std::string& file) {
  std::vector<std::int32_t> other;
  std::vector<std::array<std::int32_t, 4>> fetus;
  std::int32_t organ = -1;
  for (std::size_t e = 0; e < mesh.tets.size(); ++e) {
    if (mesh.regions[mesh.region[e]] == "skull") organ = mesh.organ[e];
  }
  if (organ < 0)
    throw InputError(fmt::format("{}: has no region \"skull\"; its head's path cannot be told from its frames", file));
  for (std::size_t e = 0; e < mesh.tets.size(); ++e) {
    if (mesh.organ[e] != organ) continue;
    fetus.push_back(mesh.tets[e]);
    const auto& region = mesh.regions[mesh.region[e]];
    if (region == "skull") skull_.insert(skull_.end(), mesh.tets[e].begin(), mesh.tets[e].end());
    if (region != "skull" && region != "fetal_skin")
      other.insert(other.end(), mesh.tets[e].begin(), mesh.tets[e].end());
  }
  sort_unique(skull_), sort_unique(other);
  for (const auto& facet : boundary(fetus)) skin_.insert(skin_.end(), facet.begin(), facet.end());
  sort_unique(skin_);
  std::erase_if(skin_, [&](std::int32_t i) {
    return nearest(vec(mesh.rest[i]), mesh.rest, skull_) >= nearest(vec(mesh.rest[i]), mesh.rest, other);
  });
  rest_centre_ = mean(mesh.rest, skull_);
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
