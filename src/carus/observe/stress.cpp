// SPDX-License-Identifier: Apache-2.0
#include "carus/observe/stress.hpp"

#include <Eigen/LU>
#include <cmath>
#include <limits>

#include "carus/core/parallel.hpp"
#include "carus/fem/element_block.hpp"
#include "carus/material/hessian.hpp"
#include "carus/material/law.hpp"

namespace carus::observe {
namespace {

constexpr double nan = std::numeric_limits<double>::quiet_NaN();

Mat3 edges(const std::vector<Vec3>& x, const mesh::Tet& t) {
  Mat3 D;
  D << x[t[1]] - x[t[0]], x[t[2]] - x[t[0]], x[t[3]] - x[t[0]];
  return D;
}

/// sigma = P F^T/J, with dU/dJ where the pressure is the element's own, else `averaged`.
Mat3 cauchy(const material::Material& m, const Mat3& F, double averaged) {
  return material::with_law<double>(m, [&](const auto& law) -> Mat3 {
    using Law = std::decay_t<decltype(law)>;
    const auto f = material::to_tensor(F);
    const double strain = Law::volume_strain(f);
    const double pressure = m.average_nodal_pressure ? averaged : Law::volume_pressure(m.bulk_modulus(), strain);
    material::Mat3T<double> P;
    law.first_piola(f, strain, pressure, P);
    return material::to_eigen(P) * F.transpose() / F.determinant();
  });
}

}  // namespace

Stress::Stress(const fem::Model& model) : model_(model) {
  for (std::size_t e = 0; e < model.mesh.tets.size(); ++e) {
    rest_volume_.push_back(mesh::volume(model.mesh, e));
    inverse_edges_.push_back(fem::inverse_edges(model.mesh, e));
  }
}

/// As fem::NodalPressure: p_a = dU/dJ at J_a = sum V / sum V0 within one region, an element takes the mean of its four.
std::vector<double> Stress::averaged_pressures(const std::vector<Vec3>& x) const {
  const auto& mesh = model_.mesh;
  std::vector<double> out(mesh.tets.size(), 0.0);
  for (std::size_t r = 0; r < model_.regions.size(); ++r) {
    const auto& m = model_.regions[r].material;
    if (!m.average_nodal_pressure || model_.regions[r].rigid) continue;
    std::vector<double> rest(x.size(), 0.0), now = rest;
    const auto each = [&](auto&& f) {
      for (std::size_t e = 0; e < mesh.tets.size(); ++e) {
        if (mesh.labels[e] == std::int32_t(r)) f(e);
      }
    };
    each([&](std::size_t e) {
      const double volume = edges(x, mesh.tets[e]).determinant() / 6;
      for (const auto n : mesh.tets[e]) rest[n] += rest_volume_[e], now[n] += volume;
    });
    each([&](std::size_t e) {
      for (const auto n : mesh.tets[e])
        out[e] += 0.25 * material::FiniteVolume<double>::volume_pressure(m.bulk_modulus(), now[n] / rest[n] - 1);
    });
  }
  return out;
}

Stress::Field Stress::field(const std::vector<Vec3>& x) const {
  const auto& mesh = model_.mesh;
  const auto averaged = averaged_pressures(x);
  Field out;
  out.tet.assign(mesh.tets.size(), Sym{});
  out.von_mises.assign(mesh.tets.size(), 0.0), out.pressure = out.von_mises;
  parallel::for_chunks(mesh.tets.size(), 4096, [&](std::size_t begin, std::size_t end, std::size_t) {
    for (std::size_t e = begin; e < end; ++e) {
      const auto& region = model_.regions[mesh.labels[e]];
      if (region.rigid) continue;
      const bool whole = region.material.prony.empty() && !(region.fibres && region.material.fibre_k1 > 0);
      const Mat3 s = whole ? cauchy(region.material, edges(x, mesh.tets[e]) * inverse_edges_[e], averaged[e])
                           : Mat3(Mat3::Constant(nan));
      out.tet[e] = {s(0, 0), s(1, 1), s(2, 2), s(0, 1), s(1, 2), s(0, 2)};
      out.pressure[e] = -s.trace() / 3;
      out.von_mises[e] = std::sqrt(1.5) * (s + out.pressure[e] * Mat3::Identity()).norm();
    }
  });
  for (const auto e : model_.retraction.elements) {
    out.tet[e].fill(nan);
    out.pressure[e] = out.von_mises[e] = nan;
  }
  out.node.assign(x.size(), Sym{});
  std::vector<double> weight(x.size(), 0.0);
  for (std::size_t e = 0; e < mesh.tets.size(); ++e) {
    if (model_.regions[mesh.labels[e]].rigid) continue;
    for (const auto n : mesh.tets[e]) {
      weight[n] += rest_volume_[e];
      for (int k = 0; k < 6; ++k) out.node[n][k] += rest_volume_[e] * out.tet[e][k];
    }
  }
  for (std::size_t i = 0; i < x.size(); ++i) {
    for (double& s : out.node[i]) s = weight[i] > 0 ? s / weight[i] : 0;
  }
  return out;
}

}  // namespace carus::observe
