// SPDX-License-Identifier: Apache-2.0
#include "carus/report/trajectory.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <nlohmann/json.hpp>

#include "small_run.hpp"

namespace carus::report {
namespace {

namespace fs = std::filesystem;
using testing::HasSubstr;

labour::Contractions three() {
  labour::Contractions c;
  c.first = 30, c.period = 240, c.duration = 90, c.rise = c.fall = 30;
  return c;
}

/// 100 mm straight down and 50 forward in 500 s at constant speed, turning 90° round z.
Motion steady() {
  Motion m;
  for (int i = 0; i <= 50; ++i) {
    const double s = i / 50.0;
    m.time.push_back(500 * s), m.displacement.emplace_back(0, 50 * s, -100 * s), m.rotation.emplace_back(0, 0, 90 * s);
    m.travel.push_back(112 * s);
  }
  return m;
}

double cell(const Trajectory& t, std::size_t row, const std::string& column) {
  const auto at = std::find(t.columns.begin(), t.columns.end(), column);
  EXPECT_NE(at, t.columns.end()) << column;
  return at == t.columns.end() ? NAN : t.rows.at(row)[std::size_t(at - t.columns.begin())];
}

TEST(Trajectory, OfASteadyMotionIsItsClosedForm) {
  TrajectoryOptions o;
  o.rate = 4;
  const auto t = resample(steady(), three(), o);
  ASSERT_EQ(t.rows.size(), 2001u);
  const double length = std::hypot(100, 50);
  for (const std::size_t i : {0u, 17u, 1000u, 2000u}) {
    const double s = double(i) / 2000;
    EXPECT_NEAR(cell(t, i, "time_s"), 500 * s, 1e-9);
    EXPECT_NEAR(cell(t, i, "head_z_mm"), -100 * s, 1e-9);
    EXPECT_NEAR(cell(t, i, "turn_z_deg"), 90 * s, 1e-9);
    EXPECT_NEAR(cell(t, i, "quaternion_w"), std::cos(pi / 4 * s), 1e-9);
    EXPECT_NEAR(cell(t, i, "quaternion_z"), std::sin(pi / 4 * s), 1e-9);
    EXPECT_NEAR(cell(t, i, "velocity_y_mm_s"), 0.1, 1e-9);
    EXPECT_NEAR(cell(t, i, "angular_z_deg_s"), 0.18, 1e-9);
    EXPECT_NEAR(cell(t, i, "axis_mm"), length * s, 1e-9);
    EXPECT_NEAR(cell(t, i, "axis_speed_mm_s"), length / 500, 1e-9);
    EXPECT_NEAR(cell(t, i, "imposed_linear_mm"), length * s, 1e-9);
  }
  EXPECT_EQ(t.time_stretch, 1);
  EXPECT_NEAR(t.stroke_high - t.stroke_low, length, 1e-9);
}

TEST(Trajectory, RowsEndAtTheEndWhateverTheRate) {
  TrajectoryOptions o;
  o.rate = 0.0123;
  const auto t = resample(steady(), {}, o);
  EXPECT_EQ(t.rows.size(), 8u);  // 0, 81.3, ... 487.8, 500
  EXPECT_EQ(cell(t, 7, "time_s"), 500);
  EXPECT_EQ(std::count(t.columns.begin(), t.columns.end(), "imposed_cyclic_mm"), 0);
}

/// Angular velocity of a turn whose axis moves, against finite differences of the rotation itself.
TEST(Trajectory, AngularVelocityIsThatOfTheRotation) {
  Motion m = steady();
  for (std::size_t i = 0; i < m.time.size(); ++i) {
    const double s = m.time[i] / 500;
    m.rotation[i] = Vec3(60 * s, 40 * s * s, 80 * s);
  }
  TrajectoryOptions o;
  o.rate = 100;
  const auto t = resample(m, {}, o);
  double largest = 0;
  for (const std::size_t i : {5005u, 20010u, 40010u}) {
    const auto q = [&](std::size_t row) {
      return Eigen::Quaterniond(cell(t, row, "quaternion_w"), cell(t, row, "quaternion_x"),
                                cell(t, row, "quaternion_y"), cell(t, row, "quaternion_z"));
    };
    const Eigen::AngleAxisd turn(q(i + 1) * q(i - 1).conjugate());  // in fixed axes
    const Vec3 w = turn.axis() * turn.angle() / 0.02 * 180 / pi;
    EXPECT_NEAR(w.x(), cell(t, i, "angular_x_deg_s"), 1e-5);
    EXPECT_NEAR(w.y(), cell(t, i, "angular_y_deg_s"), 1e-5);
    EXPECT_NEAR(w.z(), cell(t, i, "angular_z_deg_s"), 1e-5);
    largest = std::max(largest, w.norm());
  }
  EXPECT_GT(largest, 0.1);
}

TEST(Trajectory, LimitsAreRefusedWithPlaceAndValue) {
  Motion m = steady();
  for (std::size_t i = 0; i < m.time.size(); ++i) {  // a jump of 20 mm between 300 and 310 s
    if (m.time[i] >= 310) m.displacement[i].z() -= 20;
  }
  TrajectoryOptions o;
  o.axis = Axis::z;
  o.limits.speed = 1, o.limits.acceleration = 0.1, o.limits.stroke = 110;
  const auto message = test::error_of([&] { resample(m, {}, o); });
  EXPECT_THAT(message, HasSubstr("speed along the axis"));
  EXPECT_THAT(message, HasSubstr("at 305.0 s; allowed 1 mm/s"));
  EXPECT_THAT(message, HasSubstr("acceleration along the axis"));
  EXPECT_THAT(message, HasSubstr("stroke along the axis: 120.00 mm"));
  // Slowing down cures the first two, and only them.
  o.slow_down = true;
  const auto stroke_only = test::error_of([&] { resample(m, {}, o); });
  EXPECT_THAT(stroke_only, testing::StartsWith("stroke"));
  o.limits.stroke = 121;
  const auto t = resample(m, {}, o);
  EXPECT_GT(t.time_stretch, 1);
  double speed = 0, acceleration = 0;
  for (std::size_t i = 0; i < t.rows.size(); ++i) {
    speed = std::max(speed, std::abs(cell(t, i, "axis_speed_mm_s")));
    acceleration = std::max(acceleration, std::abs(cell(t, i, "axis_acceleration_mm_s2")));
  }
  EXPECT_LE(speed, 1);
  EXPECT_LE(acceleration, 0.1);
  EXPECT_TRUE(speed > 0.95 || acceleration > 0.095) << "no slower than it must be";
  EXPECT_NEAR(t.rows.back()[0], 500 * t.time_stretch, 1e-6);
  EXPECT_NEAR(cell(t, t.rows.size() - 1, "head_z_mm"), -120, 1e-9);
}

TEST(Trajectory, TooManyRowsAreRefused) {
  TrajectoryOptions o;
  o.rate = 1e5;
  EXPECT_THAT(test::error_of([&] { resample(steady(), {}, o); }), HasSubstr("lower --rate"));
}

TEST(Imposed, CyclicGoesDownInContractionsAndBackInRestsToTheSameEnd) {
  const auto r = imposed_cyclic(600, 90, three(), 0.25);  // contractions at 30, 270, 510 s
  // 3 a - 2 (a/4) = 90
  const double a = 36;
  EXPECT_NEAR(r.at(0), 0, 1e-12);
  EXPECT_NEAR(r.at(30), 0, 1e-12);
  EXPECT_NEAR(r.at(60), a / 2, 1e-12);
  EXPECT_NEAR(r.at(90), a, 1e-12);
  EXPECT_NEAR(r.at(270), 0.75 * a, 1e-12);
  EXPECT_NEAR(r.at(330), 1.75 * a, 1e-12);
  EXPECT_NEAR(r.at(570), 90, 1e-12);
  EXPECT_NEAR(r.at(600), 90, 1e-12);
  // Born in the middle of a contraction: the last advance ends there.
  EXPECT_NEAR(imposed_cyclic(540, 90, three(), 0.25).at(525), 90 - a / 2, 1e-12);
  EXPECT_NEAR(imposed_cyclic(20, 90, three(), 0.25).at(10), 45, 1e-12) << "no contraction: linear";
  EXPECT_NEAR(imposed_linear(600, 90).at(200), 30, 1e-12);
}

TEST(Motion, IsUnwrappedWhereTheRotationPassesHalfATurn) {
  Folder f;
  f.path = "x";
  f.curves.names = {"time_s",         "head_x_mm",       "head_y_mm",       "head_z_mm",
                    "head_travel_mm", "head_turn_x_deg", "head_turn_y_deg", "head_turn_z_deg"};
  for (int i = 0; i <= 20; ++i) {
    double turn = 15.0 * i;  // to 300°; a fit reports it within ±180
    if (turn > 180) turn -= 360;
    f.curves.rows.push_back({double(i), 0, 0, -double(i), double(i), 0, 0, turn});
  }
  const auto m = motion_of(f);
  for (int i = 0; i <= 20; ++i) EXPECT_NEAR(m.rotation[i].z(), 15 * i, 1e-9);
  f.curves.names[5] = "other";
  EXPECT_THAT(test::error_of([&] { motion_of(f); }), HasSubstr("head_turn_x_deg"));
  f.curves.names[5] = "head_turn_x_deg";
  f.curves.rows[3][2] = NAN;
  EXPECT_THAT(test::error_of([&] { motion_of(f); }), HasSubstr("line 5"));
}

TEST(Trajectory, OfARunAgreesWithItsCurvesInBothFiles) {
  const test::Folder folder("report_trajectory");
  test::write_small_run(folder / "run");
  const auto run = read_folder(folder / "run");
  auto motion = motion_of(run);
  std::vector<std::string> notes;
  add_wrench(motion, run, notes);
  EXPECT_THAT(notes, testing::IsEmpty());
  ASSERT_FALSE(motion.wrench.empty());
  TrajectoryOptions o;
  o.rate = 1;
  const auto t = resample(motion, run.scenario->loads.contractions, o);
  // At an output the resampled pose is the output's.
  const auto time = run.curves.column("time_s"), z = run.curves.column("head_z_mm");
  EXPECT_NEAR(cell(t, 60, "head_z_mm"), z[std::size_t(std::find(time.begin(), time.end(), 60) - time.begin())], 1e-9);
  EXPECT_LT(z.back(), -50);

  const auto csv = as_csv(t);
  EXPECT_EQ(std::size_t(std::count(csv.begin(), csv.end(), '\n')), t.rows.size() + 1);
  const auto j = nlohmann::json::parse(as_json(t, run));
  EXPECT_EQ(j["format"], "carus-trajectory-1");
  ASSERT_EQ(j["rows"].size(), t.rows.size());
  EXPECT_EQ(j["columns"].size(), j["rows"][0].size());
  EXPECT_NEAR(j["rows"][60][4].get<double>(), cell(t, 60, "head_z_mm"), 1e-6);
  EXPECT_EQ(j["units"]["length"], "mm");
  const auto schema =
      nlohmann::json::parse(test::text_of(fs::path(CARUS_SOURCE_DIR) / "schema" / "trajectory.schema.json"));
  const auto fits = [&](const nlohmann::json& value, const nlohmann::json& rule) {
    for (const auto& key : rule["required"]) EXPECT_TRUE(value.contains(key.get<std::string>())) << key;
    for (const auto& [key, unused] : value.items()) EXPECT_TRUE(rule["properties"].contains(key)) << key;
  };
  fits(j, schema);
  for (const char* part : {"source", "frame", "interpolation", "axis", "limits", "imposed"})
    fits(j[part], schema["properties"][part]);
}

}  // namespace
}  // namespace carus::report
