// SPDX-License-Identifier: Apache-2.0
#include "carus/mesh/spatial_order.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <numeric>

namespace carus::mesh {

namespace {

constexpr int bits = 21;  // per axis; three of them fill a word

/// The bits of `v`, two zeros between each two.
std::uint64_t spread(std::uint64_t v) {
  std::uint64_t out = 0;
  for (int b = 0; b < bits; ++b) out |= (v >> b & 1U) << (3 * b);
  return out;
}

}  // namespace

std::vector<std::int32_t> z_order(const std::vector<Vec3>& points) {
  Eigen::AlignedBox3d box;
  for (const Vec3& p : points) box.extend(p);
  const double side = box.isEmpty() ? 0 : box.sizes().maxCoeff();
  const double scale = side > 0 ? double((1U << bits) - 1) / side : 0;
  std::vector<std::uint64_t> code;
  code.reserve(points.size());
  for (const Vec3& p : points) {
    const Vec3 cell = scale * (p - box.min());
    code.push_back(spread(std::uint64_t(cell.x())) | spread(std::uint64_t(cell.y())) << 1 |
                   spread(std::uint64_t(cell.z())) << 2);
  }
  std::vector<std::int32_t> order(points.size());
  std::iota(order.begin(), order.end(), 0);
  std::stable_sort(order.begin(), order.end(),
                   [&](auto a, auto b) { return code[std::size_t(a)] < code[std::size_t(b)]; });
  return order;
}

void order_spatially(TetMesh& mesh) {
  const auto order = z_order(mesh.nodes);
  std::vector<std::int32_t> renumbered(order.size());
  std::vector<Vec3> nodes;
  nodes.reserve(order.size());
  for (const auto old : order) {
    renumbered[std::size_t(old)] = std::int32_t(nodes.size());
    nodes.push_back(mesh.nodes[std::size_t(old)]);
  }
  mesh.nodes = std::move(nodes);
  std::vector<Vec3> centroids;
  centroids.reserve(mesh.tets.size());
  for (Tet& t : mesh.tets) {
    for (auto& n : t) n = renumbered[std::size_t(n)];
    centroids.push_back((mesh.nodes[t[0]] + mesh.nodes[t[1]] + mesh.nodes[t[2]] + mesh.nodes[t[3]]) / 4);
  }
  TetMesh sorted;
  sorted.nodes = std::move(mesh.nodes);
  for (const auto old : z_order(centroids)) {
    sorted.tets.push_back(mesh.tets[std::size_t(old)]);
    sorted.labels.push_back(mesh.labels[std::size_t(old)]);
  }
  mesh = std::move(sorted);
}

}  // namespace carus::mesh
