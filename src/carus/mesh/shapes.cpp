// SPDX-License-Identifier: Apache-2.0
#include "carus/mesh/shapes.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <random>

namespace carus::mesh::shapes {

mesh::TetMesh grid(int nx, int ny, int nz, const std::function<Vec3(const Vec3&)>& map, std::int32_t label) {
  mesh::TetMesh m;
  std::map<std::array<std::int64_t, 3>, std::int32_t> seen;
  std::vector<std::int32_t> index;
  for (int k = 0; k <= nz; ++k) {
    for (int j = 0; j <= ny; ++j) {
      for (int i = 0; i <= nx; ++i) {
        const Vec3 p = map(Vec3(double(i) / nx, double(j) / ny, double(k) / nz));
        const std::array<std::int64_t, 3> key{std::llround(p.x() * 1e9), std::llround(p.y() * 1e9),
                                              std::llround(p.z() * 1e9)};
        const auto [it, fresh] = seen.try_emplace(key, std::int32_t(m.nodes.size()));
        if (fresh) m.nodes.push_back(p);
        index.push_back(it->second);
      }
    }
  }
  const auto at = [&](int i, int j, int k) { return index[std::size_t((k * (ny + 1) + j) * (nx + 1) + i)]; };
  constexpr int paths[6][3] = {{0, 1, 2}, {0, 2, 1}, {1, 0, 2}, {1, 2, 0}, {2, 0, 1}, {2, 1, 0}};
  for (int k = 0; k < nz; ++k) {
    for (int j = 0; j < ny; ++j) {
      for (int i = 0; i < nx; ++i) {
        for (const auto& path : paths) {  // the six ways from one corner to the opposite one
          int c[3] = {i, j, k};
          mesh::Tet t;
          t[0] = at(c[0], c[1], c[2]);
          for (int s = 0; s < 3; ++s) ++c[path[s]], t[s + 1] = at(c[0], c[1], c[2]);
          if (t[0] == t[1] || t[1] == t[2] || t[2] == t[3] || t[0] == t[2] || t[0] == t[3] || t[1] == t[3]) continue;
          m.tets.push_back(t);
          m.labels.push_back(label);
          if (mesh::volume(m, m.tets.size() - 1) < 0) std::swap(m.tets.back()[2], m.tets.back()[3]);
        }
      }
    }
  }
  return m;
}

mesh::TetMesh box(const Vec3& low, const Vec3& size, int nx, int ny, int nz, std::int32_t label) {
  return grid(
      nx, ny, nz, [&](const Vec3& u) -> Vec3 { return low + u.cwiseProduct(size); }, label);
}

mesh::TetMesh ball(const Vec3& centre, double r, int n, std::int32_t label) {
  return grid(
      n, n, n,
      [&](const Vec3& u) -> Vec3 {
        const Vec3 q = 2 * u - Vec3::Ones();
        const double cube = q.cwiseAbs().maxCoeff(), sphere = q.norm();
        return sphere > 0 ? Vec3(centre + r * cube / sphere * q) : centre;
      },
      label);
}

mesh::TetMesh tube(double r_inner, double r_outer, double z0, double z1, int n_radial, int n_around, int n_along,
                   std::int32_t label) {
  return grid(
      n_radial, n_around, n_along,
      [&](const Vec3& u) {
        const double r = r_inner + u.x() * (r_outer - r_inner), a = 2 * pi * u.y();
        return Vec3(r * std::cos(a), r * std::sin(a), z0 + u.z() * (z1 - z0));
      },
      label);
}

mesh::TetMesh sphere_octant(double r_inner, double r_outer, int n_radial, int n_around, std::int32_t label) {
  return grid(
      n_radial, n_around, n_around,
      [&](const Vec3& u) -> Vec3 {
        // The triangle x + y + z = 1 blown up to the sphere; its corner at v = 1 closes.
        const double v = u.y(), w = u.z();
        const Vec3 flat((1 - v) * (1 - w), (1 - v) * w, v);
        return (r_inner + u.x() * (r_outer - r_inner)) * flat.normalized();
      },
      label);
}

void shake(mesh::TetMesh& mesh, double amplitude) {
  std::mt19937 random(1);
  std::vector<bool> border(mesh.nodes.size(), false);
  for (const auto n : mesh::nodes_of(mesh::boundary(mesh))) border[std::size_t(n)] = true;
  for (std::size_t i = 0; i < mesh.nodes.size(); ++i) {
    if (border[i]) continue;
    for (int k = 0; k < 3; ++k) mesh.nodes[i][k] += amplitude * (double(random()) / double(random.max()) - 0.5);
  }
}

mesh::TetMesh join(const mesh::TetMesh& a, const mesh::TetMesh& b) {
  mesh::TetMesh m = a;
  const auto offset = std::int32_t(a.nodes.size());
  m.nodes.insert(m.nodes.end(), b.nodes.begin(), b.nodes.end());
  m.labels.insert(m.labels.end(), b.labels.begin(), b.labels.end());
  for (auto t : b.tets) {
    for (auto& n : t) n += offset;
    m.tets.push_back(t);
  }
  return m;
}

}  // namespace carus::mesh::shapes
