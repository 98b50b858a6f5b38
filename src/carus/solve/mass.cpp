// SPDX-License-Identifier: Apache-2.0
#include "carus/solve/mass.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "carus/fem/element_block.hpp"

namespace carus::solve {

double critical_step(const fem::Model& model, std::size_t tet) {
  const Mat3 B = fem::inverse_edges(model.mesh, tet);
  const double gradients =
      B.squaredNorm() + B.colwise().sum().squaredNorm();  // rows of B: grad N_1..3; N_0 takes minus the sum
  const auto& m = model.regions[model.mesh.labels[tet]].material;
  const double c2 = (m.bulk_modulus() + 4.0 / 3.0 * m.shear_modulus()) / m.density;
  return 1 / std::sqrt(c2 * gradients);
}

Masses scaled_masses(const fem::Model& model, double dt, double safety) {
  Masses out;
  out.unscaled.assign(model.mesh.nodes.size(), 0.0);
  out.scaled = out.unscaled;
  out.critical_step = std::numeric_limits<double>::infinity();
  double mass = 0, added = 0;
  for (std::size_t e = 0; e < model.mesh.tets.size(); ++e) {
    const auto& region = model.regions[model.mesh.labels[e]];
    if (region.rigid) continue;
    const double step = critical_step(model, e);
    if (step < out.critical_step) out.critical_step = step, out.limiting_region = region.name;
    const double m = region.material.density * mesh::volume(model.mesh, e);
    const double factor = std::max(1.0, std::pow(dt / (safety * step), 2));
    for (const auto n : model.mesh.tets[e]) {
      out.unscaled[n] += 0.25 * m;
      out.scaled[n] += 0.25 * m * factor;
    }
    mass += m, added += m * (factor - 1);
  }
  out.added_fraction = mass > 0 ? added / mass : 0;
  return out;
}

}  // namespace carus::solve
