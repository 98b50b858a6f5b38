// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <vector>

#include "carus/mesh/tet_mesh.hpp"

namespace carus::contact {

/// Uniform grid over the boxes of triangles, for searches that narrow as they find something and leave out what faces
/// the wrong way.
class TriangleGrid {
 public:
  /// `reach` [m]: the distance most searches start from. Cost: a few tens of nanoseconds per triangle.
  void build(const std::vector<Vec3>& x, const mesh::Triangles& triangles, double reach);

  /// Calls f(triangle) for every triangle that may lie within sqrt(bound2) of p and whose normal does not point along
  /// `facing` (unit; zero for all), in no particular order and possibly more than once. f may lower bound2: the cell of
  /// p comes first, so that little else is looked at where the nearest is close.
  template <class F>
  void for_each_near(const Vec3& p, const Vec3& facing, const double& bound2, F&& f) const {
    if (begin_.empty() || hull_.squaredExteriorDistance(p) > bound2) return;
    const Query q{p, p.cast<float>(), facing.cast<float>(), bound2};
    const auto own = cell_of(p);
    if (worth(own, q)) visit(own, q, f);
    const double r = std::sqrt(bound2);
    const auto lo = cell_of(p.array() - r), hi = cell_of(p.array() + r);
    for (int k = lo[2]; k <= hi[2]; ++k) {
      for (int j = lo[1]; j <= hi[1]; ++j) {
        for (int i = lo[0]; i <= hi[0]; ++i) {
          const std::array<int, 3> c{i, j, k};
          if (c != own && worth(c, q)) visit(c, q, f);
        }
      }
    }
  }

 private:
  using Box = Eigen::AlignedBox3d;
  static constexpr float rounding =
      1e-5f;  // of single precision: what is decided here lets pass too much, never too little

  struct Query {
    const Vec3& p;
    Eigen::Vector3f p_float, facing;
    const double& bound2;
  };
  struct Item {
    Eigen::Vector3f centre, half;  // box, rounded outwards
    Eigen::Vector3f normal;        // unit
    std::int32_t triangle;
  };
  /// The normals in a cell lie within an angle of an axis. All point along n if cos(n, axis) > sin(angle).
  struct Cone {
    Eigen::Vector3f axis;
    float sine;
  };

  [[nodiscard]] std::array<int, 3> cell_of(const Vec3& p) const {
    std::array<int, 3> c{};
    for (int k = 0; k < 3; ++k) c[k] = int(std::clamp((p[k] - hull_.min()[k]) / cell_, 0.0, double(n_[k] - 1)));
    return c;
  }
  [[nodiscard]] std::size_t index(const std::array<int, 3>& c) const {
    return (std::size_t(c[2]) * std::size_t(n_[1]) + std::size_t(c[1])) * std::size_t(n_[0]) + std::size_t(c[0]);
  }
  [[nodiscard]] bool worth(const std::array<int, 3>& c, const Query& q) const {
    const std::size_t i = index(c);
    if (begin_[i] == begin_[i + 1] || cones_[i].axis.dot(q.facing) > cones_[i].sine) return false;
    const Vec3 low = hull_.min() + cell_ * Vec3(c[0], c[1], c[2]);
    return Box(low, low.array() + cell_).squaredExteriorDistance(q.p) <= q.bound2;
  }
  template <class F>
  void visit(const std::array<int, 3>& c, const Query& q, F& f) const {
    for (std::int32_t k = begin_[index(c)]; k < begin_[index(c) + 1]; ++k) {
      const Item& item = items_[std::size_t(k)];
      if (item.normal.dot(q.facing) > rounding) continue;
      const Eigen::Array3f out = ((q.p_float - item.centre).cwiseAbs() - item.half).cwiseMax(0.0f);
      if (out.matrix().squaredNorm() <= float(q.bound2)) f(item.triangle);
    }
  }
  template <class F>
  void for_each_cell(const Box& box, F&& f) const {
    const auto lo = cell_of(box.min()), hi = cell_of(box.max());
    for (int k = lo[2]; k <= hi[2]; ++k) {
      for (int j = lo[1]; j <= hi[1]; ++j) {
        for (int i = lo[0]; i <= hi[0]; ++i) f(index({i, j, k}));
      }
    }
  }

  std::vector<Box> boxes_;   // per triangle
  std::vector<Item> of_;     // per triangle
  std::vector<Cone> cones_;  // per cell
  Box hull_;
  double cell_ = 1;
  std::array<int, 3> n_{0, 0, 0};
  std::vector<Item> items_;  // per cell
  std::vector<std::int32_t> begin_, next_;
};

}  // namespace carus::contact
