// SPDX-License-Identifier: Apache-2.0
#include "carus/report/fields.hpp"

#include <algorithm>

#include "carus/core/types.hpp"
#include "carus/material/volumetric.hpp"

namespace carus::report {
namespace {

Vec3 vec(const std::array<float, 3>& v) { return {v[0], v[1], v[2]}; }

enum Kind : std::size_t { stretch, contact_pressure_kind, pressure };

}  // namespace

Fields::Fields(const FrameMesh& mesh, std::optional<std::map<std::string, material::Material>> materials)
    : mesh_(mesh), volume_(mesh.tets.size()), node_volume_(mesh.nodes.size(), 0), surface_(mesh::boundary(mesh)) {
  for (std::size_t e = 0; e < mesh.tets.size(); ++e) {
    volume_[e] = float(std::abs(mesh::volume(mesh, e)));
    for (const auto i : mesh.tets[e]) node_volume_[i] += volume_[e];
  }
  kinds_ = {{"stretch", "Largest stretch", "", 1, 0.01, 1, 3},
            {"contact_pressure", "Contact pressure", "kPa", 0, 0.5, 0, 60}};
  if (!materials) return;
  std::vector<float> bulk(mesh.regions.size());
  for (std::size_t r = 0; r < bulk.size(); ++r) {
    const auto own = materials->find(mesh.regions[r]), bone = materials->find("bone");
    const auto m = own != materials->end() ? own : bone;
    if (m == materials->end()) return;
    bulk[r] = float(m->second.bulk_modulus());
  }
  for (const auto r : mesh.labels) bulk_.push_back(bulk[r]);
  kinds_.push_back({"pressure", "Pressure in the tissue", "kPa", 0, 0.5, -40, 40});
}

std::vector<float> Fields::values(std::size_t k, const FrameState& state) const {
  if (k == stretch) return node_means(state.stretch);
  if (k == contact_pressure_kind) return contact_pressure(state);
  std::vector<float> p(state.volume_ratio.size());
  for (std::size_t e = 0; e < p.size(); ++e) {
    const float J = std::max(state.volume_ratio[e], 1e-3F);
    p[e] = -1e-3F * material::FiniteVolume<float>::volume_pressure(bulk_[e], J - 1);
  }
  return node_means(p);
}

std::vector<float> Fields::node_means(const std::vector<float>& per_tet) const {
  std::vector<float> out(node_volume_.size(), 0);
  for (std::size_t e = 0; e < per_tet.size(); ++e) {
    for (const auto i : mesh_.tets[e]) out[i] += volume_[e] * per_tet[e];
  }
  for (std::size_t i = 0; i < out.size(); ++i) out[i] = node_volume_[i] > 0 ? out[i] / node_volume_[i] : 0;
  return out;
}

std::vector<float> Fields::contact_pressure(const FrameState& state) const {
  std::vector<Vec3> normal(state.x.size(), Vec3::Zero());  // twice three times the area
  for (const auto& f : surface_) {
    const Vec3 a = vec(state.x[f[0]]);
    const Vec3 n = (vec(state.x[f[1]]) - a).cross(vec(state.x[f[2]]) - a);
    for (const auto i : f) normal[i] += n;
  }
  std::vector<float> out(state.x.size(), 0);
  for (std::size_t i = 0; i < out.size(); ++i) {
    // p = -f.n / A with n = N/|N| and A = |N|/6
    const double twice = normal[i].squaredNorm();
    if (twice > 0) out[i] = float(std::max(0.0, -6e-3 * vec(state.contact_force[i]).dot(normal[i]) / twice));
  }
  return out;
}

}  // namespace carus::report
