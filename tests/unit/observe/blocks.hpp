// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <string>

#include "carus/fem/model.hpp"
#include "carus/observe/observer.hpp"

namespace carus::test {

/// Adds a box of n^3 cells of six tets each, one region, with its surface as a contact surface.
inline void add_box(fem::Model& model, const std::string& region, const std::string& organ, const Vec3& low,
                    const Vec3& high, int n) {
  const auto first = std::int32_t(model.mesh.nodes.size());
  const auto label = std::int32_t(model.regions.size());
  fem::Region r;
  r.name = region, r.organ = organ;
  model.regions.push_back(r);
  for (int k = 0; k <= n; ++k)
    for (int j = 0; j <= n; ++j)
      for (int i = 0; i <= n; ++i) model.mesh.nodes.push_back(low + (high - low).cwiseProduct(Vec3(i, j, k) / n));
  const auto node = [&](int i, int j, int k) { return first + std::int32_t((k * (n + 1) + j) * (n + 1) + i); };
  constexpr std::array<std::array<int, 3>, 6> orders{
      {{0, 1, 2}, {1, 2, 0}, {2, 0, 1}, {0, 2, 1}, {2, 1, 0}, {1, 0, 2}}};
  mesh::TetMesh own;
  for (int k = 0; k < n; ++k)
    for (int j = 0; j < n; ++j)
      for (int i = 0; i < n; ++i)
        for (std::size_t o = 0; o < 6; ++o) {  // Kuhn: along the axes in every order; odd orders are turned
          std::array<int, 3> c{i, j, k};
          mesh::Tet t{node(i, j, k)};
          for (std::size_t s = 0; s < 3; ++s) ++c[orders[o][s]], t[s + 1] = node(c[0], c[1], c[2]);
          if (o >= 3) std::swap(t[1], t[2]);
          model.mesh.tets.push_back(t);
          model.mesh.labels.push_back(label);
        }
  model.blocked.resize(model.mesh.nodes.size(), 0);
  model.contact_surfaces.push_back({organ, mesh::boundary(model.mesh, [=](std::int32_t l) { return l == label; })});
}

/// A fetus of two boxes (head below trunk) above a vulva at z = -0.1 whose canal runs straight down.
inline fem::Model fetus_of_boxes() {
  fem::Model model;
  add_box(model, "skull", "fetus", {-0.04, -0.05, 0.00}, {0.04, 0.05, 0.08}, 2);
  add_box(model, "fetal_body", "fetus", {-0.05, -0.05, 0.081}, {0.05, 0.05, 0.25}, 2);
  model.contact_pairs.push_back({0, 1});
  model.pressures.push_back({"contraction", {}, [](double) { return 0.0; }});
  return model;
}

inline observe::Setup setup_of_boxes() {
  observe::Setup s;
  s.landmarks = {{"occiput", {-0.04, 0, 0.04}},         {"sinciput", {0.04, 0, 0.04}},
                 {"biparietal_right", {0, 0.05, 0.04}}, {"biparietal_left", {0, -0.05, 0.04}},
                 {"spine_right", {0.05, 0, -0.05}},     {"spine_left", {-0.05, 0, -0.05}},
                 {"vulva_centre", {0, 0, -0.1}},        {"vulva_normal", {0, 0, -1}}};
  s.fetal_regions = {"skull", "fetal_body"}, s.head_regions = {"skull"}, s.trunk_regions = {"fetal_body"};
  s.canal_nearest = [](const Vec3& x) { return -x.z(); };
  s.canal_tangent = [](double) { return Vec3(0, 0, -1); };
  s.nodes["point_fundus"] = {26};
  s.nodes["point_lower"] = {0};
  return s;
}

}  // namespace carus::test
