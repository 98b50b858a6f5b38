// SPDX-License-Identifier: Apache-2.0
#include "carus/material/prony.hpp"

#include <gtest/gtest.h>

#include <array>

#include "law_cases.hpp"

namespace carus::material {
namespace {

struct Branch {
  double g, tau;
};
constexpr std::array<Branch, 2> branches{{{0.3, 5}, {0.4, 160}}};

/// S(t) for S_iso = s t up to T, constant afterwards: sum of the exact solutions of dh/dt + h/tau = dS/dt.
double ramp_and_hold(double s, double T, double t) {
  double S = s * std::min(t, T);
  for (const auto& [g, tau] : branches) {
    const double h =
        t <= T ? s * tau * (1 - std::exp(-t / tau)) : s * tau * (std::exp((T - t) / tau) - std::exp(-t / tau));
    S += g * (h - s * std::min(t, T));
  }
  return S;
}

template <class T>
T run_ramp_and_hold(double s, double ramp, double end, int steps_per_part) {
  Sym3T<T> before{}, h[2]{}, S{};
  double t = 0;
  for (int i = 0; i < 2 * steps_per_part; ++i) {
    const double dt = (i < steps_per_part ? ramp : end - ramp) / steps_per_part;
    t += dt;
    Sym3T<T> now{};
    now.xy = constant<T>(s * std::min(t, ramp));
    S = now;
    for (int k = 0; k < 2; ++k) relax(PronyFactors::of(branches[k].g, branches[k].tau, dt), now, before, h[k], S);
    before = now;
  }
  return S.xy;
}

TEST(prony, ramp_and_hold_is_exact_for_any_step) {
  for (const int steps : {1, 7, 200}) {
    EXPECT_NEAR(run_ramp_and_hold<double>(100, 2, 60, steps), ramp_and_hold(100, 2, 60), 1e-10) << steps;
  }
  // Single precision gathers rounding over 400 steps.
  EXPECT_NEAR(double(run_ramp_and_hold<Float16>(100, 2, 60, 200)[3]), ramp_and_hold(100, 2, 60), 1e-4 * 100);
}

TEST(prony, constants_are_instantaneous_and_the_rest_is_what_stays) {
  EXPECT_NEAR(run_ramp_and_hold<double>(1e6, 1e-6, 2e-6, 1), 1, 1e-6);
  EXPECT_NEAR(run_ramp_and_hold<double>(1, 1, 1e5, 10), 1 - 0.3 - 0.4, 1e-12);
}

TEST(prony, second_piola_and_back) {
  std::mt19937 random(1);
  const Mat3 F = random_deformation(random, 0.4);
  const auto f = to_tensor(F);
  const Mat3 P = first_piola(neo_hooke<double>(), 0, F), S = F.inverse() * P;
  const auto s = second_piola(cofactor(f), determinant(f), to_tensor(P));
  EXPECT_NEAR(s.xx, S(0, 0), 1e-9);
  EXPECT_NEAR(s.yz, S(2, 1), 1e-9);
  EXPECT_LT((to_eigen(first_piola_of(f, s)) - P).norm(), 1e-12 * shear);
}

// Relaxation acts on S, which does not turn with the body: a turning, strained body relaxes like a still one.
TEST(prony, objective) {
  std::mt19937 random(2);
  const Mat3 F = random_deformation(random, 0.3), Q = random_rotation(random);
  const auto stress = [&](const Mat3& end) {
    Sym3T<double> before{}, h{}, S{};
    Mat3T<double> f{};
    for (const Mat3& now : {F, end}) {
      f = to_tensor(now);
      const auto s = second_piola(cofactor(f), determinant(f), to_tensor(first_piola(neo_hooke<double>(), 0, now)));
      S = s;
      relax(PronyFactors::of(0.5, 10, 4), s, before, h, S);
      before = s;
    }
    return to_eigen(first_piola_of(f, S));
  };
  EXPECT_LT((stress(Q * F) - Q * stress(F)).norm(), 1e-12 * shear);
}

}  // namespace
}  // namespace carus::material
