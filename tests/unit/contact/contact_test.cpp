// SPDX-License-Identifier: Apache-2.0
#include "carus/contact/contact.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "carus/observe/penetration.hpp"
#include "support/models.hpp"

namespace carus::contact {
namespace {

struct Bodies {
  mesh::TetMesh mesh;
  std::vector<Surface> surfaces;
};

Bodies two(const mesh::TetMesh& a, const mesh::TetMesh& b) {
  Bodies out;
  out.mesh = shapes::join(a, b);
  out.surfaces.emplace_back("a", mesh::boundary(out.mesh, [](int l) { return l == 0; }), out.mesh.nodes);
  out.surfaces.emplace_back("b", mesh::boundary(out.mesh, [](int l) { return l == 1; }), out.mesh.nodes);
  return out;
}

Contact make(const Bodies& b, double mass, double friction = 0, Options options = {}) {
  const std::vector<Vec3> inverse(b.mesh.nodes.size(), Vec3::Constant(1 / mass));
  return {b.surfaces,
          {{0, 1, friction}},
          b.mesh.nodes,
          inverse,
          std::vector<Vec3>(inverse.size(), Vec3::Zero()),
          std::vector<std::int16_t>(inverse.size(), -1),
          {},
          options};
}

/// The flat faces that meet, alone: whole boxes have edges, which the smooth gap takes for curvature.
Bodies faces(const mesh::TetMesh& lower, const mesh::TetMesh& upper, double z_lower, double z_upper) {
  Bodies b = two(lower, upper);
  for (int label = 0; label < 2; ++label) {
    mesh::Triangles flat;
    for (const auto& t : b.surfaces[std::size_t(label)].triangles) {
      const double z = label == 0 ? z_lower : z_upper;
      if (std::all_of(t.begin(), t.end(), [&](auto n) { return std::abs(b.mesh.nodes[n].z() - z) < 1e-9; }))
        flat.push_back(t);
    }
    b.surfaces[std::size_t(label)] = Surface(label ? "b" : "a", flat, b.mesh.nodes);
  }
  return b;
}

/// Flat faces have no sagitta: the gap is the distance, whether open or penetrated.
TEST(Contact, GapOfFlatFacesIsTheDistance) {
  for (const double distance : {5e-5, 1e-6, -3e-5, -5e-4}) {
    const auto b = faces(shapes::box({-0.05, -0.05, -0.05}, {0.1, 0.1, 0.05}, 5, 5, 3, 0),
                         shapes::box({-0.027, -0.031, distance}, {0.05, 0.06, 0.04}, 4, 4, 4, 1), 0, distance);
    auto contact = make(b, 1e-3);
    contact.detect(b.mesh.nodes, 1e-5, 0);
    EXPECT_NEAR(contact.least_gap(), distance, 1e-12);
    EXPECT_GE(contact.constraints().size(), 25u);  // every node of the smaller face, and those below it
    for (const auto& c : contact.constraints()) {
      EXPECT_NEAR(c.w[0] + c.w[1] + c.w[2], 1, 1e-12);
      EXPECT_NEAR((c.n.cwiseAbs() - Vec3::UnitZ()).norm(), 0, 1e-12);
    }
  }
}

/// Two bodies that travel together, far, are the same to each other: partners are looked for anew only by age.
TEST(Contact, WhatMovesAsOneStaysNear) {
  const auto b = faces(shapes::box({-0.05, -0.05, -0.05}, {0.1, 0.1, 0.05}, 5, 5, 3, 0),
                       shapes::box({-0.027, -0.031, 5e-5}, {0.05, 0.06, 0.04}, 4, 4, 4, 1), 0, 5e-5);
  auto contact = make(b, 1e-3);
  auto x = b.mesh.nodes;
  contact.detect(x, 1e-5, 100);
  const auto at_first = contact.renewals();
  const auto constraints = contact.constraints().size();
  for (int step = 0; step < 100; ++step) {
    for (Vec3& p : x) p += Vec3(1e-3, 0, 0);
    contact.moved(1e-3);
    contact.detect(x, 1e-5, 100);
    EXPECT_NEAR(contact.least_gap(), 5e-5, 1e-12);
  }
  EXPECT_EQ(contact.renewals(), at_first);
  EXPECT_EQ(contact.constraints().size(), constraints);
}

/// Nodes near a faceted ball against the sphere itself. The chords cut it by up to 0.3 mm here; the smooth gap removes
/// four fifths of that at least (vertex normals of a blown-up cube lean by a few degrees, which is what is left).
TEST(Contact, SmoothGapSeesTheSphereNotTheFacets) {
  constexpr double r = 0.03;
  const Vec3 offset = 2 * (r + 2.5e-5) * Vec3(0.31, 0.22, 0.93).normalized();
  const auto b = two(shapes::ball(Vec3::Zero(), r, 12, 0), shapes::ball(offset, r, 10, 1));
  Options options;
  options.activation = 3e-3;
  auto contact = make(b, 1e-3, 0, options);
  contact.detect(b.mesh.nodes, 1e-5, 0);
  ASSERT_GE(contact.constraints().size(), 8u);
  double off_facets = 0, off_smooth = 0;
  for (const auto& c : contact.constraints()) {
    const Vec3& p = b.mesh.nodes[c.node];
    const bool of_first = p.norm() < r * (1 + 1e-6);
    const double exact = (p - (of_first ? offset : Vec3::Zero())).norm() - r;
    Vec3 foot = Vec3::Zero();
    for (int k = 0; k < 3; ++k) foot += c.w[k] * b.mesh.nodes[c.facet[k]];
    off_facets = std::max(off_facets, std::abs((p - foot).norm() - exact));
    off_smooth = std::max(off_smooth, std::abs(c.gap - exact));
  }
  std::printf("gap to the sphere: facets are off by %.4f mm, the smooth gap by %.4f mm\n", off_facets * 1e3,
              off_smooth * 1e3);
  EXPECT_GT(off_facets, 1e-4);
  EXPECT_LT(off_smooth, 0.2 * off_facets);
}

/// Between looks a constraint keeps its foot and its gap changes along its normal: what that leaves out is small
/// against the way gone.
TEST(Contact, GapBetweenLooksIsThatOfANewSearch) {
  constexpr double r = 0.03, step = 2e-5;
  const auto b = two(shapes::ball(Vec3::Zero(), r, 12, 0), shapes::ball({0, 0, 2 * r + 5e-5}, r, 10, 1));
  Options options;
  options.activation = 3e-3;
  auto held = make(b, 1e-3, 0, options);
  ASSERT_TRUE(held.detect(b.mesh.nodes, step, 1));
  const auto before = held.constraints();
  auto x = b.mesh.nodes;
  const Vec3 slide(step, 0, -0.5 * step);
  for (std::size_t i = 0; i < x.size(); ++i)
    if (x[i].z() > r + 1e-6) x[i] += slide;
  held.moved(slide.norm());
  ASSERT_FALSE(held.detect(x, step, 1));
  auto anew = make(b, 1e-3, 0, options);
  ASSERT_TRUE(anew.detect(x, step, 1));
  int same = 0;
  double change = 0;
  for (std::size_t i = 0; i < before.size(); ++i) {
    const Constraint& c = held.constraints()[i];
    for (const Constraint& d : anew.constraints()) {
      if (c.node != d.node || c.facet != d.facet) continue;
      EXPECT_NEAR(c.gap, d.gap, 0.03 * slide.norm());  // a corner normal leans by some degrees against the next
      change = std::max(change, std::abs(c.gap - before[i].gap)), ++same;
    }
  }
  EXPECT_GE(same, 8);
  EXPECT_GT(change, 5e-6);  // the gaps did move
}

/// Against an exact search that shares nothing with the contact: after a press both see the same depth within the
/// sagitta.
TEST(Contact, LeastGapAgreesWithBruteForce) {
  const auto b = two(shapes::box({-0.05, -0.05, -0.05}, {0.1, 0.1, 0.05}, 7, 6, 3, 0),
                     shapes::ball({0.002, 0.001, 0.0297}, 0.03, 10, 1));
  fem::Model model = models::of(
      b.mesh, {models::soft(material::Law::neo_hooke, 1e4, 0.4), models::soft(material::Law::neo_hooke, 1e4, 0.4)});
  model.contact_surfaces = {{"a", b.surfaces[0].triangles}, {"b", b.surfaces[1].triangles}};
  model.contact_pairs = {{0, 1, 0}};
  auto contact = make(b, 1e-3);
  contact.detect(b.mesh.nodes, 1e-5, 0);
  const auto exact = observe::PenetrationCheck(model, 1e-3).check(b.mesh.nodes)[0];
  ASSERT_LT(exact.least_gap, -1e-4);
  EXPECT_GT(exact.penetrated, 0);
  // The ball's sagging facets: h^2/(8 r) = 0.15 mm at h = 6 mm.
  EXPECT_NEAR(contact.least_gap(), exact.least_gap, 1.5e-4);
}

/// Impulses conserve momentum, never pull, and leave every pair at its target.
TEST(Contact, ImpulsesConserveMomentumAndSeparate) {
  const auto b = faces(shapes::box({-0.05, -0.05, -0.05}, {0.1, 0.1, 0.05}, 5, 5, 3, 0),
                       shapes::box({-0.027, -0.031, 1e-6}, {0.05, 0.06, 0.04}, 4, 4, 4, 1), 0, 1e-6);
  Options options;
  options.sweeps = 200;  // converged: the sweep count is the solver's choice of accuracy, not this test's subject
  auto contact = make(b, 1e-3, 0, options);
  constexpr double dt = 1e-5;
  contact.detect(b.mesh.nodes, dt, 1);
  std::vector<Vec3> v(b.mesh.nodes.size(), Vec3::Zero());
  for (std::size_t i = 0; i < v.size(); ++i) v[i] = b.mesh.nodes[i].z() > 5e-7 ? Vec3(0.3, 0, -1) : Vec3::Zero();
  Vec3 before = Vec3::Zero(), after = Vec3::Zero();
  double energy_before = 0, energy_after = 0;
  for (const Vec3& u : v) before += u, energy_before += u.squaredNorm();
  std::vector<double> no_hinges;
  contact.solve(v, no_hinges);
  for (const Vec3& u : v) after += u, energy_after += u.squaredNorm();
  EXPECT_LT((after - before).norm(), 1e-12 * before.norm());
  EXPECT_LT(energy_after, energy_before);
  ASSERT_FALSE(contact.constraints().empty());
  for (const auto& c : contact.constraints()) {
    EXPECT_GE(c.impulse, 0);
    const Vec3 u = v[c.node] - (c.w[0] * v[c.facet[0]] + c.w[1] * v[c.facet[1]] + c.w[2] * v[c.facet[2]]);
    EXPECT_GE(u.dot(c.n), c.target - 1e-3);  // Gauss-Seidel at 200 sweeps
  }
}

/// And take no momentum with them: the velocities know nothing of it.
TEST(Contact, PenetratedPairsLeaveAtTheCorrectionSpeed) {
  const auto b = faces(shapes::box({-0.05, -0.05, -0.05}, {0.1, 0.1, 0.05}, 4, 4, 3, 0),
                       shapes::box({-0.027, -0.031, -4e-4}, {0.05, 0.06, 0.04}, 3, 3, 3, 1), 0, -4e-4);
  Options options;
  options.sweeps = 300, options.correction_speed = 0.25;
  auto contact = make(b, 1e-3, 0, options);
  contact.detect(b.mesh.nodes, 1e-5, 0);
  std::vector<Vec3> v(b.mesh.nodes.size(), Vec3::Zero());
  std::vector<double> no_hinges;
  auto lift = v;
  Vec3 sum = Vec3::Zero();
  contact.solve(v, no_hinges);
  for (const Vec3& u : v) EXPECT_EQ(u, Vec3::Zero());
  contact.part_penetrated(v, lift);
  double slowest = 1e30, fastest = 0;
  for (const auto& c : contact.constraints()) {
    if (c.lift <= 0) continue;
    const double u =
        c.n.dot(lift[c.node] - (c.w[0] * lift[c.facet[0]] + c.w[1] * lift[c.facet[1]] + c.w[2] * lift[c.facet[2]]));
    slowest = std::min(slowest, u), fastest = std::max(fastest, u);
  }
  EXPECT_NEAR(slowest, 0.25, 1e-3);
  EXPECT_NEAR(fastest, 0.25, 1e-3);
  for (const Vec3& u : lift) sum += u;
  EXPECT_LT(sum.norm(), 1e-12);
}

/// What slides over an edge that is not sharp meets one normal on both its facets, also where a sharp edge ends nearby.
TEST(Contact, NormalsAreTheSameOnBothSidesOfAnEdgeThatIsNotSharp) {
  // A roof with a ridge of 80 degrees at one end that has flattened out at the other, in six slanted strips.
  std::vector<Vec3> x;
  mesh::Triangles roof;
  constexpr int rows = 7, columns = 5;
  for (int i = 0; i < rows; ++i) {
    for (int j = 0; j < columns; ++j) {
      const double y = 0.01 * i, steep = 0.84 * (1 - double(i) / (rows - 1)), side = 0.01 * (j - 2);
      x.emplace_back(side, y + 0.3 * side, -steep * std::abs(side));
    }
  }
  for (int i = 0; i + 1 < rows; ++i) {
    for (int j = 0; j + 1 < columns; ++j) {
      const int a = columns * i + j;
      roof.push_back({a, a + 1, a + columns}), roof.push_back({a + 1, a + columns + 1, a + columns});
    }
  }
  const Surface s("roof", roof, x);
  EXPECT_GT(s.normal.size(), x.size());  // there are sides
  for (std::size_t f = 0; f < roof.size(); ++f) {
    for (std::size_t g = 0; g < f; ++g) {
      int shared = 0;
      for (const auto n : roof[f]) shared += std::count(roof[g].begin(), roof[g].end(), n) > 0;
      if (shared < 2 || s.facet_normal[f].normalized().dot(s.facet_normal[g].normalized()) < 0.65) continue;
      for (std::size_t k = 0; k < 3; ++k) {
        for (std::size_t l = 0; l < 3; ++l) {
          if (roof[f][k] != roof[g][l]) continue;
          EXPECT_EQ(s.normal[std::size_t(s.shade[f][k])], s.normal[std::size_t(s.shade[g][l])]) << f << " and " << g;
        }
      }
    }
  }
}

/// Strips down both sides of an edge along y: nodes 3 i + {0: the edge, 1: left, 2: right}.
mesh::Triangles two_flanks() {
  mesh::Triangles t;
  for (int i = 0; i < 9; i += 3) {
    t.push_back({i, i + 3, i + 1}), t.push_back({i + 1, i + 3, i + 4});
    t.push_back({i, i + 2, i + 3}), t.push_back({i + 2, i + 5, i + 3});
  }
  return t;
}
std::vector<Vec3> flanks(const Vec3& left, const Vec3& right) {
  std::vector<Vec3> x;
  for (const double y : {0.0, 0.01, 0.02, 0.03}) {
    const Vec3 edge(0, y, 0);
    x.push_back(edge), x.push_back(edge + left), x.push_back(edge + right);
  }
  return x;
}

/// What node 12, the tip of a plate through the last three, finds at the flanks.
Constraint tip_at_flanks(const std::vector<Vec3>& rest, const std::vector<Vec3>& x, const mesh::Triangle& plate) {
  const std::vector<Vec3> inverse(x.size(), Vec3::Constant(1e3));
  Contact contact({Surface("flanks", two_flanks(), rest), Surface("plate", {plate}, rest)}, {{0, 1, 0}}, rest, inverse,
                  std::vector<Vec3>(x.size(), Vec3::Zero()), std::vector<std::int16_t>(x.size(), -1), {}, {});
  contact.detect(x, 1e-3, 0.5);
  for (const auto& c : contact.constraints())
    if (c.node == 12) return c;
  ADD_FAILURE() << "the tip is in no constraint";
  return {};
}

/// A rim squeezed to a blade: its two sides face away from each other, and what lies before one lies deep behind the
/// other. It has gone through neither. The right side is the larger, so that the edge's mean normal leans to it.
TEST(Contact, BeforeOneSideOfABladeIsNotBehindTheOther) {
  auto rest = flanks({-0.005, 0, -0.005}, {0.03, 0, -0.03}), x = flanks({-1e-4, 0, -0.005}, {6e-4, 0, -0.03});
  for (auto* nodes : {&rest, &x})
    for (const auto& [y, z] : {std::pair(0.015, 1e-4), std::pair(0.012, 0.02), std::pair(0.018, 0.02)})
      nodes->emplace_back(-2e-4, y, z);
  for (const mesh::Triangle& plate : {mesh::Triangle{12, 13, 14}, mesh::Triangle{12, 14, 13}})  // faces left, or right
    EXPECT_NEAR(tip_at_flanks(rest, x, plate).gap, std::hypot(2e-4, 1e-4), 1e-9);
}

/// Behind both flanks of a crease the nearest of the surface is its edge, whether it was sharp at rest or has folded
/// since; each flank alone would let the node into the other.
TEST(Contact, BehindACreaseTheEdgeIsNearest) {
  const Vec3 off(1e-4, 0, -3e-4);
  for (const double rise_at_rest : {0.015, 1e-4}) {
    auto rest = flanks({-0.01, 0, rise_at_rest}, {0.01, 0, rise_at_rest}),
         x = flanks({-0.01, 0, 0.015}, {0.01, 0, 0.015});
    for (auto* nodes : {&rest, &x})
      for (const Vec3& p : {Vec3(0, 0.015, 0), Vec3(0.003, 0.012, 0), Vec3(0.003, 0.018, 0)}) nodes->push_back(p + off);
    const Constraint c = tip_at_flanks(rest, x, {12, 14, 13});  // faces down
    EXPECT_NEAR(c.gap, -off.norm(), 1e-9) << rise_at_rest;
    EXPECT_LT((c.n + off.normalized()).norm(), 1e-6) << rise_at_rest;
  }
}

TEST(Contact, OpenEdgeEndsTheSurface) {
  // A single plate, open at its border; a node beside it is not held by its plane continued.
  auto mesh = shapes::join(shapes::box({0, 0, -0.01}, {0.04, 0.04, 0.01}, 4, 4, 1, 0),
                           shapes::box({0.05, 0.01, -5e-5}, {0.02, 0.02, 0.02}, 2, 2, 2, 1));
  std::vector<Surface> surfaces;
  mesh::Triangles top;
  for (const auto& t : mesh::boundary(mesh, [](int l) { return l == 0; })) {
    if (std::all_of(t.begin(), t.end(), [&](auto n) { return mesh.nodes[n].z() > -1e-9; })) top.push_back(t);
  }
  surfaces.emplace_back("plate", top, mesh.nodes);
  surfaces.emplace_back("box", mesh::boundary(mesh, [](int l) { return l == 1; }), mesh.nodes);
  Bodies b{mesh, surfaces};
  Options options;
  options.reach = 0.02;
  auto contact = make(b, 1e-3, 0, options);
  contact.detect(mesh.nodes, 1e-5, 0);
  EXPECT_TRUE(contact.constraints().empty());
}

/// A plate beside a ball, turned away from the side of the ball that is next to it: what faces it is the top, whose
/// planes it lies 3 mm below, yet 11 mm from them.
TEST(Contact, WhatLiesFarBesideAFacetHasNotGoneThroughIt) {
  constexpr double r = 0.005;
  auto mesh = shapes::ball(Vec3::Zero(), r, 10, 0);
  const auto ball = mesh::boundary(mesh);
  const Vec3 normal = Vec3(1, 0, -0.2).normalized(), up = Vec3(0.2, 0, 1).normalized(), centre(2.2 * r, 0, 0);
  const auto first = std::int32_t(mesh.nodes.size());
  for (const Vec3& offset : {Vec3(-Vec3::UnitY()), Vec3(Vec3::UnitY()), up})
    mesh.nodes.push_back(centre + 1e-3 * offset);
  mesh::Triangle plate{first, first + 1, first + 2};
  if ((2e-3 * Vec3::UnitY()).cross(1e-3 * (up + Vec3::UnitY())).dot(normal) < 0) std::swap(plate[0], plate[1]);
  Options options;
  options.reach = 0.02;
  auto contact = make({mesh, {{"ball", ball, mesh.nodes}, {"plate", {plate}, mesh.nodes}}}, 1e-3, 0, options);
  contact.detect(mesh.nodes, 1e-5, 0);
  EXPECT_TRUE(contact.constraints().empty());
}

/// The edges of whole boxes are no curvature: their faces are flat up to the rim.
TEST(Contact, SharpEdgesKeepTheirSides) {
  for (const double distance : {5e-5, -3e-5}) {
    const auto b = two(shapes::box({-0.05, -0.05, -0.05}, {0.1, 0.1, 0.05}, 5, 5, 3, 0),
                       shapes::box({-0.027, -0.031, distance}, {0.05, 0.06, 0.04}, 4, 4, 4, 1));
    auto contact = make(b, 1e-3);
    contact.detect(b.mesh.nodes, 1e-5, 0);
    EXPECT_GE(contact.constraints().size(), 25u);
    EXPECT_NEAR(contact.least_gap(), distance, 1e-12);
  }
}

/// A wedge's edge, where two sides meet, beside a plate that one of the sides faces: the mean of the sides does not.
TEST(Contact, RimTouchesWhatOneOfItsSidesFaces) {
  std::vector<Vec3> x;
  for (const double y : {0.0, 0.01, 0.02}) {
    x.emplace_back(0, y, 0);                                          // the edge
    x.emplace_back(-0.002, y, 0.02), x.emplace_back(0.002, y, 0.02);  // left and right above it
  }
  mesh::Triangles wedge, plate;
  for (int i = 0; i < 6; i += 3) {
    wedge.push_back({i, i + 1, i + 3}), wedge.push_back({i + 1, i + 4, i + 3});  // towards -x
    wedge.push_back({i, i + 3, i + 2}), wedge.push_back({i + 2, i + 3, i + 5});  // towards +x
  }
  const Vec3 normal = Vec3(-1, 0, -0.15).normalized(), up(0.15, 0, -1), foot = -5e-5 * normal + Vec3(0, 0.01, 0);
  const auto first = std::int32_t(x.size());
  x.push_back(foot - 0.03 * Vec3::UnitY() - 0.03 * up), x.push_back(foot + 0.03 * Vec3::UnitY() - 0.03 * up);
  x.push_back(foot + 0.05 * up);
  plate.push_back({first, first + 1, first + 2});
  if ((x[first + 1] - x[first]).cross(x[first + 2] - x[first]).dot(normal) < 0) std::swap(plate[0][1], plate[0][2]);
  const std::vector<Vec3> inverse(x.size(), Vec3::Constant(1e3));
  Contact contact({Surface("wedge", wedge, x), Surface("plate", plate, x)}, {{0, 1, 0}}, x, inverse,
                  std::vector<Vec3>(x.size(), Vec3::Zero()), std::vector<std::int16_t>(x.size(), -1), {}, {});
  contact.detect(x, 1e-5, 0);
  const auto& found = contact.constraints();
  ASSERT_TRUE(std::any_of(found.begin(), found.end(), [](const Constraint& c) { return c.node == 3; }));
  EXPECT_NEAR(contact.least_gap(), 5e-5, 1e-9);
}

/// A node that cannot move along t takes the impulse's part across t alone, and the effective mass knows it.
TEST(Contact, BlockedDirectionTakesNoSpeed) {
  const auto b = faces(shapes::box({-0.05, -0.05, -0.05}, {0.1, 0.1, 0.05}, 5, 5, 3, 0),
                       shapes::box({-0.027, -0.031, 1e-6}, {0.05, 0.06, 0.04}, 4, 4, 4, 1), 0, 1e-6);
  const double mass = 1e-3;
  const Vec3 t = Vec3(0, 0.6, 0.8);
  const std::vector<Vec3> inverse(b.mesh.nodes.size(), Vec3::Constant(1 / mass));
  Contact contact(b.surfaces, {{0, 1, 0}}, b.mesh.nodes, inverse,
                  std::vector<Vec3>(inverse.size(), t / std::sqrt(mass)), std::vector<std::int16_t>(inverse.size(), -1),
                  {}, {.sweeps = 400});
  contact.detect(b.mesh.nodes, 1e-5, 1);
  // The upper body falls, slid along its free plane so that it obeys its own block.
  std::vector<Vec3> v(inverse.size(), Vec3::Zero());
  for (std::size_t i = 0; i < v.size(); ++i)
    if (b.mesh.nodes[i].z() > 5e-7) v[i] = -(Vec3::UnitZ() - t.z() * t);
  std::vector<double> rate;
  contact.solve(v, rate);
  ASSERT_FALSE(contact.constraints().empty());
  double impulses = 0;
  for (const auto& c : contact.constraints()) impulses += c.impulse;
  EXPECT_GT(impulses, 0);
  for (const auto& u : v) EXPECT_NEAR(u.dot(t), 0, 1e-12);
  for (const auto& c : contact.constraints()) {
    const Vec3 u = v[c.node] - (c.w[0] * v[c.facet[0]] + c.w[1] * v[c.facet[1]] + c.w[2] * v[c.facet[2]]);
    EXPECT_GE(c.n.dot(u), c.target - 1e-3);
  }
}

/// A sheet of facets of 2 mm, plane at rest with its face up, its middle line along y; `x` places (s, y).
template <class Place>
std::pair<Contact, std::vector<Vec3>> sheet(int half, double h, Place place, Options options = {}) {
  std::vector<Vec3> rest, x;
  for (int i = -half; i <= half; ++i) {
    for (int j = 0; j < 3; ++j) rest.emplace_back(i * h, j * h, 0), x.push_back(place(i * h, j * h));
  }
  mesh::Triangles facets;
  for (int i = 0; i < 2 * half; ++i) {
    for (int j = 0; j < 2; ++j) {
      const int a = 3 * i + j;
      facets.push_back({a, a + 3, a + 1}), facets.push_back({a + 3, a + 4, a + 1});
    }
  }
  return {Contact({Surface("sheet", facets, rest)}, {{0, 0, 0}}, rest, std::vector<Vec3>(x.size(), Vec3::Constant(1e3)),
                  std::vector<Vec3>(x.size(), Vec3::Zero()), std::vector<std::int16_t>(x.size(), -1), {}, options),
          x};
}

/// A sheet folded flat on itself touches itself right up to the fold, far inside the rest distance that keeps the two
/// sides of a wall apart.
TEST(Contact, TightFoldTouchesItself) {
  constexpr double h = 0.002, gap = 5e-5;
  auto [contact, x] = sheet(20, h, [](double s, double y) {
    return Vec3(-std::abs(s), y, s > h / 2 ? gap : 0.0);  // upper half turned over: faces down
  });
  contact.detect(x, 1e-5, 0);
  int close = 0;  // between 4 and 10 mm from the fold: less than 20 mm apart at rest
  for (const Constraint& c : contact.constraints()) {
    const double s = std::abs(c.node / 3 - 20) * h;
    if (s < 0.0039 || s > 0.0099) continue;
    ++close;
    EXPECT_NEAR(c.gap, gap, 1e-9);
  }
  EXPECT_GE(close, 2 * 3 * 3);
}

/// Bent the other way, to a ridge sharper than a right angle, its flanks face away from each other and lie behind each
/// other: nothing has gone through anything, and nothing may push.
TEST(Contact, SharpRidgeDoesNotTouchItself) {
  const auto ridge = [](double s, double y) { return Vec3(0.5 * s, y, -0.866 * std::abs(s)); };  // 60 degrees
  auto [contact, x] = sheet(20, 0.002, ridge);
  contact.detect(x, 1e-5, 0);
  EXPECT_TRUE(contact.constraints().empty());
  // What it is about: by depth alone the flanks would be pushed through each other.
  Options by_depth;
  by_depth.fold_depth = by_depth.max_depth;
  auto [naive, same] = sheet(20, 0.002, ridge, by_depth);
  naive.detect(same, 1e-5, 0);
  EXPECT_FALSE(naive.constraints().empty());
}

}  // namespace
}  // namespace carus::contact
