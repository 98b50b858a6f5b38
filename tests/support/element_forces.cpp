// SPDX-License-Identifier: Apache-2.0
#include "element_forces.hpp"

#include <algorithm>

#include "carus/solve/energy.hpp"

namespace carus::models {

namespace {

void gather(fem::Block& b, const std::vector<Vec3>& x) {
  for (std::size_t l = 0; l < b.nodes.size(); ++l) {
    const Vec3& p = x[b.nodes[l]];
    b.x[l] = {{float(p.x()), float(p.y()), float(p.z()), 0.f}};
  }
}

}  // namespace

double relax(const fem::Model& model, std::vector<fem::Block>& blocks, const std::vector<Vec3>& x, double dt,
             const fem::Kernel& kernel) {
  double energy = 0;
  for (auto& b : blocks) {
    gather(b, x);
    for (std::size_t r = 0; r < b.runs.size(); ++r) {
      const auto& run = b.runs[r];
      auto material = solve::kernel_material(model.regions[run.region]);
      if (material.prony_terms == 0) continue;
      solve::set_relaxation(material, model.regions[run.region], dt);
      energy += kernel.relax(b.batches.data() + run.begin, run.end - run.begin, material, b.x.data(),
                             b.history.data() + b.history_begin[r]);
    }
  }
  return energy;
}

Forces element_forces(const fem::Model& model, std::vector<fem::Block>& blocks, const std::vector<Vec3>& x,
                      const fem::Kernel& kernel) {
  Forces out;
  out.at.assign(x.size(), Vec3::Zero());
  for (auto& b : blocks) {
    gather(b, x);
    std::fill(b.f.begin(), b.f.end(), fem::Float4{{0, 0, 0, 0}});
    for (std::size_t r = 0; r < b.runs.size(); ++r) {
      const auto& run = b.runs[r];
      const auto material = solve::kernel_material(model.regions[run.region]);
      const auto report = kernel.forces(b.batches.data() + run.begin, run.end - run.begin, material, b.x.data(),
                                        b.f.data(), nullptr, b.history.data() + b.history_begin[r]);
      out.report.min_J = std::min(out.report.min_J, report.min_J);
      out.report.inverted += report.inverted;
      if (report.worst_element >= 0) out.report.worst_element = report.worst_element;
    }
    for (std::size_t l = 0; l < b.nodes.size(); ++l) out.at[b.nodes[l]] += Vec3(b.f[l].v[0], b.f[l].v[1], b.f[l].v[2]);
  }
  return out;
}

}  // namespace carus::models
