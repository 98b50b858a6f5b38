// SPDX-License-Identifier: Apache-2.0
#include "carus/report/cubic.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>

namespace carus::report {
namespace {

TEST(MonotoneCubic, IsExactOnALine) {
  const MonotoneCubic c({0, 1, 3, 3.5, 7}, {2, 4, 8, 9, 16});
  for (double t = 0; t <= 7; t += 0.13) {
    EXPECT_NEAR(c.value(t), 2 + 2 * t, 1e-12);
    EXPECT_NEAR(c.slope(t), 2, 1e-12);
    EXPECT_NEAR(c.curvature(t), 0, 1e-11);
  }
  EXPECT_NEAR(c.steepest().value, 2, 1e-12);
  EXPECT_NEAR(c.most_curved().value, 0, 1e-11);
}

TEST(MonotoneCubic, StaysOutsideItsPointsWhatItWasAtTheEnds) {
  const MonotoneCubic c({1, 2, 4}, {0, 1, 5});
  EXPECT_EQ(c.value(-3), 0);
  EXPECT_EQ(c.value(9), 5);
  EXPECT_EQ(c.slope(-3), 0);
  EXPECT_EQ(c.slope(9), 0);
  const MonotoneCubic one({1}, {7});
  EXPECT_EQ(one.value(0), 7);
  EXPECT_EQ(one.slope(1), 0);
  EXPECT_EQ(one.steepest().value, 0);
}

/// Against t³/3 + t: the error falls with the square of the interval at least (Fritsch and Butland's slopes are second
/// order).
TEST(MonotoneCubic, ConvergesOnASmoothMonotoneCurve) {
  const auto worst = [](int n) {
    std::vector<double> t, y;
    for (int i = 0; i <= n; ++i) t.push_back(2.0 * i / n), y.push_back(std::pow(t.back(), 3) / 3 + t.back());
    const MonotoneCubic c(t, y);
    double error = 0, slope_error = 0;
    for (double s = 0; s <= 2; s += 0.0007) {
      error = std::max(error, std::abs(c.value(s) - (s * s * s / 3 + s)));
      slope_error = std::max(slope_error, std::abs(c.slope(s) - (s * s + 1)));
    }
    return std::pair(error, slope_error);
  };
  const auto [coarse, coarse_slope] = worst(20);
  const auto [fine, fine_slope] = worst(40);
  EXPECT_GT(coarse, 0);
  EXPECT_GT(coarse / fine, 3.8);  // 2² less the constant's drift
  EXPECT_GT(coarse_slope / fine_slope, 1.9);
}

/// No overshoot: between two points never beyond either, however rough they are.
TEST(MonotoneCubic, NeverLeavesTheRangeOfItsTwoPoints) {
  std::mt19937 random(3);
  std::uniform_real_distribution<double> step(0.01, 3), any(-10, 10);
  std::vector<double> t{0}, y{0};
  for (int i = 0; i < 300; ++i) t.push_back(t.back() + step(random)), y.push_back(i % 7 == 0 ? y.back() : any(random));
  const MonotoneCubic c(t, y);
  for (std::size_t i = 0; i + 1 < t.size(); ++i) {
    const auto [low, high] = std::minmax(y[i], y[i + 1]);
    for (int k = 0; k <= 40; ++k) {
      const double v = c.value(t[i] + (t[i + 1] - t[i]) * k / 40);
      EXPECT_GE(v, low - 1e-12);
      EXPECT_LE(v, high + 1e-12);
    }
    EXPECT_NEAR(c.value(t[i]), y[i], 1e-12);
  }
}

/// Slope and curvature are those of the values, and the extremes those of a fine scan.
TEST(MonotoneCubic, DerivativesAndExtremesAgreeWithTheValues) {
  std::vector<double> t, y;
  for (int i = 0; i <= 30; ++i) t.push_back(i + 0.3 * std::sin(i)), y.push_back(10 * std::sin(0.7 * t.back()));
  const MonotoneCubic c(t, y);
  double steepest = 0, curved = 0;
  for (std::size_t i = 0; i + 1 < t.size(); ++i) {
    const double h = t[i + 1] - t[i];
    for (int k = 1; k < 200; ++k) {
      const double s = t[i] + h * k / 200, d = 1e-4 * h;
      const double slope = (c.value(s + d) - c.value(s - d)) / (2 * d);
      EXPECT_NEAR(c.slope(s), slope, 1e-5);
      EXPECT_NEAR(c.curvature(s), (c.slope(s + d) - c.slope(s - d)) / (2 * d), 1e-5);
      steepest = std::max(steepest, std::abs(c.slope(s))), curved = std::max(curved, std::abs(c.curvature(s)));
    }
  }
  // The scan misses the ends of the intervals by 1/200 of them.
  EXPECT_NEAR(std::abs(c.steepest().value), steepest, 5e-3 * steepest);
  EXPECT_GE(std::abs(c.steepest().value), steepest);
  EXPECT_NEAR(std::abs(c.most_curved().value), curved, 2e-2 * curved);
  EXPECT_GE(std::abs(c.most_curved().value), curved);
  EXPECT_NEAR(c.slope(c.steepest().time), c.steepest().value, 1e-9);
}

}  // namespace
}  // namespace carus::report
