// SPDX-License-Identifier: Apache-2.0
#include "carus/verify/closed_forms.hpp"

#include <Eigen/SVD>
#include <cmath>

#include "carus/core/error.hpp"

namespace carus::verify {

Vec3 principal_stress(const material::Material& m, const Vec3& l) {
  const double G = m.shear_modulus(), K = m.bulk_modulus(), J = l.prod();
  const Vec3 inverse = l.cwiseInverse();
  if (m.law == material::Law::hooke_small_strain) {
    const Vec3 e = l - Vec3::Ones();
    return 2 * G * (e - e.mean() * Vec3::Ones()) + K * e.sum() * Vec3::Ones();
  }
  // U = K/4 (J^2 - 1 - 2 ln J): dU/dlambda_i = K/2 (J^2 - 1)/lambda_i.
  const Vec3 volumetric = 0.5 * K * (J * J - 1) * inverse;
  if (m.law == material::Law::hooke_corotated) {
    // W = G |dev(lambda - 1)|^2.
    return 2 * G * (l - l.mean() * Vec3::Ones()) + volumetric;
  }
  // I1bar = J^(-2/3) sum l^2: d/dl_i = 2 J^(-2/3) (l_i - I1/(3 l_i)).
  const double I1 = l.squaredNorm(), I2 = 0.5 * (I1 * I1 - l.cwiseProduct(l).squaredNorm());
  Vec3 P = 2 * m.c10 * std::pow(J, -2.0 / 3) * (l - I1 / 3 * inverse) + volumetric;
  // I2bar = J^(-4/3) I2: dI2/dl_i = 2 l_i (I1 - l_i^2).
  if (m.law == material::Law::mooney_rivlin) {
    const Vec3 dI2 = 2 * l.cwiseProduct(Vec3::Constant(I1) - l.cwiseProduct(l));
    P += m.c01 * std::pow(J, -4.0 / 3) * (dI2 - 4.0 / 3 * I2 * inverse);
  }
  return P;
}

Mat3 nominal_stress(const material::Material& m, const Mat3& F) {
  CARUS_ASSERT(m.law != material::Law::hooke_small_strain);
  const Eigen::JacobiSVD<Mat3> svd(F, Eigen::ComputeFullU | Eigen::ComputeFullV);
  return svd.matrixU() * principal_stress(m, svd.singularValues()).asDiagonal() * svd.matrixV().transpose();
}

double root(const std::function<double(double)>& f, double low, double high) {
  for (int i = 0; i < 100; ++i) {
    const double middle = 0.5 * (low + high);
    (f(middle) < 0 ? low : high) = middle;
  }
  return 0.5 * (low + high);
}

double sphere_pressure(double inner, double outer, double G, double inner_now) {
  const double grown = std::pow(inner_now, 3) - std::pow(inner, 3);
  const auto term = [](double stretch) { return 2 / stretch + 0.5 / std::pow(stretch, 4); };
  return G * (term(std::cbrt(std::pow(outer, 3) + grown) / outer) - term(inner_now / inner));
}

Tip elastica(double L, double EI, double q) {
  struct Y {
    double theta, kappa, x, z;
  };
  constexpr int steps = 2000;
  const double h = L / steps;
  const auto shoot = [&](double kappa0) {
    Y y{0, kappa0, 0, 0};
    const auto rate = [&](const Y& a, double s) {
      return Y{a.kappa, q / EI * (L - s) * std::cos(a.theta), std::cos(a.theta), std::sin(a.theta)};
    };
    const auto plus = [](const Y& a, const Y& b, double f) {
      return Y{a.theta + f * b.theta, a.kappa + f * b.kappa, a.x + f * b.x, a.z + f * b.z};
    };
    for (int i = 0; i < steps; ++i) {
      const double s = i * h;
      const Y k1 = rate(y, s), k2 = rate(plus(y, k1, h / 2), s + h / 2), k3 = rate(plus(y, k2, h / 2), s + h / 2),
              k4 = rate(plus(y, k3, h), s + h);
      y = plus(plus(plus(plus(y, k1, h / 6), k2, h / 3), k3, h / 3), k4, h / 6);
    }
    return y;
  };
  // The load bends downwards: curvature at the clamp between 0 and that of the straight beam's moment.
  const double most = -q * L * L / EI;
  const double kappa0 = root([&](double k) { return shoot(k).kappa; }, most, 0);
  const Y end = shoot(kappa0);
  return {end.x, end.z};
}

namespace {

/// What one ball gives way, with contact radius a.
double approach_of_one(double F, double a, double R, double E, double nu) {
  const double d2 = a * a + 4 * R * R;
  return 0.75 * (1 - nu * nu) * F / (E * a) -
         F / (pi * E) * (2 * (1 + nu) * R * R / std::pow(d2, 1.5) + (1 - nu * nu) / std::sqrt(d2));
}

}  // namespace

double hertz_approach(double F, double R, double E, double nu) {
  return approach_of_one(F, std::cbrt(0.75 * F * R * (1 - nu * nu) / E), R, E, nu);
}

double hertz_approach_of_two(double F, double R, double E1, double E2, double nu) {
  const double compliance = (1 - nu * nu) * (1 / E1 + 1 / E2);
  const double a = std::cbrt(0.75 * F * R / 2 * compliance);
  return approach_of_one(F, a, R, E1, nu) + approach_of_one(F, a, R, E2, nu);
}

double hertz_force(double approach, double R, double E, double nu) {
  return root([&](double F) { return hertz_approach(F, R, E, nu) - approach; }, 0, E * R * R);
}

}  // namespace carus::verify
