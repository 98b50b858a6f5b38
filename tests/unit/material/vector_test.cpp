// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include "law_cases.hpp"

namespace carus::material {
namespace {

TEST(tensor, vector_functions_within_3e_7) {
  double cube = 0, root = 0, exponential = 0;
  for (int i = 0; i < 200000; ++i) {
    const float x = static_cast<float>(std::pow(10.0, -6 + 6e-5 * i)), y = static_cast<float>(-86 + 8.6e-4 * i);
    cube = std::max(cube, std::abs(double(rcbrt(Float16{} + x)[5]) * std::cbrt(double(x)) - 1));
    root = std::max(root, std::abs(double(cbrt(Float16{} + x)[5]) / std::cbrt(double(x)) - 1));
    exponential = std::max(exponential, std::abs(double(exp(Float16{} + y)[5]) / std::exp(double(y)) - 1));
  }
  EXPECT_LT(cube, 3e-7);
  EXPECT_LT(root, 3e-7);
  EXPECT_LT(exponential, 3e-7);
}

TEST(tensor, agrees_with_eigen) {
  std::mt19937 random(1);
  const Mat3 A = Mat3::Identity() + 0.5 * random_matrix(random), B = random_matrix(random);
  const auto a = to_tensor(A), b = to_tensor(B);
  const double tolerance = 1e-14;
  EXPECT_LT((to_eigen(multiply(a, b)) - A * B).norm(), tolerance);
  EXPECT_LT((to_eigen(transpose_multiply(a, b)) - A.transpose() * B).norm(), tolerance);
  EXPECT_LT((to_eigen(multiply_transpose(a, b)) - A * B.transpose()).norm(), tolerance);
  EXPECT_NEAR(determinant(a), A.determinant(), tolerance);
  EXPECT_NEAR(determinant_minus_one(minus_identity(a)), A.determinant() - 1, tolerance);
  EXPECT_LT((to_eigen(inverse(a)) * A - Mat3::Identity()).norm(), tolerance);
  EXPECT_LT((to_eigen(cofactor(a)) - A.determinant() * A.inverse().transpose()).norm(), tolerance);
  EXPECT_LT((to_eigen(cofactor_minus_identity(minus_identity(a))) - to_eigen(cofactor(a)) + Mat3::Identity()).norm(),
            tolerance);
  const double h = 1e-3;  // cof is quadratic: central differences are exact
  const Mat3 rate = (to_eigen(cofactor<double>(a + b * h)) - to_eigen(cofactor<double>(a - b * h))) / (2 * h);
  EXPECT_LT((to_eigen(cofactor_rate(a, b)) - rate).norm(), 1e-12);
}

Mat3T<Float16> pack(const std::array<Mat3, 16>& F) {
  Mat3T<Float16> f{};
  Float16* entry = &f.m00;
  for (int k = 0; k < 9; ++k) {
    for (int lane = 0; lane < 16; ++lane) entry[k][lane] = static_cast<float>(F[lane](k / 3, k % 3));
  }
  return f;
}
Mat3 unpack(const Mat3T<Float16>& f, int lane) {
  Mat3 F;
  const Float16* entry = &f.m00;
  for (int k = 0; k < 9; ++k) F(k / 3, k % 3) = double(entry[k][lane]);
  return F;
}
template <class Law>
Mat3T<Float16> stress(const Law& law, const Mat3T<Float16>& f) {
  const Float16 strain = law.volume_strain(f);
  Mat3T<Float16> P;
  law.first_piola(f, strain, std::remove_cvref_t<decltype(law)>::volume_pressure(constant<Float16>(bulk), strain), P);
  return P;
}

/// body(vector law, double law, traits).
template <class Body>
void for_each_pair(Body body) {
  body(neo_hooke<Float16>(), neo_hooke<double>(), Traits{"neo-Hooke"});
  body(mooney_rivlin<Float16>(), mooney_rivlin<double>(), Traits{"Mooney-Rivlin"});
  body(HookeSmallStrain<Float16>(constant<Float16>(shear)), HookeSmallStrain<double>(shear),
       Traits{.name = "Hooke, small strain", .objective = false});
  body(HookeCorotated<Float16>(constant<Float16>(shear)), HookeCorotated<double>(shear), Traits{"Hooke, corotated"});
  body(fibre<Float16>(), fibre<double>(), Traits{.name = "fibre", .isotropic = false});
}

TEST(vector_laws, equal_the_double_ones) {
  std::mt19937 random(2);
  for (int i = 0; i < 50; ++i) {
    std::array<Mat3, 16> F;
    for (auto& f : F) f = random_deformation(random, 0.4).cast<float>().cast<double>();
    const auto f = pack(F);
    for_each_pair([&](const auto& vector, const auto& scalar, const Traits& traits) {
      const auto P = stress(vector, f);
      const auto W = vector.energy(f);
      for (int lane = 0; lane < 16; ++lane) {
        const Mat3 expected = first_piola(scalar, bulk, F[lane]);
        // Isochoric part and pressure may cancel: the scale is that of either.
        EXPECT_LT((unpack(P, lane) - expected).norm(), 1e-5 * (expected.norm() + shear)) << traits.name;
        EXPECT_NEAR(double(W[lane]), energy(scalar, 0, F[lane]), 1e-5 * shear) << traits.name;
      }
    });
  }
}

TEST(vector_laws, rest_and_rigid_motion_are_stress_free) {
  std::mt19937 random(3);
  std::array<Mat3, 16> F;
  for (auto& f : F) f = random_rotation(random);
  const auto rigid = pack(F);
  for_each_pair([&](const auto& vector, const auto&, const Traits& traits) {
    const auto at_rest = stress(vector, identity<Float16>());
    EXPECT_EQ(unpack(at_rest, 7).norm(), 0) << traits.name;
    if (!traits.objective) return;
    // A rotation rounded to single precision is a strain of 1e-7, times K = 10 G.
    const auto P = stress(vector, rigid);
    for (int lane = 0; lane < 16; ++lane) EXPECT_LT(unpack(P, lane).norm(), 1e-6 * bulk) << traits.name;
  });
}

// A strain of 1e-5 on top of 1 leaves two digits in single precision; the law must not lose them.
TEST(vector_laws, near_rest) {
  std::mt19937 random(4);
  std::array<Mat3, 16> F;
  for (auto& f : F) f = (Mat3::Identity() + 1e-5 * random_matrix(random)).cast<float>().cast<double>();
  for_each_pair([&](const auto& vector, const auto& scalar, const Traits& traits) {
    const auto P = stress(vector, pack(F));
    for (int lane = 0; lane < 16; ++lane) {
      const Mat3 expected = first_piola(scalar, bulk, F[lane]);
      EXPECT_LT((unpack(P, lane) - expected).norm(),
                (traits.name == "Hooke, corotated" ? 2e-2 : 1e-5) * expected.norm())
          << traits.name;
    }
  });
}

}  // namespace
}  // namespace carus::material
