// SPDX-License-Identifier: Apache-2.0
// What general models add to a solver: imposed motions, body forces, ties, reactions.
#include <gtest/gtest.h>

#include <cmath>

#include "carus/mesh/closest_point.hpp"
#include "support/models.hpp"

namespace carus {
namespace {

constexpr double shear = 20e3, side = 0.1;  // [Pa], [m]

bool on(double a, double b) { return std::abs(a - b) < 1e-9; }

Vec3 sum(const std::vector<Vec3>& f, const mesh::TetMesh& mesh, double z) {
  Vec3 total = Vec3::Zero();
  for (std::size_t i = 0; i < f.size(); ++i) {
    if (on(mesh.nodes[i].z(), z)) total += f[i];
  }
  return total;
}

std::vector<std::int32_t> nodes_at(const mesh::TetMesh& mesh, double z) {
  std::vector<std::int32_t> nodes;
  for (std::size_t i = 0; i < mesh.nodes.size(); ++i) {
    if (on(mesh.nodes[i].z(), z)) nodes.push_back(std::int32_t(i));
  }
  return nodes;
}

/// Nothing moves sideways: uniaxial strain, P = dW/dl of W = C10 (l^(-2/3) (l^2 + 2) - 3) + K/4 (l^2 - 1 - 2 ln l).
TEST(Motion, ReactionsOfImposedStretchAndItsWork) {
  const auto material = models::soft(material::Law::neo_hooke, shear, 0.4);
  auto m = models::of(shapes::box(Vec3::Zero(), Vec3::Constant(side), 4, 4, 4), {material});
  models::block(m, fem::x | fem::y, [](const Vec3&) { return true; });
  models::block(m, fem::z, [](const Vec3& X) { return on(X.z(), 0); });
  constexpr double stretch = 1.3, duration = 1;
  fem::Motion pull;
  pull.name = "pull", pull.nodes = nodes_at(m.mesh, side), pull.axes = fem::z;
  pull.displacement = [](double t) { return Vec3(0, 0, (stretch - 1) * side * std::min(1.0, t / 0.6)); };
  m.motions = {pull};
  solve::Explicit s(m, models::real_time(duration, 2e-4, 100));
  s.advance_to(duration);
  const double l = stretch, C10 = material.c10, K = material.bulk_modulus();
  const double P = C10 * (4.0 / 3 * (std::pow(l, 1.0 / 3) - std::pow(l, -5.0 / 3))) + 0.5 * K * (l - 1 / l);
  const double W = C10 * (std::pow(l, -2.0 / 3) * (l * l + 2) - 3) + 0.25 * K * (l * l - 1 - 2 * std::log(l));
  const auto o = s.observe();
  const double force = P * side * side;
  EXPECT_NEAR(sum(o.reaction, m.mesh, side).z(), force, 1e-3 * force);  // what is left of the relaxation
  EXPECT_NEAR(sum(o.reaction, m.mesh, 0).z(), -force, 1e-3 * force);
  EXPECT_NEAR(o.internal, W * side * side * side, 1e-3 * o.internal);
  EXPECT_NEAR(o.external_work - o.damping_work, o.internal + o.kinetic, 0.01 * o.internal);
}

/// A rigid block that turns about its axis carries a soft one round: positions are the rotation, stress is none in the
/// end.
TEST(Motion, RigidBodyTurns) {
  const auto material = models::soft(material::Law::neo_hooke, shear, 0.4);
  auto mesh = shapes::box(Vec3::Zero(), Vec3(side, side, 2 * side), 2, 2, 4);
  for (std::size_t e = 0; e < mesh.tets.size(); ++e) {
    double z = 0;
    for (const auto n : mesh.tets[e]) z += 0.25 * mesh.nodes[n].z();
    mesh.labels[e] = z > side ? 1 : 0;
  }
  auto m = models::of(mesh, {material, material});
  m.regions[1].rigid = true;
  fem::Motion turn;
  for (std::size_t i = 0; i < mesh.nodes.size(); ++i) {
    if (mesh.nodes[i].z() > side - 1e-9) turn.nodes.push_back(std::int32_t(i));
  }
  turn.point = Vec3(0.02, 0.03, 0), turn.axis = Vec3(1, 2, 2) / 3;
  turn.angle = [](double t) { return 1.2 * std::min(1.0, t / 1.0); };
  m.motions = {turn};
  solve::Explicit s(m, models::real_time(2, 2e-4, 40));
  s.advance_to(2);
  const Mat3 R = Eigen::AngleAxisd(1.2, turn.axis).toRotationMatrix();
  for (std::size_t i = 0; i < mesh.nodes.size(); ++i) {
    const Vec3 expected = turn.point + R * (mesh.nodes[i] - turn.point);
    EXPECT_LT((s.state().x[i] - expected).norm(), 1e-4 * side);
  }
}

/// A column under its own weight, held sideways: u = rho g/M (z^2/2 - H z) at small strain, M = K + 4/3 G; the bottom
/// carries the weight.
TEST(BodyForce, ColumnUnderItsWeight) {
  const auto material = models::soft(material::Law::hooke_corotated, shear, 0.3);
  auto m = models::of(shapes::box(Vec3::Zero(), Vec3(0.02, 0.02, side), 2, 2, 20), {material});
  models::block(m, fem::x | fem::y, [](const Vec3&) { return true; });
  models::block(m, fem::z, [](const Vec3& X) { return on(X.z(), 0); });
  constexpr double g = 1;
  m.body_forces = {{"gravity", {}, [](double) { return Vec3(0, 0, -g); }}};
  solve::Explicit s(m, models::real_time(3, 2e-4, 150));
  s.advance_to(3);
  const double M = material.bulk_modulus() + 4.0 / 3 * material.shear_modulus(), rho = material.density;
  for (std::size_t i = 0; i < m.mesh.nodes.size(); ++i) {
    const double z = m.mesh.nodes[i].z(), u = rho * g / M * (z * z / 2 - side * z);
    // Linear elements are exact at the nodes of such a column; large strain (0.2 %) and lumping in 3-D are not.
    EXPECT_NEAR(s.state().x[i].z() - z, u, 0.01 * rho * g / M * side * side / 2);
  }
  const double weight = rho * g * 0.02 * 0.02 * side;
  EXPECT_NEAR(sum(s.observe().reaction, m.mesh, 0).z(), weight, 1e-3 * weight);
}

/// Two blocks that do not match are glued and stretched: one force goes through both, and they do not part.
TEST(Tie, PassesTheForceOn) {
  const auto material = models::soft(material::Law::neo_hooke, shear, 0.3);
  const auto lower = shapes::box(Vec3::Zero(), Vec3::Constant(side), 3, 3, 3, 0);
  auto m = models::of(shapes::join(lower, shapes::box({0, 0, side}, Vec3::Constant(side), 4, 4, 4, 1)),
                      {material, material});
  models::block(m, fem::x, [](const Vec3& X) { return on(X.x(), 0); });
  models::block(m, fem::y, [](const Vec3& X) { return on(X.y(), 0); });
  models::block(m, fem::z, [](const Vec3& X) { return on(X.z(), 0); });
  mesh::Triangles top;
  for (const auto& t : models::facets(m.mesh, [](const Vec3& X) { return on(X.z(), side); })) {
    if (t[0] < std::int32_t(lower.nodes.size())) top.push_back(t);
  }
  for (std::size_t i = lower.nodes.size(); i < m.mesh.nodes.size(); ++i) {
    const Vec3& X = m.mesh.nodes[i];
    if (!on(X.z(), side)) continue;
    double least = 1e-9;
    fem::Tie tie{-1, {}, {}};
    for (const auto& t : top) {
      const auto& n = m.mesh.nodes;
      const Vec3 w = mesh::closest_point_weights(X, n[t[0]], n[t[1]], n[t[2]]);
      const double d = (w[0] * n[t[0]] + w[1] * n[t[1]] + w[2] * n[t[2]] - X).norm();
      if (d < least) least = d, tie = {std::int32_t(i), t, w};
    }
    ASSERT_GE(tie.node, 0);
    m.blocked[i] = fem::none;  // the facet's corners are held where it is
    m.ties.push_back(tie);
  }
  fem::Motion pull;
  pull.nodes = nodes_at(m.mesh, 2 * side), pull.axes = fem::z;
  pull.displacement = [](double t) { return Vec3(0, 0, 0.2 * side * std::min(1.0, t)); };
  m.motions = {pull};
  solve::Explicit s(m, models::real_time(2.5, 2e-4, 40));
  s.advance_to(2.5);
  double mean[2] = {0, 0}, volume[2] = {0, 0}, least = 1e9, most = 0;
  for (std::size_t e = 0; e < m.mesh.tets.size(); ++e) {
    const double stress = models::neo_hooke_stress(m, e, s.state().x)(2, 2), v = mesh::volume(m.mesh, e);
    least = std::min(least, stress), most = std::max(most, stress);
    mean[m.mesh.labels[e]] += stress * v, volume[m.mesh.labels[e]] += v;
  }
  const double lower_mean = mean[0] / volume[0], upper_mean = mean[1] / volume[1];
  EXPECT_NEAR(lower_mean, upper_mean, 0.02 * upper_mean);  // one force through sections alike
  // Gluing node by node shares a node's force among the facet's corners, not as a constant traction would be shared:
  // the layers beside the tie vary by 16 %.
  EXPECT_GT(least, 0.8 * upper_mean);
  EXPECT_LT(most, 1.2 * upper_mean);
  const auto reaction = s.observe().reaction;
  const double up = sum(reaction, m.mesh, 2 * side).z(), down = sum(reaction, m.mesh, 0).z();
  EXPECT_NEAR(up, -down, 2e-3 * up);
  EXPECT_GT(up, 0);
  for (const auto& tie : m.ties) {
    Vec3 x = Vec3::Zero();
    for (int k = 0; k < 3; ++k) x += tie.weights[k] * s.state().x[tie.facet[k]];
    EXPECT_LT((x - s.state().x[tie.node]).norm(), 1e-9);
  }
}

}  // namespace
}  // namespace carus
