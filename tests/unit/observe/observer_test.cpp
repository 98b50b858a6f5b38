// SPDX-License-Identifier: Apache-2.0
#include "carus/observe/observer.hpp"

#include <gtest/gtest.h>

#include <Eigen/Geometry>

#include "blocks.hpp"
#include "carus/core/error.hpp"
#include "carus/observe/milestones.hpp"

namespace carus::observe {
namespace {

class BoxObserver : public testing::Test {
 protected:
  fem::Model model = test::fetus_of_boxes();
  Observer observer{model, test::setup_of_boxes()};
  solve::Observables seen;

  fem::State moved(double time, const std::function<Vec3(const Vec3&)>& f) const {
    fem::State s;
    s.time = time;
    for (const auto& x : model.mesh.nodes) s.x.push_back(f(x));
    s.v.assign(s.x.size(), Vec3::Zero());
    return s;
  }
  double value(const Values& v, const std::string& name) const { return v[observer.index(name)]; }
};

TEST_F(BoxObserver, AtRestNothingHasMoved) {
  const auto v = observer.measure(moved(0, [](const Vec3& x) { return x; }), seen, nullptr);
  for (const char* name : {"head_x_mm", "head_y_mm", "head_z_mm", "head_travel_mm", "internal_rotation_deg",
                           "trunk_rotation_deg", "moulding_occipitofrontal_mm", "moulding_biparietal_mm",
                           "moulding_vertical_mm", "skull_volume_change_percent", "penetration_mm", "inverted_count"}) {
    EXPECT_NEAR(value(v, name), 0, 1e-9) << name;
  }
  EXPECT_NEAR(value(v, "volume_skull_ml"), 80 * 100 * 80 * 1e-3, 1e-9);
  EXPECT_NEAR(value(v, "min_J_ratio"), 1, 1e-12);
  EXPECT_NEAR(value(v, "occiput_deg"), -90, 1e-9);  // to the mother's left
  EXPECT_NEAR(value(v, "station_mm"), -50, 1e-9);
  EXPECT_NEAR(value(v, "skull_past_vulva_mm"), -180, 1e-9);
}

TEST_F(BoxObserver, ReadsATurnADescentAndASpeed) {
  const auto rest = observer.measure(moved(0, [](const Vec3& x) { return x; }), seen, nullptr);
  const Mat3 R = Eigen::AngleAxisd(-pi / 3, Vec3::UnitZ()).toRotationMatrix();
  const auto v =
      observer.measure(moved(100, [&](const Vec3& x) { return Vec3(R * x + Vec3(0.001, 0.02, -0.03)); }), seen, &rest);
  EXPECT_NEAR(value(v, "head_x_mm"), 1, 1e-9);
  EXPECT_NEAR(value(v, "head_y_mm"), 20, 1e-9);
  EXPECT_NEAR(value(v, "head_z_mm"), -30, 1e-9);
  EXPECT_NEAR(value(v, "head_speed_mm_s"), 0.3, 1e-12);
  EXPECT_NEAR(value(v, "head_path_speed_mm_s"), 0.3, 1e-12);
  EXPECT_NEAR(value(v, "internal_rotation_deg"), 60, 1e-9);
  EXPECT_NEAR(value(v, "occiput_deg"), -30, 1e-9);
  EXPECT_NEAR(value(v, "trunk_rotation_deg"), 60, 1e-9);
  EXPECT_NEAR(value(v, "head_turn_z_deg"), -60, 1e-9);
  EXPECT_NEAR(value(v, "moulding_vertical_mm"), 0, 1e-9);
}

TEST_F(BoxObserver, MouldingIsMeasuredAlongTheHeadsOwnAxes) {
  // Head lengthened along occiput-forehead (rest x) by 5 %, then turned: 80 mm become 84.
  const Mat3 R = Eigen::AngleAxisd(0.7, Vec3(1, 1, 2).normalized()).toRotationMatrix();
  const auto v = observer.measure(moved(1, [&](const Vec3& x) { return Vec3(R * Vec3(1.05 * x.x(), x.y(), x.z())); }),
                                  seen, nullptr);
  EXPECT_NEAR(value(v, "moulding_occipitofrontal_mm"), 4, 1e-6);
  EXPECT_NEAR(value(v, "moulding_biparietal_mm"), 0, 1e-6);
  EXPECT_NEAR(value(v, "skull_volume_change_percent"), 5, 1e-9);
}

TEST_F(BoxObserver, ForcesOnTheFetusAreSplitAlongTheCanal) {
  seen.contact_force.assign(model.mesh.nodes.size(), Vec3::Zero());
  seen.contact_force[0] = {0, 3, 10};                             // on the head from below: holds it up
  seen.contact_force[model.mesh.nodes.size() - 1] = {0, 0, -60};  // on the trunk from above
  const auto v = observer.measure(moved(0, [](const Vec3& x) { return x; }), seen, nullptr);
  EXPECT_NEAR(value(v, "expulsive_force_n"), 10, 1e-12);
  EXPECT_NEAR(value(v, "axial_contact_force_n"), 50, 1e-12);
  EXPECT_NEAR(value(v, "head_contact_force_n"), std::hypot(3, 10), 1e-12);
  EXPECT_GT(value(v, "head_pressure_max_kpa"), 0);
}

TEST_F(BoxObserver, BirthIsWhenTheLastNodeOfTheSkullHasPassed) {
  Table table{observer.names(), {}};
  const auto descend = [&](double time, double z) {
    const auto state = moved(time, [=](const Vec3& x) { return Vec3(x + Vec3(0, 0, -z)); });
    table.rows.push_back(observer.measure(state, seen, table.rows.empty() ? nullptr : &table.rows.back()));
  };
  const auto born = [&] {
    for (const auto& m : milestones(table)) {
      if (m.name == "birth") return m.time;
    }
    return -1.0;
  };
  descend(0, 0), descend(10, 0.1799999);
  EXPECT_EQ(born(), -1);  // one layer of nodes is still a tenth of a micrometre inside
  descend(20, 0.1800001);
  EXPECT_NEAR(born(), 15, 1e-3);
  std::vector<std::string> order;
  for (const auto& m : milestones(table)) order.push_back(m.name);
  EXPECT_EQ(order.back(), "birth");
}

TEST(Observer, NamesWhatTheAnatomyLacks) {
  const auto model = test::fetus_of_boxes();
  auto setup = test::setup_of_boxes();
  setup.landmarks.erase("occiput");
  setup.head_regions = {"cranium"};
  try {
    const Observer observer(model, setup);
    FAIL() << "accepted";
  } catch (const InputError& e) {
    ASSERT_EQ(e.problems().size(), 2u);
    EXPECT_EQ(e.problems()[0], "anatomy: landmark occiput: missing; the measurements need it");
    EXPECT_EQ(e.problems()[1], "model: regions of the head: no elements; the pose is fitted to them");
  }
}

}  // namespace
}  // namespace carus::observe
