// SPDX-License-Identifier: Apache-2.0
// Closed surfaces: what is safe to repair is repaired and told, what is not is refused with count and place.
#include "carus/mesh/surface.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "carus/core/error.hpp"
#include "support/closed_shapes.hpp"

namespace carus::mesh {
namespace {

using test::box_surface;
using testing::HasSubstr;

const Vec3 low(0.01, 0.02, 0.03), high(0.05, 0.05, 0.05);
constexpr double box_volume = 0.04 * 0.03 * 0.02;

void refuses(Surface s, const char* why) {
  try {
    static_cast<void>(closed(std::move(s), "organ"));
    ADD_FAILURE() << why;
  } catch (const InputError& e) {
    EXPECT_THAT(e.what(), HasSubstr("organ: "));
    EXPECT_THAT(e.what(), HasSubstr(why));
  }
}

TEST(ClosedSurface, SoundOnesPassUntouched) {
  const auto s = box_surface(low, high);
  const auto c = closed(s, "box");
  EXPECT_TRUE(c.repairs.empty());
  EXPECT_EQ(c.surface.triangles.size(), s.triangles.size());
  EXPECT_NEAR(volume(c.surface), box_volume, 1e-15);
  EXPECT_NEAR(area(c.surface), 2 * (0.04 * 0.03 + 0.03 * 0.02 + 0.02 * 0.04), 1e-15);
}

TEST(ClosedSurface, WindingNumberTellsInsideFromOutside) {
  const auto s = test::sphere_surface({0, 0, 0}, 0.05, 2);
  EXPECT_NEAR(winding_number(s, {0.01, 0.02, -0.03}), 1, 1e-12);
  EXPECT_NEAR(winding_number(s, {0.06, 0, 0}), 0, 1e-12);
}

TEST(ClosedSurface, RepairsWhatIsSafeAndTells) {
  auto soup = box_surface(low, high);  // as STL has it: three nodes for each triangle
  Surface s;
  for (const auto& t : soup.triangles) {
    const auto n = std::int32_t(s.nodes.size());
    for (const auto i : t) s.nodes.push_back(soup.nodes[i]);
    s.triangles.push_back({n, n + 1, n + 2});
  }
  std::swap(s.triangles[3][0], s.triangles[3][1]);  // one turned
  s.triangles.push_back(s.triangles[5]);            // one twice
  s.triangles.push_back({0, 0, 1});                 // one of no area
  s.triangles.erase(s.triangles.begin() + 7);       // one missing
  for (auto& t : s.triangles) std::swap(t[0], t[1]);
  const auto c = closed(s, "box");
  EXPECT_NEAR(volume(c.surface), box_volume, 1e-15);
  EXPECT_EQ(c.surface.nodes.size(), 8u);
  EXPECT_EQ(c.surface.triangles.size(), 12u);
  const auto all = testing::PrintToString(c.repairs);
  for (const char* what : {"28 nodes at the place of another", "1 triangles with two corners", "1 repeated",
                           "turned to agree", "1 holes", "1 of 1 parts were inside out"})
    EXPECT_THAT(all, HasSubstr(what));
}

TEST(ClosedSurface, APartWithinAnotherIsItsCavity) {
  auto s = box_surface(low, high);
  const auto inner = box_surface({0.02, 0.03, 0.035}, {0.03, 0.04, 0.045}),
             beside = box_surface({0.1, 0, 0}, {0.11, 0.01, 0.01});
  for (const auto* more : {&inner, &beside}) {
    const auto n = std::int32_t(s.nodes.size());
    s.nodes.insert(s.nodes.end(), more->nodes.begin(), more->nodes.end());
    for (const auto& t : more->triangles) s.triangles.push_back({t[0] + n, t[1] + n, t[2] + n});
  }
  const auto c = closed(s, "boxes");
  EXPECT_NEAR(volume(c.surface), box_volume - 1e-6 + 1e-6, 1e-15);
  EXPECT_NEAR(winding_number(c.surface, {0.025, 0.035, 0.04}), 0, 1e-12);
  EXPECT_EQ(parts(c.surface).count, 3);
}

TEST(ClosedSurface, RefusesWhatIsNot) {
  auto s = box_surface(low, high);
  s.triangles.push_back({0, 3, 5});
  refuses(s, "edges have more than two triangles, the first at (");
  s = test::sphere_surface({0, 0, 0}, 0.05, 1);
  std::erase_if(s.triangles,
                [&](const Triangle& t) { return (s.nodes[t[0]] + s.nodes[t[1]] + s.nodes[t[2]]).z() > 0.06; });
  refuses(s, "is not closed");
  s = box_surface(low, high);
  s.nodes[3].x() = std::nan("");
  refuses(s, "node 3 is at no place");
  s = box_surface(low, high);
  s.triangles[4][1] = 99;
  refuses(s, "triangle 4 names node 99; there are 8");
  refuses({}, "no triangle");
  Surface strip;  // a Moebius strip of five quadrilaterals
  for (int i = 0; i < 5; ++i)
    for (const double side : {-1.0, 1.0}) {
      const double a = 2 * pi * i / 5;
      strip.nodes.push_back((1 + 0.3 * side * std::cos(a / 2)) * Vec3(std::cos(a), std::sin(a), 0) +
                            Vec3(0, 0, 0.3 * side * std::sin(a / 2)));
    }
  for (std::int32_t i = 0; i < 5; ++i) {
    const auto a = 2 * i, b = 2 * i + 1, c = i < 4 ? 2 * i + 2 : 1, d = i < 4 ? 2 * i + 3 : 0;
    strip.triangles.push_back({a, b, c});
    strip.triangles.push_back({b, d, c});
  }
  refuses(strip, "Moebius");
}

}  // namespace
}  // namespace carus::mesh
