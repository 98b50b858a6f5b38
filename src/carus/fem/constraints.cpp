// SPDX-License-Identifier: Apache-2.0
#include "carus/fem/constraints.hpp"

#include <algorithm>

namespace carus::fem {

std::vector<std::uint8_t> constrained_axes(const Model& model) {
  std::vector<std::uint8_t> axes = model.blocked;
  for (const Motion& motion : model.motions) {
    for (const auto n : motion.nodes) axes[n] = std::uint8_t(axes[n] | motion.axes);
  }
  return axes;
}

std::vector<double> lumped_mass(const Model& model, const std::vector<std::int32_t>& regions) {
  std::vector<double> mass(model.mesh.nodes.size(), 0.0);
  for (std::size_t e = 0; e < model.mesh.tets.size(); ++e) {
    const auto label = model.mesh.labels[e];
    const Region& region = model.regions[label];
    if (region.rigid || (!regions.empty() && std::find(regions.begin(), regions.end(), label) == regions.end()))
      continue;
    const double share = 0.25 * region.material.density * mesh::volume(model.mesh, e);
    for (const auto n : model.mesh.tets[e]) mass[n] += share;
  }
  return mass;
}

void add_body_forces(const Model& model, const std::vector<std::vector<double>>& mass, double t, std::vector<Vec3>& f) {
  for (std::size_t k = 0; k < model.body_forces.size(); ++k) {
    const Vec3 a = model.body_forces[k].acceleration(t);
    for (std::size_t i = 0; i < f.size(); ++i) f[i] += mass[k][i] * a;
  }
}

}  // namespace carus::fem
