// SPDX-License-Identifier: Apache-2.0
// Active strain on a tube of muscle: the rest length of the wall and what becomes of the wall.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "support/models.hpp"

namespace carus {
namespace {

constexpr double shear = 20e3, inner = 0.03, outer = 0.038, length = 0.12;  // [Pa], [m]

/// A tube along z, held below, free above.
fem::Model tube(int around, int along, fem::Retraction::Kind kind) {
  auto muscle = models::soft(material::Law::neo_hooke, shear, 0.45);
  muscle.average_nodal_pressure = true;
  auto m = models::of(shapes::tube(inner, outer, 0, length, 2, around, along), {muscle});
  models::block(m, fem::all, [](const Vec3& X) { return X.z() < 1e-9; });
  auto& r = m.retraction;
  r.kind = kind;
  for (std::size_t e = 0; e < m.mesh.tets.size(); ++e) {
    Vec3 centre = Vec3::Zero();
    for (const auto n : m.mesh.tets[e]) centre += 0.25 * m.mesh.nodes[n];
    r.elements.push_back(std::int32_t(e));
    r.meridian.push_back(Vec3::UnitZ()), r.normal.push_back(Vec3(centre.x(), centre.y(), 0).normalized());
    r.dome.push_back(0), r.strength.push_back(1), r.s.push_back(centre.z());
  }
  return m;
}

double height(const fem::Model& m, const fem::State& s) {
  double sum = 0;
  int n = 0;
  for (std::size_t i = 0; i < s.x.size(); ++i) {
    if (m.mesh.nodes[i].z() > length - 1e-9) sum += s.x[i].z(), ++n;
  }
  return sum / n;
}

struct Course {
  std::vector<double> rest_length, height;
};

/// Three contractions of 20 s in 20 s rests, 120 s of labour in 2.4 s: the top ring is pushed down while the muscle
/// works.
Course contractions(int around, int along) {
  auto m = tube(around, along, fem::Retraction::Kind::ratchet);
  const auto active = [](double t) { return std::fmod(t, 40.0) < 19.9 ? 1.0 : 0.0; };
  m.retraction.tau = 5;
  m.retraction.activity = active;
  fem::PressureLoad push;
  push.surface = models::facets(m.mesh, [](const Vec3& X) { return X.z() > length - 1e-9; });
  push.directed = true, push.direction = -Vec3::UnitZ();
  push.pressure = [=](double t) { return 4e3 * active(t) * std::min(1.0, std::fmod(t, 40.0) / 5); };
  m.pressures = {push};
  auto o = models::real_time(2.4, 2e-4);
  o.labour_duration = 120;
  o.drag = 50 * 100;  // [1/s of labour]: about twice the axial frequency of the tube in pseudo-time
  solve::Explicit s(m, o);
  Course c;
  std::vector<double> rings = s.state().rest_length;
  for (int k = 1; k <= 24; ++k) {
    s.advance_to(5.0 * k);
    for (std::size_t i = 0; i < rings.size(); ++i) EXPECT_LE(s.state().rest_length[i], rings[i]);  // downwards only
    if (active(5.0 * k - 2.5) == 0) {
      EXPECT_EQ(s.state().rest_length, rings);  // nothing moves in a rest
    }
    rings = s.state().rest_length;
    c.rest_length.push_back(s.observe().rest_length_mean), c.height.push_back(height(m, s.state()) / length);
  }
  return c;
}

TEST(Retraction, RatchetHoldsWhatContractionsWon) {
  const auto coarse = contractions(24, 16), fine = contractions(36, 26);
  std::printf(
      "ratchet: rest length after three contractions %.4f %.4f %.4f, finer mesh %.4f %.4f %.4f; length in rest %.4f, "
      "finer %.4f\n",
      coarse.rest_length[7], coarse.rest_length[15], coarse.rest_length[23], fine.rest_length[7], fine.rest_length[15],
      fine.rest_length[23], coarse.height[23], fine.height[23]);
  EXPECT_LT(coarse.rest_length[7], 0.97);
  EXPECT_LT(coarse.rest_length[23], coarse.rest_length[15]);
  for (const std::size_t k : {3, 7, 11, 15, 19, 23}) {  // at the end of each contraction and of each rest
    EXPECT_NEAR(coarse.rest_length[k], fine.rest_length[k], 0.03 * fine.rest_length[k])
        << k;  // the rings belong to the wall
    EXPECT_NEAR(coarse.height[k], fine.height[k], 0.03 * fine.height[k]) << k;
  }
  // In a rest the load is gone: the wall has its rest length (the held end's hoop and the ring's hat functions: 4 %).
  EXPECT_NEAR(fine.height[23], fine.rest_length[23], 0.04);
}

/// Without load the rest length follows r' = -e0 r/tau; held at its length the muscle shortens to 1 - e0 and stops.
TEST(Retraction, ShortensUnloadedAndHoldsAtItsIsometricStrain) {
  for (const bool held : {false, true}) {
    auto m = tube(20, 12, fem::Retraction::Kind::ratchet);
    m.retraction.tau = 10, m.retraction.isometric_strain = 0.1;
    m.retraction.activity = [](double) { return 1.0; };
    if (held) models::block(m, fem::all, [](const Vec3& X) { return X.z() > length - 1e-9; });
    auto o = models::real_time(2, 2e-4);
    o.labour_duration = 50;
    o.drag = 50 * 100;
    solve::Explicit s(m, o);
    s.advance_to(50);
    const double expected = held ? 0.9 : std::exp(-0.1 * 50 / 10.0), r = s.observe().rest_length_mean;
    std::printf("muscle %s: rest length %.4f, expected %.4f\n", held ? "held" : "unloaded", r, expected);
    EXPECT_NEAR(r, expected, held ? 0.01 : 0.03);  // the fixed end's hoop resists; held: exp(-5) of the way is left
  }
}

TEST(Retraction, ImposedRestLengthIsTaken) {
  auto m = tube(20, 12, fem::Retraction::Kind::imposed);
  m.retraction.imposed = [](double t) { return 1 - 0.4 * std::min(1.0, t / 60); };
  auto o = models::real_time(2, 2e-4);
  o.labour_duration = 100;
  o.drag = 50 * 100;  // [1/s of labour]: about twice the axial frequency of the tube in pseudo-time
  solve::Explicit s(m, o);
  s.advance_to(100);
  std::printf("imposed rest length 0.6: length %.4f\n", height(m, s.state()) / length);
  EXPECT_NEAR(s.observe().rest_length_mean, 0.6, 1e-12);
  // Without load F = F_a is compatible but for the held end and for the thickness, which moves radii within the wall.
  EXPECT_NEAR(height(m, s.state()) / length, 0.6, 0.03);
}

}  // namespace
}  // namespace carus
