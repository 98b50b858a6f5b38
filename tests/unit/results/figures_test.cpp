// SPDX-License-Identifier: Apache-2.0
#include "carus/results/figures.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "carus/core/units.hpp"

namespace carus::results {
namespace {

labour::Contractions paper() {
  labour::Contractions c;
  c.base = 10 * units::mmHg, c.amplitude = 50 * units::mmHg;
  return c;
}

scenario::Loads paper_loads() {
  scenario::Loads loads;
  loads.contractions = paper();
  loads.push.amplitude = 200 * units::mmHg;
  return loads;
}

/// A head that goes 30 mm down in each contraction and comes 8 mm back in each rest; born when 180 mm down.
observe::Table staircase() {
  observe::Table t;
  t.names = {"time_s",          "head_x_mm",           "head_y_mm",         "head_z_mm",        "head_travel_mm",
             "head_speed_mm_s", "skull_past_vulva_mm", "widest_station_mm", "uterus_length_mm", "sacrum_angle_deg"};
  const auto c = paper();
  double z = 0, last = 0;
  for (double time = 0; time <= 1920; time += 2) {
    const double phase = std::fmod(time - c.first + c.period, c.period);
    if (time > c.first) z += phase <= 60 && phase > 0 ? 2 * 30.0 / 60 : -2 * 8.0 / 180;
    const double angle = 4 * std::exp(-std::pow((time - 700) / 150, 2)) +
                         3 * std::exp(-std::pow((time - 1500) / 150, 2)) + 0.5 * time / 1920;
    t.rows.push_back({time, 0.01 * z, 0.3 * z, -z, z, (z - last) / 2, z - 180, z - 60, 230 - 0.8 * z, angle});
    last = z;
  }
  return t;
}

TEST(Figures, ReadAStaircaseRightly) {
  const auto f = figures_of(staircase(), paper());
  ASSERT_TRUE(f.birth_time);
  EXPECT_NEAR(*f.birth_time, 30 + 7 * 240 + 60 * (180 - 7 * 22.0) / 30,
              2.5);  // 22 mm a period, the rest in the eighth contraction
  EXPECT_EQ(f.contractions, 8);
  EXPECT_NEAR(f.descent_at_peaks.at(0), 30, 1.1);
  EXPECT_NEAR(f.descent_at_peaks.at(2), 74, 1.1);
  ASSERT_EQ(f.recession.size(), 7u);
  for (const double r : f.recession) EXPECT_NEAR(r, 8, 0.2);
  EXPECT_NEAR(f.amplitude[2], 180, 1.1);
  EXPECT_NEAR(f.speed.mean, 180 / *f.birth_time, 1e-3);
  EXPECT_LT(f.speed.min, 0);
  EXPECT_EQ(f.sacrum_peaks.size(), 2u);
  EXPECT_NEAR(f.sacrum_end, 0.5, 0.05);
  EXPECT_EQ(f.rests_before_spines, 2);
  EXPECT_EQ(f.recessions_before_spines, 2);
}

TEST(Bands, SayWhatIsInsideAndWhatIsNot) {
  const auto bands = bands_of(figures_of(staircase(), paper()), paper_loads());
  const auto inside = [&](const std::string& what) {
    const auto it = std::find_if(bands.begin(), bands.end(), [&](const Band& b) { return b.what == what; });
    EXPECT_NE(it, bands.end()) << what;
    return it != bands.end() && it->inside;
  };
  EXPECT_TRUE(inside("contractions to birth"));
  EXPECT_TRUE(inside("head displacement z"));
  EXPECT_TRUE(inside("head displacement y"));
  EXPECT_TRUE(inside("rests in which the head recedes"));
  EXPECT_TRUE(inside("sacrum/coccyx angle, peaks"));
  EXPECT_FALSE(inside("moulding, occipitofrontal"));  // was not measured
  EXPECT_FALSE(inside("lateral uterine points"));
}

TEST(Bands, AskForPressuresOfTheLiteratureWhereTheLoadsClaimThem) {
  const auto asked = [](const scenario::Loads& loads) {
    std::vector<std::string> names;
    for (const auto& b : bands_of(figures_of(staircase(), paper()), loads)) {
      if (!b.asked) names.push_back(b.what);
    }
    return names;
  };
  const std::vector<std::string> physiology = {"pressure: base",      "pressure: contraction above base",
                                               "pressure: with push", "force on the head",
                                               "levator stretch",     "perineal ring, transverse"};
  auto loads = paper_loads();
  EXPECT_EQ(asked(loads), physiology);
  loads.push.amplitude = 50 * units::mmHg;
  EXPECT_EQ(asked(loads), physiology) << "a tone of 71 mmHg is the paper's";
  loads.residual_tone.pressure = 10 * units::mmHg;
  EXPECT_EQ(asked(loads), std::vector<std::string>{});
  loads.push.enabled = false;
  EXPECT_EQ(asked(loads), std::vector<std::string>{"pressure: with push"});
}

TEST(Validation, HoldsARunAgainstThePapersSectionFive) {
  const auto rows = validation_of(figures_of(staircase(), paper()));
  int inside = 0;
  for (const auto& row : rows) {
    EXPECT_TRUE(row.source.starts_with("paper, 5")) << row.what;
    EXPECT_EQ(row.number, 0);
    EXPECT_EQ(row.asked, row.what != "head displacement X (left-right)") << row.what;
    inside += row.inside;
  }
  EXPECT_EQ(rows.size(), 12u);
  // All but what the staircase does not hold: lateral points, deformation, and X, which is nearly 0.
  EXPECT_EQ(inside, 9);
}

TEST(Figures, AnEmptyTableGivesNone) { EXPECT_FALSE(figures_of({}, paper()).birth_time); }

}  // namespace
}  // namespace carus::results
