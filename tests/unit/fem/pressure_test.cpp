// SPDX-License-Identifier: Apache-2.0
#include "carus/fem/pressure.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "support/models.hpp"

namespace carus::fem {
namespace {

PressureLoad on(const mesh::TetMesh& mesh) {
  PressureLoad load;
  load.surface = mesh::boundary(mesh);
  return load;
}

Vec3 total(const std::vector<Vec3>& f) {
  Vec3 sum = Vec3::Zero();
  for (const Vec3& v : f) sum += v;
  return sum;
}

TEST(Pressure, FollowerOnAClosedSurfaceHasNoResultantAndNoMoment) {
  const auto mesh = shapes::ball({0.1, 0.2, 0.3}, 0.05, 6);
  auto x = mesh.nodes;
  for (Vec3& p : x) p = models::skew_rotation(1) * Vec3(1.3 * p.x(), p.y() + 2 * p.x() * p.x(), 0.8 * p.z());
  std::vector<Vec3> f(x.size(), Vec3::Zero());
  add_pressure_forces(on(mesh), 1e4, x, f);
  Vec3 moment = Vec3::Zero();
  double size = 0;
  for (std::size_t i = 0; i < x.size(); ++i) moment += x[i].cross(f[i]), size += f[i].norm();
  // Double precision; the sum over facets of their areas closes exactly, the moment too because thirds are exact for a
  // plane facet.
  EXPECT_LT(total(f).norm(), 1e-13 * size);
  EXPECT_LT(moment.norm(), 1e-13 * size);
}

TEST(Pressure, PushesInwards) {
  const auto mesh = shapes::box({0, 0, 0}, {1, 2, 3}, 2, 2, 2);
  PressureLoad load;
  load.surface = models::facets(mesh, [](const Vec3& X) { return X.z() > 3 - 1e-9; });
  std::vector<Vec3> f(mesh.nodes.size(), Vec3::Zero());
  add_pressure_forces(load, 5, mesh.nodes, f);
  EXPECT_LT((total(f) - Vec3(0, 0, -5 * 1 * 2)).norm(), 1e-12);
}

TEST(Pressure, DirectedKeepsItsAxisOnly) {
  // Half of a ball: the directed part is -p times the projected area, along the direction, whatever the surface's
  // shape.
  const auto mesh = shapes::ball(Vec3::Zero(), 1, 8);
  PressureLoad load;
  load.directed = true, load.direction = Vec3(0, 0, -1);
  load.surface = models::facets(mesh, [](const Vec3& X) { return X.z() > -1e-9; });
  std::vector<Vec3> f(mesh.nodes.size(), Vec3::Zero());
  add_pressure_forces(load, 100, mesh.nodes, f);
  double projected = 0;  // of the polygon in the plane z = 0, from the facets themselves
  for (const auto& t : load.surface) {
    projected += 0.5 * (mesh.nodes[t[1]] - mesh.nodes[t[0]]).cross(mesh.nodes[t[2]] - mesh.nodes[t[0]]).z();
  }
  EXPECT_LT((total(f) - Vec3(0, 0, -100 * projected)).norm(), 1e-10);
  EXPECT_NEAR(projected, pi, 0.06 * pi);  // a polygon of 32 sides with sagging facets inside the circle
  for (const Vec3& v : f) EXPECT_EQ(v.head<2>().norm(), 0);
}

TEST(Pressure, WorksByTheVolume) {
  // Power of a follower pressure = -p dV/dt, by central differences on a linear motion: cubic in h, so exact to h^2.
  const auto mesh = shapes::ball(Vec3::Zero(), 0.1, 5);
  const auto surface = mesh::boundary(mesh);
  const auto enclosed = [&](const std::vector<Vec3>& x) {
    double v = 0;
    for (const auto& t : surface) v += x[t[0]].dot(x[t[1]].cross(x[t[2]])) / 6;
    return v;
  };
  std::vector<Vec3> f(mesh.nodes.size(), Vec3::Zero()), up = mesh.nodes, down = mesh.nodes;
  add_pressure_forces(on(mesh), 1e4, mesh.nodes, f);
  constexpr double h = 1e-5;
  double power = 0;
  for (std::size_t i = 0; i < f.size(); ++i) {
    const Vec3 v(mesh.nodes[i].x() + 0.02, 3 * mesh.nodes[i].y() * mesh.nodes[i].y(), std::sin(20 * mesh.nodes[i].z()));
    power += f[i].dot(v), up[i] += h * v, down[i] -= h * v;
  }
  ASSERT_GT(std::abs(power), 1);
  EXPECT_NEAR(power, -1e4 * (enclosed(up) - enclosed(down)) / (2 * h), 1e-6 * std::abs(power));
}

}  // namespace
}  // namespace carus::fem
