// SPDX-License-Identifier: Apache-2.0
#include "carus/fem/elastic.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "carus/material/hessian.hpp"
#include "carus/material/law.hpp"
#include "carus/material/principal.hpp"
#include "support/models.hpp"

namespace carus::fem {
namespace {

struct Case {
  const char* name;
  material::Law law;
  double poisson;
  bool nodal, fibres, prony;
};

Model model_of(const Case& c) {
  auto material = models::soft(c.law, 20e3, c.poisson);
  material.average_nodal_pressure = c.nodal;
  if (c.prony) material.prony = {{0.5, 10}, {0.2, 100}};
  if (c.fibres) material.fibre_k1 = 10e3, material.fibre_k2 = 2;
  auto mesh = shapes::box(Vec3::Zero(), {0.03, 0.02, 0.02}, 3, 2, 2);
  shapes::shake(mesh, 0.003);
  Model m = models::of(std::move(mesh), {material});
  if (c.fibres) {
    m.regions[0].fibres = true;
    m.fibre.assign(m.mesh.tets.size(), Vec3(1, 2, -1).normalized());
  }
  return m;
}

/// Smooth, of mean stretch `size`, and turned unless rotations would count as strain.
std::vector<Vec3> deformed(const Model& m, double size) {
  const bool small = m.regions[0].material.law == material::Law::hooke_small_strain;
  const Mat3 R = models::skew_rotation(small ? 0 : 0.7);
  std::vector<Vec3> x;
  for (const Vec3& X : m.mesh.nodes)
    x.push_back(R * (X + size * Vec3(0.8 * X.x() + 9 * X.y() * X.z(), 0.3 * X.x() - 0.2 * X.y() + 12 * X.x() * X.x(),
                                     0.5 * X.y() + 0.1 * X.z())));
  return x;
}

std::vector<Vec3> along(const Model& m) {
  std::vector<Vec3> u;
  for (const Vec3& X : m.mesh.nodes)
    u.push_back(Vec3(std::sin(90 * X.y()), std::cos(110 * X.z()), std::sin(100 * X.x() + 1)));
  return u;
}

double dot(const std::vector<Vec3>& a, const std::vector<Vec3>& b) {
  double sum = 0;
  for (std::size_t i = 0; i < a.size(); ++i) sum += a[i].dot(b[i]);
  return sum;
}

std::vector<Vec3> moved(std::vector<Vec3> x, double h, const std::vector<Vec3>& u) {
  for (std::size_t i = 0; i < x.size(); ++i) x[i] += h * u[i];
  return x;
}

class ElasticCases : public ::testing::TestWithParam<Case> {};

TEST_P(ElasticCases, GradientIsTheDerivativeOfTheEnergy) {
  const Model m = model_of(GetParam());
  Elastic elastic(m);
  if (GetParam().prony) {  // a past of its own
    elastic.begin_step(3);
    elastic.end_step(deformed(m, 0.1));
  }
  elastic.begin_step(2);
  const auto u = along(m);
  for (const double size : {0.0, 0.4}) {
    const auto x = deformed(m, size);
    std::vector<Vec3> g(x.size(), Vec3::Zero());
    elastic.add_gradient(x, g);
    const double slope = dot(g, u);
    const auto error = [&](double h) {
      return std::abs((elastic.energy(moved(x, h, u)) - elastic.energy(moved(x, -h, u))) / (2 * h) - slope);
    };
    if (size > 0) {
      ASSERT_GT(std::abs(slope), 1e-3);
    }
    // Central differences: the error falls with h^2. A quadratic energy has none but rounding.
    if (size > 0 && GetParam().law != material::Law::hooke_small_strain) {
      EXPECT_NEAR(std::log(error(8e-5) / error(2e-5)) / std::log(4.0), 2, 0.2) << error(8e-5) << " " << error(2e-5);
    }
    // At rest fibres begin to bear: their second derivative jumps, and the error falls with h only.
    EXPECT_LT(error(1e-6), 1e-3 * (std::abs(slope) + 1));
  }
}

TEST_P(ElasticCases, HessianIsTheDerivativeOfTheGradientWhereNothingIsProjected) {
  const Model m = model_of(GetParam());
  Elastic elastic(m);
  elastic.begin_step(2);
  const auto u = along(m);
  const auto x = deformed(m, 0.02);  // near rest every law is convex
  elastic.linearise(x);
  std::vector<Vec3> Hu(x.size());
  elastic.multiply(u, Hu);
  const auto error = [&](double h) {
    std::vector<Vec3> a(x.size(), Vec3::Zero()), b = a;
    elastic.add_gradient(moved(x, h, u), a);
    elastic.add_gradient(moved(x, -h, u), b);
    double sum = 0;
    for (std::size_t i = 0; i < x.size(); ++i) sum += ((a[i] - b[i]) / (2 * h) - Hu[i]).squaredNorm();
    return std::sqrt(sum);
  };
  const double scale = std::sqrt(dot(Hu, Hu));
  ASSERT_GT(scale, 1);
  // The projection leaves out the little that stresses this small make negative: rotations under compression.
  EXPECT_LT(error(1e-6), 0.02 * scale);
}

TEST_P(ElasticCases, HessianIsPositiveWhateverTheDeformation) {
  const Model m = model_of(GetParam());
  Elastic elastic(m);
  elastic.begin_step(2);
  const auto x = deformed(m, 0.8);
  ASSERT_TRUE(std::isfinite(elastic.energy(x)));
  elastic.linearise(x);
  auto u = along(m);
  std::vector<Vec3> Hu(x.size());
  for (int k = 0; k < 40; ++k) {
    for (std::size_t i = 0; i < u.size(); ++i)
      for (int c = 0; c < 3; ++c) u[i][c] = std::sin(double(i) * (k + 1.3) * 2.7 + c * 1.9);
    elastic.multiply(u, Hu);
    EXPECT_GE(dot(u, Hu), -1e-9 * std::sqrt(dot(Hu, Hu) * dot(u, u)));
  }
}

TEST_P(ElasticCases, DiagonalIsThatOfTheProduct) {
  const Model m = model_of(GetParam());
  Elastic elastic(m);
  elastic.begin_step(2);
  const auto x = deformed(m, 0.3);
  elastic.linearise(x);
  std::vector<Mat3> d(x.size());
  elastic.diagonal(d);
  for (const std::size_t i : {std::size_t(0), x.size() / 2}) {
    for (int k = 0; k < 3; ++k) {
      std::vector<Vec3> u(x.size(), Vec3::Zero()), Hu(x.size());
      u[i][k] = 1;
      elastic.multiply(u, Hu);
      EXPECT_LT((Hu[i] - d[i].col(k)).norm(), 1e-9 * Hu[i].norm());
    }
  }
}

TEST_P(ElasticCases, InversionCostsInfinity) {
  const auto& c = GetParam();
  if (c.law == material::Law::hooke_small_strain) return;  // knows no inversion
  const Model m = model_of(c);
  Elastic elastic(m);
  elastic.begin_step(2);
  auto x = m.mesh.nodes;
  for (Vec3& p : x) p.z() *= -1;
  EXPECT_TRUE(std::isinf(elastic.energy(x)));
  EXPECT_EQ(elastic.volumes(x).inverted, int(m.mesh.tets.size()));
}

INSTANTIATE_TEST_SUITE_P(
    Laws, ElasticCases,
    ::testing::Values(Case{"NeoHooke", material::Law::neo_hooke, 0.4, false, false, false},
                      Case{"NeoHookeNodal", material::Law::neo_hooke, 0.49, true, false, false},
                      Case{"MooneyRivlin", material::Law::mooney_rivlin, 0.45, false, false, false},
                      Case{"Corotated", material::Law::hooke_corotated, 0.3, false, false, false},
                      Case{"SmallStrain", material::Law::hooke_small_strain, 0.3, false, false, false},
                      Case{"SmallStrainNodal", material::Law::hooke_small_strain, 0.45, true, false, false},
                      Case{"Fibres", material::Law::neo_hooke, 0.45, false, true, false},
                      Case{"Relaxing", material::Law::neo_hooke, 0.45, false, false, true},
                      Case{"RelaxingFibresNodal", material::Law::mooney_rivlin, 0.45, true, true, true}),
    [](const auto& tested) { return tested.param.name; });

/// The principal form against the general one, at stretches that coincide and that do not.
template <class L>
void expect_same(const L& law) {
  for (const Vec3& s : {Vec3(1, 1, 1), Vec3(1.3, 1.3, 0.7), Vec3(0.5, 1.1, 2)}) {
    const Mat3 F = models::skew_rotation(0.4) * s.asDiagonal() * models::skew_rotation(1.1);
    const double bulk = 70e3, e = s.prod() - 1;
    const material::Mat9 A = material::dP_dF(law, bulk, F);
    const material::PrincipalFrame frame(F);
    material::PrincipalHessian h;
    add_principal(law, frame.s, h);
    add_principal_volume(L::volume_pressure(bulk, e), L::volume_stiffness(bulk, e), frame.s, h);
    const auto quadratic = [&](const Mat3& in_frame) {
      const Mat3 dF = frame.U * in_frame * frame.V.transpose();
      const Eigen::Vector<double, 9> v = Eigen::Map<const Eigen::Vector<double, 9>>(dF.data());
      return v.dot(A * v);
    };
    for (int i = 0; i < 3; ++i) {
      const int j = (i + 1) % 3, k = (i + 2) % 3;
      Mat3 shear = Mat3::Zero(), turn = shear, stretch = shear;
      shear(j, k) = shear(k, j) = std::sqrt(0.5);
      turn(j, k) = std::sqrt(0.5), turn(k, j) = -turn(j, k);
      stretch(i, i) = 1, stretch(j, j) = 2;
      const double scale = A.norm() * 1e-9;
      EXPECT_NEAR(quadratic(shear), h.shear[i], scale);
      EXPECT_NEAR(quadratic(turn), h.turn[i], scale);
      EXPECT_NEAR(quadratic(stretch), h.stretch(i, i) + 4 * h.stretch(i, j) + 4 * h.stretch(j, j), 10 * scale);
    }
  }
}

TEST(Principal, AgreesWithTheGeneralDerivative) {
  expect_same(material::NeoHooke<double>(10e3));
  expect_same(material::MooneyRivlin<double>(7e3, 5e3));
  expect_same(material::HookeCorotated<double>(12e3));
}

}  // namespace
}  // namespace carus::fem
