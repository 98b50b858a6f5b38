// SPDX-License-Identifier: Apache-2.0
#include "carus/solve/pace.hpp"

#include <gtest/gtest.h>

#include <cmath>

namespace carus::solve {
namespace {

constexpr double ratio = 0.04, stored = 10;
constexpr double slack = 0.01 * ratio * stored, hurried = 3 * ratio * stored;  // [J] kinetic energies

TEST(Pace, RisesARungAtATimeWhereLittleMovesAndLoadsStand) {
  Pace pace({ratio, 0.5, 4});
  EXPECT_DOUBLE_EQ(pace.factor(), 1);
  for (const double expected : {std::sqrt(2), 2.0, std::sqrt(8), 4.0}) {
    EXPECT_TRUE(pace.judge(slack, stored, true));
    EXPECT_NEAR(pace.factor(), expected, 1e-12);
  }
  EXPECT_FALSE(pace.judge(slack, stored, true));
}

TEST(Pace, IsBackAtTheMeanBeforeLoadsMove) {
  Pace pace({ratio, 0.5, 4});
  while (pace.judge(slack, stored, true)) {
  }
  EXPECT_TRUE(pace.judge(slack, stored, false));
  EXPECT_DOUBLE_EQ(pace.factor(), 1);
  EXPECT_FALSE(pace.judge(slack, stored, false));
}

TEST(Pace, FallsByTheExcessOfKineticEnergyAtOnce) {
  Pace pace({ratio, 0.25, 4});
  EXPECT_TRUE(pace.judge(hurried, stored, false));  // a factor of 3: two halvings
  EXPECT_NEAR(pace.factor(), 0.5, 1e-12);
  EXPECT_FALSE(pace.judge(0.5 * ratio * stored, stored, false));
  EXPECT_TRUE(pace.judge(1e3 * hurried, stored, true));
  EXPECT_NEAR(pace.factor(), 0.25, 1e-12);  // and no further
  EXPECT_TRUE(pace.judge(slack, stored, false));
}

TEST(Pace, WithoutEnergiesOrRoomItStays) {
  Pace pace({ratio, 0.5, 4}), steady({ratio, 1, 1});
  EXPECT_FALSE(pace.judge(0, 0, false));
  EXPECT_FALSE(steady.varies());
  EXPECT_FALSE(steady.judge(hurried, stored, true));
  EXPECT_FALSE(steady.judge(slack, stored, true));
  EXPECT_DOUBLE_EQ(steady.factor(), 1);
}

}  // namespace
}  // namespace carus::solve
