// SPDX-License-Identifier: Apache-2.0
#include "carus/solve/explicit.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "carus/core/error.hpp"
#include "carus/solve/mass.hpp"
#include "support/element_forces.hpp"
#include "support/models.hpp"

namespace carus::solve {
namespace {

constexpr double shear = 20e3;  // [Pa]

Vec3 momentum(const Masses& m, const fem::State& s, std::size_t first = 0) {
  Vec3 p = Vec3::Zero();
  for (std::size_t i = first; i < s.v.size(); ++i) p += m.scaled[i] * s.v[i];
  return p;
}

/// A ball above a box; the box is the first label.
fem::Model ball_and_box(bool fixed_box) {
  const auto box = shapes::box({-0.05, -0.05, -0.05}, {0.1, 0.1, 0.05}, 6, 6, 3, 0);
  auto m = models::of(shapes::join(box, shapes::ball({0.003, -0.002, 0.0315}, 0.03, 8, 1)),
                      {models::soft(material::Law::neo_hooke, 2 * shear, 0.45),
                       models::soft(material::Law::mooney_rivlin, shear, 0.45)});
  if (fixed_box) models::block(m, fem::all, [](const Vec3& X) { return X.z() < -0.0499; });
  m.contact_surfaces = {models::skin(m.mesh, "box", 0), models::skin(m.mesh, "ball", 1)};
  m.contact_pairs = {{0, 1, 0}};
  return m;
}

void throw_ball(const fem::Model& m, fem::State& s, const Vec3& v) {
  for (std::size_t e = 0; e < m.mesh.tets.size(); ++e) {
    if (m.mesh.labels[e] != 1) continue;
    for (const auto n : m.mesh.tets[e]) s.v[n] = v;
  }
}

TEST(Explicit, FreeFlightKeepsMomentumAndEnergy) {
  const auto m = models::of(shapes::ball(Vec3::Zero(), 0.03, 6), {models::soft(material::Law::neo_hooke, shear, 0.45)});
  auto o = models::real_time(0.1, 5e-5);
  Explicit s(m, o);
  const Masses masses = scaled_masses(m, s.step_report().time_step, o.safety);
  // A spin, a throw and an oscillation at once.
  models::set(s, [&](fem::State& st) {
    for (std::size_t i = 0; i < st.x.size(); ++i) {
      st.v[i] = Vec3(0.3, -0.2, 0.1) + Vec3(2, 5, -3).cross(st.x[i]) + Vec3(4 * st.x[i].x(), 0, -4 * st.x[i].z());
    }
  });
  const Vec3 p = momentum(masses, s.state());
  const double energy = s.observe().kinetic;
  const auto turning = [&] {
    Vec3 sum = Vec3::Zero();
    for (std::size_t i = 0; i < s.state().x.size(); ++i) sum += masses.scaled[i] * s.state().x[i].cross(s.state().v[i]);
    return sum;
  };
  const Vec3 spin = turning();
  double wiggle = 0;
  for (int k = 1; k <= 10; ++k) {
    s.advance_to(0.01 * k);
    const auto o1 = s.observe();
    wiggle = std::max(wiggle, o1.internal);
    // Leapfrog: kinetic energy is half a step late, so the sum wavers by the share of what oscillates in a step.
    EXPECT_NEAR(o1.kinetic + o1.internal, energy, 0.01 * energy);
  }
  EXPECT_GT(wiggle, 0.02 * energy);  // the oscillation was there
  EXPECT_LT((momentum(masses, s.state()) - p).norm(),
            1e-6 * p.norm());                                // 2000 steps of single-precision internal forces
  EXPECT_LT((turning() - spin).norm(), 1e-3 * spin.norm());  // moments of forces rounded against x: see ElementForces
}

TEST(Explicit, ImpactKeepsMomentumAndOnlyTakesEnergy) {
  const auto m = ball_and_box(false);
  auto o = models::real_time(0.06, 4e-5);
  Explicit s(m, o);
  const Masses masses = scaled_masses(m, s.step_report().time_step, o.safety);
  models::set(s, [&](fem::State& st) { throw_ball(m, st, {0.1, 0, -1}); });
  const Vec3 p = momentum(masses, s.state());
  const double energy = s.observe().kinetic;
  double most_contact = 0;
  for (int k = 1; k <= 30; ++k) {
    s.advance_to(0.002 * k);
    const auto o1 = s.observe();
    const double now = o1.kinetic + o1.internal;
    // Never more than at the start (leapfrog's half-step lag lets the sum waver by some 0.1 %). The normal of the
    // smooth gap is not quite its gradient: 1.5 % of the energy that contact takes while the ball goes in, it returns
    // while it comes out.
    EXPECT_LT(now, energy * (1 + 2e-3)) << s.state().time;
    EXPECT_LT(o1.contact_work, 1e-4 * energy) << s.state().time;
    EXPECT_LT(o1.contact_work, most_contact + 0.02 * energy) << s.state().time;
    // Contact work is what is missing.
    EXPECT_NEAR(now, energy + o1.contact_work, 0.01 * energy) << s.state().time;
    EXPECT_GT(o1.least_gap, -2e-4);
    most_contact = std::min(most_contact, o1.contact_work);
  }
  std::printf("contact took %.2f %% of the energy, %.2f %% in the end\n", -100 * most_contact / energy,
              -100 * s.observe().contact_work / energy);
  EXPECT_LT((momentum(masses, s.state()) - p).norm(), 1e-6 * p.norm());
  double box_speed = s.state().v[0].z();
  for (std::size_t i = 0; i < 100; ++i) box_speed = std::min(box_speed, s.state().v[i].z());
  EXPECT_LT(box_speed, -0.01);  // it was hit
}

TEST(Explicit, ThreadsDoNotChangeABit) {
  const auto m = ball_and_box(true);
  std::vector<fem::State> ends;
  for (const int threads : {1, 2, 4}) {
    auto o = models::real_time(0.03, 4e-5, 20);
    o.threads = threads;
    Explicit s(m, o);
    models::set(s, [&](fem::State& st) { throw_ball(m, st, {0.1, 0, -1}); });
    s.advance_to(0.03);
    EXPECT_LT(s.observe().contact_work, 0);
    ends.push_back(s.state());
  }
  for (std::size_t k = 1; k < ends.size(); ++k) {
    EXPECT_EQ(ends[k].internal, ends[0].internal);
    for (std::size_t i = 0; i < ends[0].x.size(); ++i) {
      ASSERT_EQ(ends[k].x[i], ends[0].x[i]);
      ASSERT_EQ(ends[k].v[i], ends[0].v[i]);
    }
  }
}

/// Ball on box as a labour: time scale 100, relaxation on the ball, ratchet in the box.
fem::Model labouring() {
  auto m = ball_and_box(true);
  m.regions[1].material.prony = {{0.3, 2.0}, {0.2, 20.0}};
  m.regions[0].material.average_nodal_pressure = true;
  auto& r = m.retraction;
  r.kind = fem::Retraction::Kind::ratchet;
  for (std::size_t e = 0; e < m.mesh.tets.size(); ++e) {
    if (m.mesh.labels[e] != 0) continue;
    r.elements.push_back(std::int32_t(e));
    r.meridian.push_back(Vec3::UnitX()), r.normal.push_back(Vec3::UnitZ());
    r.dome.push_back(0.3), r.strength.push_back(1);
    r.s.push_back(m.mesh.nodes[m.mesh.tets[e][0]].x());
  }
  r.tau = 0.5;
  r.activity = [](double t) { return t > 1.2 ? 1.0 : 0.0; };
  fem::PressureLoad load;
  load.surface = models::facets(m.mesh, [](const Vec3& X) { return std::abs(std::abs(X.x()) - 0.05) < 1e-9; });
  load.pressure = [](double t) { return 2e3 * std::min(1.0, t); };
  m.pressures = {load};
  return m;
}

ExplicitOptions hundredfold() {
  auto o = models::real_time(0.04, 4e-5);
  o.labour_duration = 4;
  o.drag = 100;
  return o;
}

class Resumed : public testing::TestWithParam<double> {};

/// At a pace that stays, and at one that changes on the way.
TEST_P(Resumed, RestoreContinuesBitForBit) {
  const auto m = labouring();
  const auto hundredfold = [] {
    auto o = solve::hundredfold();
    o.pace = {0.04, 1 / GetParam(), GetParam()};
    return o;
  };
  Explicit through(m, hundredfold());
  models::set(through, [&](fem::State& st) { throw_ball(m, st, {0.1, 0, -1}); });
  for (const double saved_at : {0.4, 1.0, 2.0, 3.0}) {  // before and after the muscle acts, before and in contact
    through.advance_to(saved_at);
    const fem::State saved = through.state();
    Explicit resumed(m, hundredfold());
    resumed.restore(saved);
    Explicit twin(m, hundredfold());
    twin.advance_to(0.2);  // a solver that has a past of its own
    twin.restore(saved);
    through.advance_to(saved_at + 0.9), resumed.advance_to(saved_at + 0.9), twin.advance_to(saved_at + 0.9);
    EXPECT_EQ(resumed.state().internal, through.state().internal) << saved_at;
    EXPECT_EQ(twin.state().internal, through.state().internal) << saved_at;
    EXPECT_EQ(resumed.state().rest_length, through.state().rest_length) << saved_at;
    for (std::size_t i = 0; i < saved.x.size(); ++i) {
      ASSERT_EQ(resumed.state().x[i], through.state().x[i]) << saved_at;
      ASSERT_EQ(twin.state().x[i], through.state().x[i]) << saved_at;
    }
    through.restore(saved);
  }
  through.advance_to(4);
  EXPECT_LT(through.observe().rest_length_mean, 0.999);  // the ratchet acted
  EXPECT_EQ(through.state().labour_per_pseudo != 100, GetParam() > 1);
}
INSTANTIATE_TEST_SUITE_P(Explicit, Resumed, testing::Values(1, 4));

/// Two loads with a long rest between them: at a varying pace fewer steps lead to the same places.
TEST(Explicit, APaceThatFollowsTheLabourChangesStepsNotPositions) {
  auto m = models::of(shapes::box({0, 0, 0}, {0.1, 0.03, 0.03}, 8, 2, 2),
                      {models::soft(material::Law::neo_hooke, shear, 0.4)});
  models::block(m, fem::all, [](const Vec3& X) { return X.x() < 1e-9; });
  m.regions[0].material.prony = {{0.3, 20.0}};
  fem::PressureLoad load;
  load.surface = models::facets(m.mesh, [](const Vec3& X) { return X.z() > 0.0299; });
  load.pressure = [](double t) {
    return 100 * std::clamp(std::min(t / 20, (100 - t) / 20), 0.0, 1.0) + (t > 300 ? 5 * std::min(t - 300, 20.0) : 0.0);
  };
  m.pressures = {load};
  auto o = models::real_time(4, 2e-4);
  o.labour_duration = 400, o.drag = 20000;
  Explicit even(m, o);
  o.pace = {0.04, 1, 4};
  Explicit paced(m, o);
  double furthest = 0;
  for (double t = 10; t <= 400; t += 10) {
    even.advance_to(t), paced.advance_to(t);
    EXPECT_NEAR(paced.state().time, t, 0.1);
    for (std::size_t i = 0; i < m.mesh.nodes.size(); ++i) {
      const double moved = (even.state().x[i] - m.mesh.nodes[i]).norm();
      furthest = std::max(furthest, moved);
      EXPECT_NEAR((paced.state().x[i] - even.state().x[i]).norm(), 0, 2e-4) << t;
    }
  }
  EXPECT_GT(furthest, 5e-3);
  EXPECT_LT(paced.state().step, 0.9 * double(even.state().step));
}

/// A state saved before anything has moved the rest length: the first restore must not change a rounding.
TEST(Explicit, RestoreAtTheStartChangesNothing) {
  const auto m = labouring();
  Explicit plain(m, hundredfold()), restored(m, hundredfold());
  restored.restore(restored.state());
  plain.advance_to(0.5), restored.advance_to(0.5);
  for (std::size_t i = 0; i < m.mesh.nodes.size(); ++i) ASSERT_EQ(plain.state().x[i], restored.state().x[i]);
}

TEST(Explicit, InversionNamesOrganAndElementAndKeepsTheLastGoodState) {
  auto m = models::of(shapes::box({0, 0, 0}, {0.1, 0.1, 0.1}, 3, 3, 3),
                      {models::soft(material::Law::neo_hooke, shear, 0.45)});
  m.regions[0].name = "cervix";
  fem::PressureLoad load;
  load.surface = models::facets(m.mesh, [](const Vec3& X) { return X.z() > 0.0999; });
  load.pressure = [](double t) { return t > 0.0105 ? 1e7 : 0.0; };
  m.pressures = {load};
  models::block(m, fem::all, [](const Vec3& X) { return X.z() < 1e-9; });
  Explicit s(m, models::real_time(0.1, 1e-4));
  s.advance_to(0.01);
  const fem::State good = s.state();
  try {
    s.advance_to(0.05);
    FAIL() << "inversion went unseen";
  } catch (const NumericalFailure& failure) {
    const std::string what = failure.what();
    EXPECT_NE(what.find("inversion of element "), std::string::npos) << what;
    EXPECT_NE(what.find("cervix"), std::string::npos) << what;
  }
  EXPECT_EQ(s.state().step, good.step);
  for (std::size_t i = 0; i < good.x.size(); ++i) EXPECT_EQ(s.state().x[i], good.x[i]);
}

TEST(Explicit, NaNIsANumericalFailure) {
  const auto m = models::of(shapes::box({0, 0, 0}, {0.1, 0.1, 0.1}, 3, 3, 3),
                            {models::soft(material::Law::neo_hooke, shear, 0.45)});
  Explicit s(m, models::real_time(0.1, 1e-4));
  models::set(s, [](fem::State& st) { st.v[5].x() = std::numeric_limits<double>::quiet_NaN(); });
  try {
    s.advance_to(0.05);
    FAIL() << "NaN went unseen";
  } catch (const NumericalFailure& failure) {
    EXPECT_NE(std::string(failure.what()).find("non-finite state of element "), std::string::npos) << failure.what();
  }
}

/// A spring that answers some steps late feeds what swings on it: after 16 periods little would be left of this block.
TEST(Explicit, SwingingOnTethersGainsNoEnergy) {
  auto m = models::of(shapes::box({0, 0, 0}, Vec3::Constant(0.04), 3, 3, 3),
                      {models::soft(material::Law::neo_hooke, shear, 0.45)});
  const auto o = models::real_time(0.05, 5e-5);
  const Masses masses = scaled_masses(m, o.time_step, o.safety);
  constexpr double omega = 2000;  // [1/s]: a tenth of a radian in a step
  for (std::size_t i = 0; i < masses.scaled.size(); ++i)
    m.tethers.push_back({std::int32_t(i), Vec3::UnitX(), omega * omega * masses.scaled[i]});
  Explicit s(m, o);
  models::set(s, [](fem::State& st) { std::fill(st.v.begin(), st.v.end(), Vec3(1, 0, 0)); });
  const double start = s.observe().kinetic;
  for (int k = 1; k <= 10; ++k) {
    s.advance_to(0.005 * k);
    const auto seen = s.observe();
    // Velocities live half a step before the positions: the sum swings by omega dt / 2.
    EXPECT_NEAR(seen.kinetic + seen.internal, start, 0.06 * start) << s.state().time;
  }
}

/// Everything at once: loads, drag, contact, tethers, active strain and relaxation. What is there = what came in.
TEST(Explicit, EnergyBalances) {
  auto m = labouring();
  for (std::size_t i = 0; i < m.mesh.nodes.size(); ++i) {
    if (m.mesh.nodes[i].z() > 0.055) m.tethers.push_back({std::int32_t(i), Vec3(0.6, 0.8, 0), 3});
  }
  Explicit s(m, hundredfold());
  models::set(s, [&](fem::State& st) { throw_ball(m, st, {0.1, 0, -1}); });
  const double start = s.observe().kinetic;
  for (int k = 1; k <= 8; ++k) {
    s.advance_to(0.5 * k);
    const auto o = s.observe();
    const double there = o.kinetic + o.internal,
                 came = start + o.external_work + o.contact_work - o.damping_work + o.active_work + o.relaxation_work;
    EXPECT_NEAR(there, came, 0.01 * (start + std::abs(o.external_work) + std::abs(o.active_work))) << s.state().time;
  }
  const auto o = s.observe();
  EXPECT_GT(o.external_work, 0.01 * start);
  EXPECT_GT(o.damping_work, 0.01 * start);
  EXPECT_NE(o.active_work, 0);
  EXPECT_NE(o.relaxation_work, 0);
}

TEST(Masses, StepIsSafeAndScalingIsLocal) {
  // One region, one flat layer of elements: only it gets heavier.
  auto mesh = shapes::grid(4, 4, 4,
                           [](const Vec3& u) -> Vec3 { return Vec3(u.x(), u.y(), u.z() < 0.9 ? u.z() : 0.755) * 0.1; });
  const auto m = models::of(std::move(mesh), {models::soft(material::Law::neo_hooke, shear, 0.45)});
  const auto none = scaled_masses(m, 1e-9, 0.5);
  EXPECT_EQ(none.added_fraction, 0);
  double total = 0;
  for (const double x : none.unscaled) total += x;
  EXPECT_NEAR(total, 1000 * 0.1 * 0.1 * 0.0755, 1e-9);
  // The bound 1/sqrt(c^2 sum |grad N|^2) never exceeds a regular element's h/c.
  EXPECT_LT(none.critical_step, 0.0005 / models::wave_speed(m.regions[0].material));
  const auto scaled = scaled_masses(m, 10 * none.critical_step, 0.5);
  EXPECT_GT(scaled.added_fraction, 0);
  for (std::size_t i = 0; i < scaled.scaled.size(); ++i) {
    if (m.mesh.nodes[i].z() < 0.0749) {
      EXPECT_EQ(scaled.scaled[i], scaled.unscaled[i]);
    } else {
      EXPECT_GT(scaled.scaled[i], scaled.unscaled[i]);
    }
  }
}

/// At safety 1 of the critical step the free oscillation of an irregular block stays bounded: the estimate is safe.
TEST(Masses, CriticalStepIsStable) {
  auto mesh = shapes::box({0, 0, 0}, {0.1, 0.1, 0.1}, 4, 4, 4);
  shapes::shake(mesh, 0.01);
  for (const double poisson : {0.3, 0.49}) {
    const auto m = models::of(mesh, {models::soft(material::Law::neo_hooke, shear, poisson)});
    double step = 1e30;
    for (std::size_t e = 0; e < mesh.tets.size(); ++e) step = std::min(step, critical_step(m, e));
    auto o = models::real_time(2000 * step, step);
    o.safety = 1;
    Explicit s(m, o);
    models::set(s, [](fem::State& st) {
      for (std::size_t i = 0; i < st.v.size(); ++i)
        st.v[i] = 0.01 * Vec3(double(i % 3) - 1, double(i % 5) - 2, double(i % 7) - 3);
    });
    const double energy = s.observe().kinetic;
    s.advance_to(2000 * step);
    const auto o1 = s.observe();
    EXPECT_LT(o1.kinetic + o1.internal, 1.5 * energy)
        << poisson;  // highest modes at the edge of stability waver, they do not grow
  }
}

}  // namespace
}  // namespace carus::solve
