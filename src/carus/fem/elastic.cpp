// SPDX-License-Identifier: Apache-2.0
#include "carus/fem/elastic.hpp"

#include <Eigen/Cholesky>
#include <cmath>
#include <limits>

#include "carus/core/error.hpp"
#include "carus/core/parallel.hpp"
#include "carus/fem/element_block.hpp"
#include "carus/material/active_strain.hpp"
#include "carus/material/fibre.hpp"
#include "carus/material/hessian.hpp"
#include "carus/material/law.hpp"
#include "carus/material/principal.hpp"

namespace carus::fem {

namespace {

using material::Mat9;
constexpr std::size_t chunk = 512;
constexpr double infinity = std::numeric_limits<double>::infinity();

bool small_strain(const Region& r) { return r.material.law == material::Law::hooke_small_strain; }
bool fibrous(const Region& r) { return r.fibres && r.material.fibre_k1 > 0; }

Mat3 green_lagrange(const Mat3& F) {
  const Mat3 H = F - Mat3::Identity();
  return 0.5 * (H + H.transpose() + H.transpose() * H);
}

std::vector<mesh::Tet> deformable(const Model& model) {
  std::vector<mesh::Tet> out;
  for (std::size_t e = 0; e < model.mesh.tets.size(); ++e)
    if (!model.regions[model.mesh.labels[e]].rigid) out.push_back(model.mesh.tets[e]);
  return out;
}

material::Fibre<double> fibre(const Model& model, std::int32_t element) {
  const auto& m = model.regions[model.mesh.labels[element]].material;
  const Vec3& a = model.fibre[element];
  return {m.fibre_k1, m.fibre_k2, {a.x(), a.y(), a.z()}};
}

/// A tet's matrix V g_a A g_b from dP_dF; blocks of corners 1..3.
void add_blocks(const Mat9& A, const Mat3& B, double volume, TetMatrix& K) {
  Eigen::Matrix<double, 9, 9> AG;  // columns: dP for u_b along each axis
  for (int b = 0; b < 3; ++b)
    AG.middleCols<3>(3 * b) =
        B(b, 0) * A.middleCols<3>(0) + B(b, 1) * A.middleCols<3>(3) + B(b, 2) * A.middleCols<3>(6);
  for (int a = 0; a < 3; ++a)
    for (int b = a; b < 3; ++b) {
      const auto columns = AG.middleCols<3>(3 * b);
      K[tet_block(a + 1, b + 1)] = volume * (B(a, 0) * columns.middleRows<3>(0) + B(a, 1) * columns.middleRows<3>(3) +
                                             B(a, 2) * columns.middleRows<3>(6));
    }
}

}  // namespace

Elastic::Elastic(const Model& model)
    : model_(model), tets_(deformable(model)), matrix_(tets_, model.mesh.nodes.size()), parts_(tets_.size()) {
  for (std::size_t e = 0; e < model.mesh.tets.size(); ++e) {
    const auto r = model.mesh.labels[e];
    if (model.regions[r].rigid) continue;
    Element element{inverse_edges(model.mesh, e), std::int32_t(e)};
    if (!model.regions[r].material.prony.empty()) {
      CARUS_ASSERT(model.regions[r].material.prony.size() <= 4);
      element.past = std::int32_t(past_.size());
      past_.emplace_back();
    }
    elements_.push_back(element);
    regions_.push_back(r);
    volume_.push_back(mesh::volume(model.mesh, e));
  }
  if (model.retraction.kind != Retraction::Kind::off) {
    std::vector<std::int32_t> index(model.mesh.tets.size(), -1);
    for (std::size_t i = 0; i < model.retraction.elements.size(); ++i)
      index[std::size_t(model.retraction.elements[i])] = std::int32_t(i);
    rest_inverse_.resize(model.retraction.elements.size());
    for (auto& element : elements_) {
      element.retracting = index[std::size_t(element.element)];
      if (element.retracting >= 0) rest_inverse_[std::size_t(element.retracting)] = element.B;
    }
  }
  nodal_ = std::make_unique<NodalVolume>(model, tets_, regions_, volume_);
  strain_.resize(tets_.size()), corner_.resize(tets_.size());
  prony_.resize(model.regions.size());
  relaxed_.assign(model.regions.size(), 1.0);
}

void Elastic::set_rest_length(const RestLength& rest_length) {
  const auto& r = model_.retraction;
  parallel::for_chunks(elements_.size(), chunk, [&](std::size_t begin, std::size_t end, std::size_t) {
    for (std::size_t e = begin; e < end; ++e) {
      const auto i = elements_[e].retracting;
      if (i < 0) continue;
      elements_[e].B =
          rest_inverse_[std::size_t(i)] *
          material::inverse_active_strain(rest_length.of(std::size_t(i)), r.meridian[i], r.normal[i], r.dome[i]);
    }
  });
}

void Elastic::begin_step(double dt) {
  for (std::size_t r = 0; r < prony_.size(); ++r) {
    prony_[r].clear();
    relaxed_[r] = 1;
    for (const auto& term : model_.regions[r].material.prony) {
      prony_[r].push_back(material::PronyFactors::of(term.g, term.tau, dt));
      relaxed_[r] -= term.g * (1 - prony_[r].back().ramp);
    }
  }
  for (std::size_t e = 0; e < elements_.size(); ++e) {
    if (elements_[e].past < 0) continue;
    Past& past = past_[std::size_t(elements_[e].past)];
    past.now.setZero();
    const auto& terms = prony_[std::size_t(regions_[e])];
    for (std::size_t k = 0; k < terms.size(); ++k)
      past.now += terms[k].g * (terms[k].decay * past.h[k] - terms[k].ramp * past.s_iso);
  }
}

double Elastic::end_step(const std::vector<Vec3>& x) {
  return parallel::sum_chunks(elements_.size(), chunk, [&](std::size_t begin, std::size_t end) {
    double energy = 0;
    for (std::size_t e = begin; e < end; ++e) {
      if (elements_[e].past < 0) continue;
      Past& past = past_[std::size_t(elements_[e].past)];
      const Mat3 F = gradient(e, x);
      const Mat3 S = F.inverse() * isochoric_stress(e, F), E = green_lagrange(F);
      const auto& terms = prony_[std::size_t(regions_[e])];
      Mat3 taken = Mat3::Zero();  // twice its mean over the step
      for (std::size_t k = 0; k < terms.size(); ++k) {
        taken += terms[k].g * (past.s_iso - past.h[k]);
        past.h[k] = terms[k].decay * past.h[k] + terms[k].ramp * (S - past.s_iso);
        taken += terms[k].g * (S - past.h[k]);
      }
      energy += 0.5 * volume_[e] * taken.cwiseProduct(E - past.strain).sum();
      past.s_iso = S, past.strain = E;
    }
    return energy;
  });
}

Mat3 Elastic::gradient(std::size_t e, const std::vector<Vec3>& x) const {
  const auto& t = tets_[e];
  Mat3 D;
  for (int a = 0; a < 3; ++a) D.col(a) = x[t[a + 1]] - x[t[0]];
  return D * elements_[e].B;
}

void Elastic::update_nodal_volume(const std::vector<Vec3>& x) {
  nodal_energy_ = 0;
  if (!nodal_->any()) return;
  parallel::for_chunks(tets_.size(), chunk, [&](std::size_t begin, std::size_t end, std::size_t) {
    for (std::size_t e = begin; e < end; ++e) {
      if (!nodal_->averages(e)) continue;
      const auto F = material::to_tensor(gradient(e, x));
      strain_[e] = small_strain(model_.regions[regions_[e]]) ? material::HookeSmallStrain<double>::volume_strain(F)
                                                             : material::FiniteVolume<double>::volume_strain(F);
    }
  });
  nodal_energy_ = nodal_->update(strain_);
}

/// [J/m^3], without the volumetric part where its pressure is averaged.
double Elastic::density(std::size_t e, const Mat3& F, bool with_past) const {
  const auto& region = model_.regions[regions_[e]];
  const auto f = material::to_tensor(F);
  if (!small_strain(region) && !(F.determinant() > 0)) return infinity;
  double volumetric = 0;
  double w = material::with_law<double>(region.material, [&](const auto& law) {
    using Law = std::decay_t<decltype(law)>;
    if (!nodal_->averages(e)) volumetric = Law::volume_energy(region.material.bulk_modulus(), Law::volume_strain(f));
    return law.energy(f);
  });
  if (fibrous(region)) w += fibre(model_, elements_[e].element).energy(f);
  if (!with_past || elements_[e].past < 0) return w + volumetric;
  const Mat3& S = past_[std::size_t(elements_[e].past)].now;
  return relaxed_[regions_[e]] * w + S.cwiseProduct(green_lagrange(F)).sum() + volumetric;
}

double Elastic::energy(const std::vector<Vec3>& x) {
  update_nodal_volume(x);
  return nodal_energy_ + parallel::sum_chunks(tets_.size(), chunk, [&](std::size_t begin, std::size_t end) {
           double sum = 0;
           for (std::size_t e = begin; e < end; ++e) sum += volume_[e] * density(e, gradient(e, x), true);
           return sum;
         });
}

double Elastic::stored(const std::vector<Vec3>& x) {
  update_nodal_volume(x);
  return nodal_energy_ + parallel::sum_chunks(tets_.size(), chunk, [&](std::size_t begin, std::size_t end) {
           double sum = 0;
           for (std::size_t e = begin; e < end; ++e) sum += volume_[e] * density(e, gradient(e, x), false);
           return sum;
         });
}

Mat3 Elastic::isochoric_stress(std::size_t e, const Mat3& F) const {
  const auto& region = model_.regions[regions_[e]];
  const auto f = material::to_tensor(F);
  material::Mat3T<double> P = material::with_law<double>(region.material, [&](const auto& law) {
    material::Mat3T<double> iso;
    law.first_piola(f, law.volume_strain(f), 0.0, iso);
    return iso;
  });
  if (fibrous(region)) fibre(model_, elements_[e].element).add_first_piola(f, P);
  return material::to_eigen(P);
}

Mat3 Elastic::stress(std::size_t e, const Mat3& F) const {
  const auto& region = model_.regions[regions_[e]];
  const auto f = material::to_tensor(F);
  Mat3 P = isochoric_stress(e, F);
  if (elements_[e].past >= 0) P = relaxed_[regions_[e]] * P + F * past_[std::size_t(elements_[e].past)].now;
  return P + material::with_law<double>(region.material, [&](const auto& law) {
           using Law = std::decay_t<decltype(law)>;
           const double p = nodal_->averages(e)
                                ? nodal_->pressure(e)
                                : Law::volume_pressure(region.material.bulk_modulus(), law.volume_strain(f));
           return material::to_eigen(law.volume_gradient(f) * p);
         });
}

void Elastic::add_gradient(const std::vector<Vec3>& x, std::vector<Vec3>& g) {
  update_nodal_volume(x);
  parallel::for_chunks(tets_.size(), chunk, [&](std::size_t begin, std::size_t end, std::size_t) {
    for (std::size_t e = begin; e < end; ++e) {
      const Mat3 f = volume_[e] * stress(e, gradient(e, x)) * elements_[e].B.transpose();
      for (int a = 0; a < 3; ++a) corner_[e][a + 1] = f.col(a);
      corner_[e][0] = -f.rowwise().sum();
    }
  });
  const auto &begin_of = matrix_.around_begin(), &around = matrix_.around();
  parallel::for_chunks(g.size(), chunk, [&](std::size_t begin, std::size_t end, std::size_t) {
    for (std::size_t i = begin; i < end; ++i)
      for (auto k = begin_of[i]; k < begin_of[i + 1]; ++k) g[i] += corner_[std::size_t(around[k] / 4)][around[k] % 4];
  });
}

void Elastic::linearise(const std::vector<Vec3>& x) {
  update_nodal_volume(x);
  parallel::for_chunks(tets_.size(), chunk, [&](std::size_t begin, std::size_t end, std::size_t) {
    for (std::size_t e = begin; e < end; ++e) {
      const Mat3 F = gradient(e, x);
      tet_matrix(e, F, parts_[e]);
      if (!nodal_->averages(e)) continue;
      const Mat3 n = small_strain(model_.regions[regions_[e]])
                         ? Mat3(Mat3::Identity())
                         : material::to_eigen(material::cofactor(material::to_tensor(F)));
      const Mat3 f = volume_[e] * n * elements_[e].B.transpose();
      for (int a = 0; a < 3; ++a) corner_[e][a + 1] = f.col(a);
      corner_[e][0] = -f.rowwise().sum();
    }
  });
  matrix_.assemble(parts_);
  if (nodal_->any()) nodal_->linearise(corner_);
}

void Elastic::tet_matrix(std::size_t e, const Mat3& F, TetMatrix& K) const {
  const auto& region = model_.regions[regions_[e]];
  double pressure = 0, stiffness = 0;
  if (nodal_->averages(e)) {
    pressure = nodal_->pressure(e);
  } else if (!small_strain(region)) {
    const double bulk = region.material.bulk_modulus();
    const double strain = material::FiniteVolume<double>::volume_strain(material::to_tensor(F));
    pressure = material::FiniteVolume<double>::volume_pressure(bulk, strain);
    stiffness = material::FiniteVolume<double>::volume_stiffness(bulk, strain);
  } else {
    stiffness = region.material.bulk_modulus();
  }
  if (small_strain(region) || fibrous(region) || elements_[e].past >= 0)
    general_matrix(e, F, pressure, stiffness, K);
  else
    isotropic_matrix(e, F, pressure, stiffness, K);
  // Corner 0 takes minus the sum of the others.
  const Mat3 &K11 = K[4], &K12 = K[5], &K13 = K[6], &K22 = K[7], &K23 = K[8], &K33 = K[9];
  K[1] = -(K11 + K12.transpose() + K13.transpose());
  K[2] = -(K12 + K22 + K23.transpose());
  K[3] = -(K13 + K23 + K33);
  K[0] = -(K[1] + K[2] + K[3]);
}

void Elastic::isotropic_matrix(std::size_t e, const Mat3& F, double pressure, double stiffness, TetMatrix& K) const {
  const auto& m = model_.regions[regions_[e]].material;
  const material::PrincipalFrame frame(F);
  material::PrincipalHessian h;
  switch (m.law) {
    case material::Law::neo_hooke:
      add_principal(material::NeoHooke<double>(m.c10), frame.s, h);
      break;
    case material::Law::mooney_rivlin:
      add_principal(material::MooneyRivlin<double>(m.c10, m.c01), frame.s, h);
      break;
    case material::Law::hooke_corotated:
      add_principal(material::HookeCorotated<double>(m.shear_modulus()), frame.s, h);
      break;
    case material::Law::hooke_small_strain:
      CARUS_ASSERT(false);
  }
  add_principal_volume(pressure, stiffness, frame.s, h);
  project_positive(h);
  // In the frame dF_jk of plane i has (shear + turn)/2 on itself and (shear - turn)/2 on dF_kj.
  const Vec3 own = 0.5 * (h.shear + h.turn), cross = 0.5 * (h.shear - h.turn);
  const Mat3 G = elements_[e].B * frame.V;  // rows: gradients of corners 1..3
  for (int a = 0; a < 3; ++a)
    for (int b = a; b < 3; ++b) {
      Mat3 k;
      for (int i = 0; i < 3; ++i) {
        const int j = (i + 1) % 3, l = (i + 2) % 3;
        k(i, i) = h.stretch(i, i) * G(a, i) * G(b, i) + own[l] * G(a, j) * G(b, j) + own[j] * G(a, l) * G(b, l);
        k(i, j) = h.stretch(i, j) * G(a, i) * G(b, j) + cross[l] * G(a, j) * G(b, i);
        k(j, i) = h.stretch(i, j) * G(a, j) * G(b, i) + cross[l] * G(a, i) * G(b, j);
      }
      K[tet_block(a + 1, b + 1)].noalias() = volume_[e] * (frame.U * k * frame.U.transpose());
    }
}

void Elastic::general_matrix(std::size_t e, const Mat3& F, double pressure, double stiffness, TetMatrix& K) const {
  const auto& region = model_.regions[regions_[e]];
  const auto f = material::to_tensor(F);
  const bool with_fibre = fibrous(region);
  Mat9 A = material::with_law<double>(region.material, [&](const auto& law) {
    const auto n = law.volume_gradient(f);
    Mat9 a;
    for (int k = 0; k < 9; ++k) {
      Mat3 unit = Mat3::Zero();
      unit(k % 3, k / 3) = 1;
      const auto df = material::to_tensor(unit);
      auto dP = law.first_piola_rate(f, df);
      if (with_fibre) dP += fibre(model_, elements_[e].element).first_piola_rate(f, df);
      dP = dP * relaxed_[regions_[e]] + n * (stiffness * contract(n, df)) + law.volume_gradient_rate(f, df) * pressure;
      const Mat3 column = material::to_eigen(dP);
      a.col(k) = Eigen::Map<const Eigen::Vector<double, 9>>(column.data());
    }
    return a;
  });
  A = (0.5 * (A + A.transpose())).eval();
  if (elements_[e].past >= 0) {
    const Mat3& S = past_[std::size_t(elements_[e].past)].now;
    for (int j = 0; j < 3; ++j)
      for (int l = 0; l < 3; ++l)
        for (int i = 0; i < 3; ++i) A(3 * j + i, 3 * l + i) += S(j, l);
  }
  if (!small_strain(region) && Eigen::LLT<Mat9>(A).info() != Eigen::Success) A = material::project_positive(A);
  add_blocks(A, elements_[e].B, volume_[e], K);
}

void Elastic::multiply(const std::vector<Vec3>& u, std::vector<Vec3>& y) const {
  matrix_.multiply(u, y);
  nodal_->add_product(u, y);
}

void Elastic::diagonal(std::vector<Mat3>& d) const {
  for (std::size_t i = 0; i < d.size(); ++i) d[i] = matrix_.diagonal(i);
  nodal_->add_diagonal(d);
}

Elastic::Volumes Elastic::volumes(const std::vector<Vec3>& x) const {
  Volumes v;
  for (std::size_t e = 0; e < tets_.size(); ++e) {
    const double J = gradient(e, x).determinant();
    v.inverted += !(J > 0);
    if (!(J >= v.min_J)) v.min_J = J, v.worst_element = elements_[e].element;
  }
  return v;
}

std::size_t Elastic::history_size() const { return past_.size() * 54; }

std::vector<double> Elastic::save() const {
  std::vector<double> out;
  out.reserve(history_size());
  for (const Past& p : past_) {
    for (const Mat3* m : {&p.s_iso, &p.strain, &p.h[0], &p.h[1], &p.h[2], &p.h[3]})
      out.insert(out.end(), m->data(), m->data() + 9);
  }
  return out;
}

void Elastic::load(const double* saved) {
  for (Past& p : past_) {
    for (Mat3* m : {&p.s_iso, &p.strain, &p.h[0], &p.h[1], &p.h[2], &p.h[3]}) {
      *m = Eigen::Map<const Mat3>(saved);
      saved += 9;
    }
  }
}

}  // namespace carus::fem
