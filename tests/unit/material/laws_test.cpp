// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include "law_cases.hpp"

namespace carus::material {
namespace {

TEST(laws, rest_is_stress_free) {
  for_each_law<double>([](const auto& law, const Traits& traits) {
    EXPECT_EQ(first_piola(law, bulk, Mat3::Identity()).norm(), 0) << traits.name;
    EXPECT_EQ(energy(law, bulk, Mat3::Identity()), 0) << traits.name;
  });
}

TEST(laws, rigid_motion_is_stress_free) {
  std::mt19937 random(1);
  for_each_law<double>([&](const auto& law, const Traits& traits) {
    if (!traits.objective) return;
    for (int i = 0; i < 20; ++i) {
      // The rotation itself is orthogonal to a few 1e-16, times the bulk modulus.
      EXPECT_LT(first_piola(law, bulk, random_rotation(random)).norm(), 1e-14 * bulk) << traits.name;
    }
  });
}

TEST(laws, frame_indifference) {
  std::mt19937 random(2);
  for_each_law<double>([&](const auto& law, const Traits& traits) {
    if (!traits.objective) return;
    for (int i = 0; i < 20; ++i) {
      const Mat3 F = random_deformation(random, 0.4), Q = random_rotation(random);
      const Mat3 P = first_piola(law, bulk, F);
      EXPECT_LT((first_piola(law, bulk, Q * F) - Q * P).norm(), 1e-12 * (P.norm() + shear)) << traits.name;
      EXPECT_NEAR(energy(law, bulk, Q * F), energy(law, bulk, F), 1e-12 * shear) << traits.name;
    }
  });
}

TEST(laws, isotropy) {
  std::mt19937 random(3);
  for_each_law<double>([&](const auto& law, const Traits& traits) {
    if (!traits.isotropic || !traits.objective) return;
    for (int i = 0; i < 20; ++i) {
      const Mat3 F = random_deformation(random, 0.4), Q = random_rotation(random);
      const Mat3 P = first_piola(law, bulk, F);
      EXPECT_LT((first_piola(law, bulk, F * Q) - P * Q).norm(), 1e-12 * (P.norm() + shear)) << traits.name;
    }
  });
}

// F = I + H with H of 1e-8 must give linear elasticity to 1e-6, stress and energy: nothing may cancel. F holds H only
// to 1e-16, 1e-8 of it, so the comparison is with F - I; the nonlinear terms are another 1e-8.
TEST(laws, near_rest_accuracy) {
  std::mt19937 random(4);
  for_each_law<double>([&](const auto& law, const Traits& traits) {
    if (!traits.isotropic) return;
    const Mat3 F = Mat3::Identity() + 1e-8 * random_matrix(random);
    const Mat3 H = F - Mat3::Identity(), strain = 0.5 * (H + H.transpose());
    const Mat3 deviatoric = strain - strain.trace() / 3 * Mat3::Identity();
    const Mat3 expected = 2 * shear * deviatoric + bulk * strain.trace() * Mat3::Identity();
    EXPECT_LT((first_piola(law, bulk, F) - expected).norm(), 1e-6 * expected.norm()) << traits.name;
    // The isochoric part alone, a hundredth of the volumetric one in other units.
    EXPECT_LT((first_piola(law, 0, F) - 2 * shear * deviatoric).norm(), 1e-6 * shear * deviatoric.norm())
        << traits.name;
    const double expected_energy = shear * deviatoric.squaredNorm() + bulk / 2 * std::pow(strain.trace(), 2);
    EXPECT_NEAR(energy(law, bulk, F) / expected_energy, 1, 1e-6) << traits.name;
  });
}

TEST(laws, fibre_near_rest) {
  const auto law = fibre<double>();
  const Vec3& a = fibre_direction;
  const Mat3 H = 1e-8 * (a * a.transpose() + 0.5 * Mat3::Identity()), F = Mat3::Identity() + H;
  // e = 2 a.dev(eps).a = 2 * (2/3) * 1e-8; P = 2 k1 e dev(a (x) a).
  const Mat3 expected = 2 * shear * (4.0 / 3.0 * 1e-8) * (a * a.transpose() - Mat3::Identity() / 3);
  EXPECT_LT((first_piola(law, 0, F) - expected).norm(), 1e-6 * expected.norm());
  EXPECT_EQ(first_piola(law, 0, Mat3::Identity() - H).norm(), 0) << "fibres bear no compression";
}

// ---- derivatives ----------------------------------------------------------------------------------------------------

/// Error of central differences of `value` along D against `exact` at h and h/2: second order, or exact to rounding.
template <class Value, class Exact>
void expect_second_order(Value value, const Exact& exact, double scale, const std::string& what) {
  ASSERT_GT(exact.norm(), 1e-3 * scale) << what << ": a zero derivative proves nothing";
  const auto error = [&](double h) { return ((value(h) - value(-h)) / (2 * h) - exact).norm(); };
  const double h = 4e-3, coarse = error(h), fine = error(h / 2);
  if (coarse < 1e-9 * exact.norm()) return;  // a quadratic energy: no error but rounding
  EXPECT_LT(fine, 1e-3 * exact.norm()) << what;
  EXPECT_NEAR(std::log2(coarse / fine), 2, 0.1) << what;
}

struct Place {
  const char* name;
  Mat3 F;
  double bulk;
};
std::vector<Place> places() {
  std::mt19937 random(5);
  Mat3 small = Mat3::Identity() + 0.02 * random_matrix(random);
  small += 0.05 * fibre_direction * fibre_direction.transpose();
  const Vec3 &a = fibre_direction, b = a.unitOrthogonal();
  Mat3 stretch = 2.2 * a * a.transpose() + 0.7 * (Mat3::Identity() - a * a.transpose());
  stretch = random_rotation(random) * (stretch + 0.4 * a * b.transpose());
  const Mat3 isochoric = stretch / std::cbrt(stretch.determinant());
  return {{"small strain", small, bulk},
          {"large stretch", stretch, bulk},
          {"nearly incompressible", isochoric, 1e3 * shear}};
}

TEST(laws, stress_is_the_derivative_of_energy) {
  std::mt19937 random(6);
  using Number = Eigen::Matrix<double, 1, 1>;
  for_each_law<double>([&](const auto& law, const Traits& traits) {
    for (const auto& at : places()) {
      const Mat3 P = first_piola(law, at.bulk, at.F);
      for (int i = 0; i < 5; ++i) {
        // Near the stress, else a random direction could be almost orthogonal to it.
        const Mat3 D = (P.normalized() + 0.3 * random_matrix(random)).normalized();
        const auto W = [&](double h) { return Number(energy(law, at.bulk, at.F + h * 0.1 * D)); };
        expect_second_order(W, Number(0.1 * P.cwiseProduct(D).sum()), 1e-2 * shear, traits.name + ", " + at.name);
      }
    }
  });
}

TEST(laws, tangent_is_the_derivative_of_stress) {
  std::mt19937 random(7);
  for_each_law<double>([&](const auto& law, const Traits& traits) {
    auto all = places();
    if (traits.isotropic) all.push_back({"rest", Mat3::Identity(), bulk});  // fibres have a kink there
    for (const auto& at : all) {
      for (int i = 0; i < 5; ++i) {
        const Mat3 D = random_matrix(random).normalized();
        const auto P = [&](double h) { return first_piola(law, at.bulk, at.F + h * D); };
        expect_second_order(P, first_piola_rate(law, at.bulk, at.F, D), shear, traits.name + ", " + at.name);
      }
    }
  });
}

TEST(laws, hessian_is_symmetric_and_its_projection_positive) {
  for_each_law<double>([&](const auto& law, const Traits& traits) {
    for (const auto& at : places()) {
      const Mat9 A = dP_dF(law, at.bulk, at.F);
      for (int k = 0; k < 9; ++k) {
        Mat3 dF = Mat3::Zero();
        dF.data()[k] = 1;
        const Mat3 dP = first_piola_rate(law, at.bulk, at.F, dF);
        // dP_dF averages over the diagonal: agreement says that the rate itself is symmetric.
        EXPECT_LT((A.col(k) - Eigen::Map<const Eigen::Vector<double, 9>>(dP.data())).norm(), 1e-12 * A.norm())
            << traits.name;
      }
      const Mat9 projected = project_positive(A);
      EXPECT_GT(Eigen::SelfAdjointEigenSolver<Mat9>(projected).eigenvalues()[0], -1e-13 * A.norm()) << traits.name;
    }
    const Mat9 A = dP_dF(law, bulk, Mat3::Identity());  // semi-definite already: left alone
    EXPECT_LT((project_positive(A) - A).norm(), 1e-13 * A.norm()) << traits.name;
  });
}

// ---- the polar decomposition
// ------------------------------------------------------------------------------------------

TEST(hooke, polar_rotation_for_stretches_from_a_fifth_to_five) {
  std::mt19937 random(8);
  for (const Vec3& stretches :
       {Vec3(1, 1, 1), Vec3(5, 0.2, 1), Vec3(5, 5, 0.2), Vec3(0.2, 0.2, 5), Vec3(1.1, 0.9, 1)}) {
    const Mat3 R = random_rotation(random), Q = random_rotation(random);
    const Mat3 F = R * Q * stretches.asDiagonal() * Q.transpose();
    EXPECT_LT((to_eigen(polar_rotation(to_tensor(F))) - R).norm(), 1e-13) << stretches.transpose();
  }
}

}  // namespace
}  // namespace carus::material
