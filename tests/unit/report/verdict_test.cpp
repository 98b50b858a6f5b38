// SPDX-License-Identifier: Apache-2.0
#include "carus/report/verdict.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "carus/report/compare.hpp"
#include "small_run.hpp"

namespace carus::report {
namespace {

TEST(Verdict, OfARunOutsideItsBandsSaysHowMany) {
  const test::Folder folder("report_verdict");
  test::write_small_run(folder / "run");  // sinks without any uterus: most is outside
  const auto f = read_folder(folder / "run");
  const auto v = judge(f);
  EXPECT_FALSE(v.met);
  EXPECT_GT(v.outside, 5);
  EXPECT_GT(v.inside, 1);
  EXPECT_EQ(std::size_t(v.inside + v.outside + v.not_asked), v.rows.size());
  EXPECT_THAT(v.line, testing::StartsWith("NOT MET: " + std::to_string(v.outside) + " of "));
  const auto text = as_text(f, v);
  EXPECT_THAT(text, testing::EndsWith("\n" + v.line + "\n"));
  EXPECT_THAT(text, testing::HasSubstr("head displacement Z (cranio-caudal)"));
  for (const auto& row : v.rows) EXPECT_THAT(text, testing::HasSubstr(row.source));
}

/// A run's curves bent until each asked row is inside: the verdict follows them and nothing else.
TEST(Verdict, OfARunInsideAllThatIsAskedIsMet) {
  const test::Folder folder("report_verdict_met");
  test::write_small_run(folder / "run");
  auto f = read_folder(folder / "run");
  auto& c = f.scenario->loads.contractions;
  const auto set = [&](const std::string& column, auto of) {
    if (!f.curves.find(column)) {
      f.curves.names.push_back(column);
      for (auto& row : f.curves.rows) row.push_back(0);
    }
    const auto k = *f.curves.find(column);
    for (auto& row : f.curves.rows) row[k] = of(row[0]);
  };
  // 7.2 contractions of 22 mm net a period, then born; as in the test of the figures.
  f.curves.rows.clear();
  for (double t = 0; t <= 1900; t += 4)
    f.curves.rows.emplace_back(f.curves.names.size(), 0.0), f.curves.rows.back()[0] = t;
  const auto descent = [&](double t) {
    double z = 0;
    for (double s = 0; s < t; s += 1) {
      const double phase = std::fmod(s - c.first + 10 * c.period, c.period);
      if (s > c.first) z += phase < 60 ? 0.5 : -8.0 / 180;
    }
    return z;
  };
  set("head_z_mm", [&](double t) { return -descent(t); });
  set("head_y_mm", [&](double t) { return 0.3 * descent(t); });
  set("skull_past_vulva_mm", [&](double t) { return descent(t) - 180; });
  set("widest_past_vulva_mm", [&](double t) { return descent(t) - 140; });
  set("widest_station_mm", [&](double t) { return descent(t) - 60; });
  set("uterus_length_mm", [&](double t) { return 230 - 0.8 * descent(t); });
  set("uterus_left_x_mm", [](double t) { return -t / 300; });
  set("uterus_right_x_mm", [](double t) { return t / 300; });
  set("sacrum_angle_deg", [](double t) {
    return 4 * std::exp(-std::pow((t - 700) / 150, 2)) + 3 * std::exp(-std::pow((t - 1500) / 150, 2)) + t / 4000;
  });
  set("moulding_occipitofrontal_mm", [](double t) { return t / 500; });
  set("moulding_vertical_mm", [](double t) { return -t / 500; });
  set("expulsive_force_n", [](double t) { return 60 + t / 100; });
  set("levator_stretch_ratio", [](double t) { return 1 + t / 1000; });
  set("vulva_transverse_ratio", [](double t) { return 1 + t / 1000; });
  set("internal_rotation_deg", [](double t) { return 80 * std::min(t / 1000, 1.0); });
  set("occiput_deg", [](double t) { return -80 + 80 * std::min(t / 1000, 1.0); });
  set("flexion_to_trunk_deg", [](double t) { return t > 1500 ? 40.0 : 60.0; });
  set("occiput_below_symphysis_mm", [](double t) { return t / 100; });
  set("inverted_count", [](double) { return 0; });
  set("penetration_mm", [](double) { return 0.1; });
  set("penetration_smooth_mm", [](double) { return 0.1; });
  const auto v = judge(f);
  for (const auto& row : v.rows) EXPECT_TRUE(row.inside || !row.asked) << row.what << ": " << row.obtained;
  EXPECT_TRUE(v.met);
  EXPECT_THAT(v.line, testing::StartsWith("MET: all "));
  // One row outside, and it is not; nor in progress, however good it looks.
  f.status = RunStatus::in_progress;
  EXPECT_FALSE(judge(f).met);
  EXPECT_THAT(judge(f).line, testing::HasSubstr("has not ended"));
  f.status = RunStatus::finished;
  set("penetration_smooth_mm", [](double t) { return t > 1000 ? 0.3 : 0.0; });
  EXPECT_FALSE(judge(f).met);
  EXPECT_EQ(judge(f).outside, 1);
}

TEST(Comparison, SetsFiguresSideBySide) {
  const test::Folder folder("report_compare");
  test::write_small_run(folder / "a", 0.4);
  test::write_small_run(folder / "b", 0.2);
  const auto a = read_folder(folder / "a");
  auto b = read_folder(folder / "b");
  const auto find = [](const std::vector<ComparisonRow>& rows, const std::string& what) {
    const auto it = std::find_if(rows.begin(), rows.end(), [&](const auto& r) { return r.what == what; });
    return it == rows.end() ? ComparisonRow{} : *it;
  };
  const auto rows = compare({&a, &b});
  const auto z = find(rows, "mean head speed"), birth = find(rows, "time of birth");
  ASSERT_EQ(z.values.size(), 2u);
  EXPECT_NEAR(*z.values[0] / *z.values[1], 2, 0.1);
  EXPECT_TRUE(birth.values.at(0));
  b.scenario.reset();
  EXPECT_FALSE(find(compare({&a, &b}), "mean head speed").values.at(1));
}

}  // namespace
}  // namespace carus::report
