// SPDX-License-Identifier: Apache-2.0
#include "carus/material/material.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <limits>

#include "carus/material/law.hpp"
#include "law_cases.hpp"

namespace carus::material {
namespace {

TEST(material, moduli) {
  Material m;
  m.c10 = 30e3, m.c01 = 10e3, m.youngs_modulus = 23e6, m.poisson = 0.3;
  m.law = Law::neo_hooke;
  EXPECT_DOUBLE_EQ(m.shear_modulus(), 60e3);
  m.law = Law::mooney_rivlin;
  EXPECT_DOUBLE_EQ(m.shear_modulus(), 80e3);
  m.law = Law::hooke_small_strain;
  EXPECT_DOUBLE_EQ(m.shear_modulus(), 23e6 / 2.6);
  EXPECT_DOUBLE_EQ(m.bulk_modulus(), 23e6 / (3 * 0.4));
}

TEST(material, every_law_has_its_moduli_at_rest) {
  std::mt19937 random(1);
  const Mat3 F = Mat3::Identity() + 1e-7 * random_matrix(random), H = F - Mat3::Identity();
  Material m;
  m.c10 = 30e3, m.c01 = 10e3, m.youngs_modulus = 80e3;
  for (const Law law : {Law::hooke_small_strain, Law::hooke_corotated, Law::neo_hooke, Law::mooney_rivlin}) {
    m.law = law;
    const double G = m.shear_modulus(), K = m.bulk_modulus();
    const Mat3 P = with_law<double>(m, [&](const auto& l) { return first_piola(l, K, F); });
    const Mat3 expected = G * (H + H.transpose()) + (K - 2 * G / 3) * H.trace() * Mat3::Identity();
    EXPECT_LT((P - expected).norm(), 1e-6 * expected.norm()) << int(law);
  }
}

TEST(material, a_sound_one_has_no_problems) {
  Material m;
  m.c10 = 30e3;
  m.prony = {{0.5, 160}};
  EXPECT_TRUE(validate(m, "uterus").empty());
}

TEST(material, lists_every_problem) {
  Material m;
  m.density = -1, m.c10 = std::numeric_limits<double>::quiet_NaN(), m.poisson = 0.5, m.fibre_k1 = -2, m.fibre_k2 = 0;
  m.prony = {{1.5, 10}, {0.1, 0}};
  EXPECT_THAT(
      validate(m, "uterus"),
      testing::ElementsAre(
          "uterus: density is -1, allowed: > 0 kg/m^3; soft tissue has about 1000",
          "uterus: poisson is 0.5, allowed: -1 < poisson < 0.5; use 0.45 to 0.499 for nearly incompressible tissue",
          "uterus: c10 is nan, allowed: > 0 Pa; it is half the shear modulus",
          "uterus: fibre_k1 is -2, allowed: >= 0 Pa; 0 switches the fibres off",
          "uterus: fibre_k2 is 0, allowed: > 0; small values make the fibres nearly linear",
          "uterus: prony[0].g is 1.5, allowed: 0 to 1; it is a share of the instantaneous stiffness",
          "uterus: prony[1].tau is 0, allowed: > 0 s; it is a relaxation time",
          "uterus: the sum of prony g is 1.6, allowed: < 1; what is left is the stiffness at rest"));
}

TEST(material, wants_the_constants_of_its_law) {
  Material m;
  m.law = Law::hooke_corotated;
  EXPECT_THAT(validate(m, "bone"),
              testing::ElementsAre("bone: youngs_modulus is 0, allowed: > 0 Pa; Hooke's law needs it"));
  m.law = Law::mooney_rivlin;
  m.c10 = 5, m.c01 = -6;
  EXPECT_THAT(validate(m, "skin"),
              testing::ElementsAre("skin: c01 is -6, allowed: >= 0 Pa; a negative value makes large strains unstable",
                                   "skin: c10 + c01 is -1, allowed: > 0 Pa; it is half the shear modulus"));
}

}  // namespace
}  // namespace carus::material
