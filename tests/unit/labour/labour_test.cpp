// SPDX-License-Identifier: Apache-2.0
#include "carus/labour/labour.hpp"

#include <gtest/gtest.h>

#include <cmath>

namespace carus::labour {
namespace {

// Rise, plateau and fall of 30 s each, starts at 30, 270, 510 ... s.
const Contractions contractions{.base = 1000, .amplitude = 6000};

TEST(contractions, waveform) {
  for (const double start : {30.0, 270.0, 1710.0}) {
    EXPECT_EQ(contraction_activity(contractions, start - 1), 0);
    EXPECT_DOUBLE_EQ(contraction_activity(contractions, start + 15), 0.5);
    EXPECT_DOUBLE_EQ(contraction_activity(contractions, start + 45), 1);
    EXPECT_DOUBLE_EQ(contraction_activity(contractions, start + 75), 0.5);
    EXPECT_EQ(contraction_activity(contractions, start + 91), 0);
  }
  EXPECT_EQ(contraction_pressure(contractions, 0), 1000);
  EXPECT_DOUBLE_EQ(contraction_pressure(contractions, 75), 7000);
}

/// Largest jump of the slope of f between samples dt apart: of order dt for a C1 function, of order 1 at a corner.
template <class F>
double roughness(F f, double dt) {
  double worst = 0;
  for (double t = 0; t < 600; t += dt) worst = std::max(worst, std::abs(f(t + dt) - 2 * f(t) + f(t - dt)) / dt);
  return worst;
}

TEST(contractions, smooth_with_their_slope) {
  const auto f = [](double t) { return contraction_activity(contractions, t); };
  // The curvature of a cosine ramp of 30 s is at most pi^2/(2 * 30^2) = 0.0055 /s^2.
  EXPECT_LT(roughness(f, 0.01), 0.0056 * 0.01);
  Push efforts{.amplitude = 1, .efforts = 3, .effort_duration = 8};
  const auto g = [&](double t) { return push_pressure(efforts, contractions, t); };
  EXPECT_LT(roughness(g, 0.001), 1.24 * 0.001);  // ramps of 2 s: pi^2/(2 * 2^2)
}

TEST(contractions, a_contraction_without_plateau_or_ramp_stays_within_bounds) {
  const Contractions peaked{.amplitude = 1, .duration = 50};  // rise and fall overlap
  const Contractions square{.amplitude = 1, .rise = 0, .fall = 0};
  for (double t = 0; t < 300; t += 0.5) {
    for (const auto& c : {peaked, square}) {
      EXPECT_GE(contraction_activity(c, t), 0);
      EXPECT_LE(contraction_activity(c, t), 1);
    }
  }
  EXPECT_EQ(contraction_activity(square, 31), 1);
}

TEST(contractions, counted_from_their_start) {
  EXPECT_EQ(contractions_begun(contractions, 29.9), 0);
  EXPECT_EQ(contractions_begun(contractions, 30), 1);
  EXPECT_EQ(contractions_begun(contractions, 269.9), 1);
  EXPECT_EQ(contractions_begun(contractions, 1920), 8);
}

TEST(push, follows_the_contraction) {
  const Push push{.amplitude = 24000};
  for (double t = 0; t < 400; t += 3.7) {
    EXPECT_DOUBLE_EQ(push_pressure(push, contractions, t), 24000 * contraction_activity(contractions, t));
  }
}

TEST(push, efforts_are_even_within_the_plateau) {
  const Push push{.amplitude = 1, .efforts = 3, .effort_duration = 8};
  // Plateau 60..90 s, shares of 10 s, an effort of 8 s in the middle of each.
  for (const double middle : {65.0, 75.0, 85.0}) {
    EXPECT_DOUBLE_EQ(push_pressure(push, contractions, middle), 1);
    EXPECT_DOUBLE_EQ(push_pressure(push, contractions, middle - 3), 0.5);
    EXPECT_EQ(push_pressure(push, contractions, middle - 4.5), 0);
    EXPECT_EQ(push_pressure(push, contractions, middle + 4.5), 0);
  }
  EXPECT_EQ(push_pressure(push, contractions, 0), 0);
  EXPECT_EQ(push_pressure(push, contractions, 50), 0);
  EXPECT_EQ(push_pressure(push, contractions, 100), 0);
}

TEST(push, efforts_longer_than_their_share_are_cut_to_it) {
  const Push push{.amplitude = 1, .efforts = 3, .effort_duration = 50};
  EXPECT_DOUBLE_EQ(push_pressure(push, contractions, 65), 1);
  EXPECT_NEAR(push_pressure(push, contractions, 70), 0, 1e-12);
}

TEST(push, disabled_is_nothing) {
  const Push push{.enabled = false, .amplitude = 24000};
  for (double t = 0; t < 400; t += 10) EXPECT_EQ(push_pressure(push, contractions, t), 0);
}

TEST(tone, constant_or_nothing) {
  EXPECT_EQ(tone_pressure({}, 100), 9500);
  EXPECT_EQ(tone_pressure({.enabled = false}, 100), 0);
}

}  // namespace
}  // namespace carus::labour
