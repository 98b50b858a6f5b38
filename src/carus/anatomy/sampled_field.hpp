// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <functional>
#include <vector>

#include "carus/core/types.hpp"

namespace carus::anatomy {

/// The true signed distance to a smooth implicit surface, sampled on a grid and interpolated linearly.
/// Walls that are offsets of the surface so get their thickness, which the implicit function itself would distort.
class SampledField {
 public:
  /// f: any function, negative inside, of slope of order one; box and grid spacing h [m].
  SampledField(const std::function<double(const Vec3&)>& f, const Vec3& low, const Vec3& high, double h);
  /// Constant beyond the box. Error about h^2/8 times the curvature.
  [[nodiscard]] double operator()(const Vec3& x) const;
  [[nodiscard]] Vec3 gradient(const Vec3& x) const;

 private:
  [[nodiscard]] double& at(int i, int j, int k) {
    return values_[(static_cast<std::size_t>(i) * n_[1] + j) * n_[2] + k];
  }
  [[nodiscard]] double at(int i, int j, int k) const {
    return values_[(static_cast<std::size_t>(i) * n_[1] + j) * n_[2] + k];
  }
  Vec3 low_;
  double h_;
  std::array<int, 3> n_;
  std::vector<double> values_;
};

}  // namespace carus::anatomy
