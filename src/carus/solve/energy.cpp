// SPDX-License-Identifier: Apache-2.0
#include "carus/solve/energy.hpp"

#include <cmath>

#include "carus/core/error.hpp"
#include "carus/core/parallel.hpp"
#include "carus/material/active_strain.hpp"
#include "carus/material/fibre.hpp"
#include "carus/material/hooke.hpp"
#include "carus/material/mooney_rivlin.hpp"
#include "carus/material/neo_hooke.hpp"

namespace carus::solve {

fem::KernelMaterial kernel_material(const fem::Region& region) {
  const auto& m = region.material;
  fem::KernelMaterial k{};
  k.law = m.law;
  k.c10 = float(m.c10), k.c01 = float(m.c01), k.bulk = float(m.bulk_modulus()), k.mu = float(m.shear_modulus());
  k.k1 = float(m.fibre_k1), k.k2 = float(m.fibre_k2);
  k.fibres = region.fibres && m.fibre_k1 > 0;
  k.prony_terms = int(m.prony.size());
  CARUS_ASSERT(k.prony_terms <= fem::max_prony_terms);
  return k;
}

void set_relaxation(fem::KernelMaterial& kernel, const fem::Region& region, double dt) {
  for (int i = 0; i < kernel.prony_terms; ++i) {
    const auto& branch = region.material.prony[std::size_t(i)];
    kernel.prony[i] = material::PronyFactors::of(branch.g, branch.tau, dt);
  }
}

Mat3 inverse_active_strain(const fem::Retraction& r, std::size_t i, double rest_length) {
  return material::inverse_active_strain(rest_length, r.meridian[i], r.normal[i], r.dome[i]);
}

namespace {

template <class Law>
double density(const Law& law, const material::Mat3T<double>& F, double bulk) {
  return law.energy(F) + Law::volume_energy(bulk, Law::volume_strain(F));
}

/// Where the pressure is a nodal average, its energy belongs to the nodes (fem::NodalPressure::energy).
double element_bulk(const material::Material& m) { return m.average_nodal_pressure ? 0 : m.bulk_modulus(); }

double energy_density(const material::Material& m, const material::Mat3T<double>& F) {
  switch (m.law) {
    case material::Law::neo_hooke:
      return density(material::NeoHooke<double>(m.c10), F, element_bulk(m));
    case material::Law::mooney_rivlin:
      return density(material::MooneyRivlin<double>(m.c10, m.c01), F, element_bulk(m));
    case material::Law::hooke_corotated:
      return density(material::HookeCorotated<double>(m.shear_modulus()), F, element_bulk(m));
    case material::Law::hooke_small_strain:
      return density(material::HookeSmallStrain<double>(m.shear_modulus()), F, element_bulk(m));
  }
  CARUS_ASSERT(false);
}

material::Mat3T<double> deformation_gradient(const mesh::Tet& t, const fem::Batch& batch, int lane,
                                             const std::vector<Vec3>& x) {
  Mat3 D, B;
  for (int a = 0; a < 3; ++a) D.col(a) = x[t[a + 1]] - x[t[0]];
  for (int k = 0; k < 9; ++k) B(k / 3, k % 3) = batch.B[k][lane];
  const Mat3 F = D * B;
  return {F(0, 0), F(0, 1), F(0, 2), F(1, 0), F(1, 1), F(1, 2), F(2, 0), F(2, 1), F(2, 2)};
}

}  // namespace

double element_relaxed(const fem::Model& model, const fem::Block& block, std::size_t batch, int lane,
                       const std::vector<Vec3>& x) {
  std::size_t run = 0;
  while (block.runs[run].end <= batch) ++run;
  const auto terms = model.regions[block.runs[run].region].material.prony.size();
  if (terms == 0) return 0;
  const auto past = block.history_begin[run] + (batch - block.runs[run].begin) * (fem::first_branch + terms);
  const auto& taken = block.history[past + fem::relaxed_stress].row;
  const material::Sym3T<double> D{taken[0][lane], taken[1][lane], taken[2][lane],
                                  taken[3][lane], taken[4][lane], taken[5][lane]};
  const fem::Batch& b = block.batches[batch];
  const auto F = deformation_gradient(model.mesh.tets[b.element[lane]], b, lane, x);
  return 0.5 * double(b.volume[lane]) * material::contract(D, material::right_strain(F));
}

double relaxed_energy(const fem::Model& model, const std::vector<fem::Block>& blocks, const std::vector<Vec3>& x) {
  return parallel::sum_chunks(blocks.size(), 1, [&](std::size_t i, std::size_t) {
    double sum = 0;
    if (blocks[i].history.empty()) return sum;
    for (std::size_t q = 0; q < blocks[i].batches.size(); ++q) {
      for (int l = 0; l < fem::lanes; ++l) sum += element_relaxed(model, blocks[i], q, l, x);
    }
    return sum;
  });
}

double element_energy(const fem::Model& model, const fem::Batch& batch, int lane, const std::vector<Vec3>& x) {
  const auto e = batch.element[lane];
  const auto F = deformation_gradient(model.mesh.tets[e], batch, lane, x);
  const auto& region = model.regions[model.mesh.labels[e]];
  double w = energy_density(region.material, F);
  if (region.fibres && region.material.fibre_k1 > 0) {
    const material::Vec3T<double> a{batch.fibre[0][lane], batch.fibre[1][lane], batch.fibre[2][lane]};
    w += material::Fibre<double>(region.material.fibre_k1, region.material.fibre_k2, a).energy(F);
  }
  return w * double(batch.volume[lane]);
}

double tether_energy(const fem::Model& model, const fem::State& state) {
  double sum = 0;
  for (const auto& tether : model.tethers) {
    const double out = tether.direction.dot(state.x[tether.node] - model.mesh.nodes[tether.node]);
    sum += 0.5 * tether.stiffness * out * out;
  }
  return sum;
}

double stored_energy(const fem::Model& model, const std::vector<fem::Block>& blocks, const fem::State& state) {
  double sum = parallel::sum_chunks(blocks.size(), 1, [&](std::size_t i, std::size_t) {
    double block = 0;
    for (const auto& batch : blocks[i].batches) {
      for (int l = 0; l < fem::lanes; ++l) {
        if (batch.volume[l] > 0) block += element_energy(model, batch, l, state.x);
      }
    }
    return block;
  });
  sum += tether_energy(model, state);
  for (std::size_t h = 0; h < model.hinges.size(); ++h)
    sum += 0.5 * model.hinges[h].stiffness * std::pow(state.hinge_angle[h], 2);
  return sum;
}

}  // namespace carus::solve
