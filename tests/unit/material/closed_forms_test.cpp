// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include "law_cases.hpp"

namespace carus::material {
namespace {

constexpr double rounding = 1e-12 * shear;

/// Nominal stress along x when an isochoric diag(l1, l2, l3) is held by a pressure that leaves the last face free.
template <class Law>
double free_third(const Law& law, const Vec3& stretches) {
  const Mat3 P = first_piola(law, bulk, stretches.asDiagonal());
  return P(0, 0) - stretches[2] / stretches[0] * P(2, 2);
}

constexpr double c10 = 0.3 * shear, c01 = 0.2 * shear;  // of mooney_rivlin()

TEST(closed_form, uniaxial_tension) {
  for (const double l : {0.5, 0.9, 1.3, 2.5}) {
    const Vec3 stretches(l, 1 / std::sqrt(l), 1 / std::sqrt(l));
    // Treloar 1975, eq. 4.20 and 5.11.
    EXPECT_NEAR(free_third(neo_hooke<double>(), stretches), shear * (l - 1 / (l * l)), 20 * rounding);
    EXPECT_NEAR(free_third(mooney_rivlin<double>(), stretches), 2 * (c10 + c01 / l) * (l - 1 / (l * l)), 20 * rounding);
    EXPECT_NEAR(free_third(HookeCorotated<double>(shear), stretches),
                2 * shear * ((2 * l - 2 * stretches[1]) / 3 + (l - stretches[1]) / 3 * stretches[1] / l),
                20 * rounding);
  }
}

TEST(closed_form, uniaxial_compressible_neo_hooke) {
  const double l = 1.4, t = 0.9, J = l * t * t;
  const Mat3 P = first_piola(neo_hooke<double>(), bulk, Vec3(l, t, t).asDiagonal());
  // sigma = 2 C10 J^(-5/3) dev(B) + K (J - 1) I, P = J sigma F^-T.
  const double deviatoric = shear * std::pow(J, -5.0 / 3.0) * (l * l - t * t), p = 0.5 * bulk * (J - 1 / J);
  EXPECT_NEAR(P(0, 0), J / l * (2.0 / 3.0 * deviatoric + p), 20 * rounding);
  EXPECT_NEAR(P(1, 1), J / t * (-1.0 / 3.0 * deviatoric + p), 20 * rounding);
}

TEST(closed_form, uniaxial_hooke_is_youngs_modulus) {
  const double E = 9 * bulk * shear / (3 * bulk + shear), nu = E / (2 * shear) - 1, strain = 0.01;
  const Mat3 P = first_piola(HookeSmallStrain<double>(shear), bulk,
                             Vec3(1 + strain, 1 - nu * strain, 1 - nu * strain).asDiagonal());
  EXPECT_NEAR(P(0, 0), E * strain, rounding);
  EXPECT_NEAR(P(1, 1), 0, rounding);
}

TEST(closed_form, equibiaxial_tension) {
  for (const double l : {0.8, 1.2, 1.8}) {
    const Vec3 stretches(l, l, 1 / (l * l));
    EXPECT_NEAR(free_third(neo_hooke<double>(), stretches), shear * (l - std::pow(l, -5)), 20 * rounding);
    EXPECT_NEAR(free_third(mooney_rivlin<double>(), stretches), 2 * (c10 + c01 * l * l) * (l - std::pow(l, -5)),
                20 * rounding);
  }
}

TEST(closed_form, simple_shear_and_its_normal_stresses) {
  const double g = 0.7;
  Mat3 F = Mat3::Identity();
  F(0, 1) = g;
  const Mat3 neo = first_piola(neo_hooke<double>(), bulk, F) * F.transpose();
  EXPECT_NEAR(neo(0, 1), shear * g, rounding);
  EXPECT_NEAR(neo(0, 0) - neo(1, 1), shear * g * g, rounding);
  const Mat3 mooney = first_piola(mooney_rivlin<double>(), bulk, F) * F.transpose();
  EXPECT_NEAR(mooney(0, 1), 2 * (c10 + c01) * g, rounding);
  EXPECT_NEAR(mooney(0, 0) - mooney(2, 2), 2 * c10 * g * g, rounding);
  EXPECT_NEAR(mooney(1, 1) - mooney(2, 2), -2 * c01 * g * g, rounding);
  EXPECT_NEAR(first_piola(HookeSmallStrain<double>(shear), bulk, F)(0, 1), shear * g, rounding);
}

TEST(closed_form, fibre_in_tension) {
  const double k1 = 10e3, k2 = 1.5, l = 1.2, e = l * l - 1;
  const Fibre<double> law(k1, k2, {1, 0, 0});
  EXPECT_NEAR(free_third(law, {l, 1 / std::sqrt(l), 1 / std::sqrt(l)}), 2 * k1 * e * std::exp(k2 * e * e) * l,
              rounding);
  EXPECT_NEAR(free_third(law, {0.8, 1 / std::sqrt(0.8), 1 / std::sqrt(0.8)}), 0, rounding);  // no compression
}

}  // namespace
}  // namespace carus::material
