// SPDX-License-Identifier: Apache-2.0
#include "scenes.hpp"

#include "carus/mesh/shapes.hpp"
#include "carus/solve/energy.hpp"

namespace carus::bench {

fem::Model block(bool average_nodal_pressure) {
  fem::Model model;
  model.mesh = mesh::shapes::box({0, 0, 0}, {0.1, 0.1, 0.1}, 20, 20, 21);
  material::Material m;
  m.c10 = 30e3, m.poisson = 0.45, m.average_nodal_pressure = average_nodal_pressure;
  model.regions = {{"block", "block", m}};
  model.blocked.assign(model.mesh.nodes.size(), 0);
  return model;
}

Kernel::Kernel(const fem::Model& model)
    : blocks_(fem::make_blocks(model, 16)), material_(solve::kernel_material(model.regions[0])) {
  for (auto& b : blocks_) {
    for (std::size_t i = 0; i < b.nodes.size(); ++i) {
      const Vec3 x = 1.01 * model.mesh.nodes[b.nodes[i]];
      b.x[i] = {{float(x.x()), float(x.y()), float(x.z()), 0.f}};
    }
  }
}

fem::KernelReport Kernel::forces() {
  fem::KernelReport report;
  for (auto& b : blocks_) {
    report =
        fem::kernel().forces(b.batches.data(), b.batches.size(), material_, b.x.data(), b.f.data(), nullptr, nullptr);
  }
  return report;
}

solve::ExplicitOptions step_options(int threads) {
  solve::ExplicitOptions options;
  options.labour_duration = options.pseudo_duration = 10, options.time_step = 1e-5, options.threads = threads;
  return options;
}

}  // namespace carus::bench
