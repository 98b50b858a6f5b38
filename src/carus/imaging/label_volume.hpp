// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <map>
#include <vector>

#include "carus/core/types.hpp"

namespace carus::imaging {

/// Voxels with a label each, 0 outside, as segmentation programs write them.
struct LabelVolume {
  std::array<int, 3> size{};
  Mat3 axes = Mat3::Identity();      ///< columns: the step from one voxel to the next along i, j, k [m], in RAS; may be
                                     ///< oblique, anisotropic, left-handed
  Vec3 origin = Vec3::Zero();        ///< centre of voxel (0, 0, 0) [m], in RAS
  std::vector<std::int32_t> labels;  ///< i fastest

  [[nodiscard]] std::size_t index(int i, int j, int k) const {
    return (static_cast<std::size_t>(k) * size[1] + j) * size[0] + i;
  }
  [[nodiscard]] Vec3 position(const Vec3& ijk) const { return origin + axes * ijk; }
  [[nodiscard]] std::int32_t label(const Vec3& x) const;  ///< of the voxel that x lies in, 0 beyond the volume
  [[nodiscard]] Vec3 spacing() const { return axes.colwise().norm(); }
  [[nodiscard]] double voxel_volume() const { return std::abs(axes.determinant()); }  ///< [m^3]
};

/// Labels that occur (without 0) and how many voxels each has.
std::map<std::int32_t, std::size_t> count_labels(const LabelVolume& v);

/// The part of the volume round one label, with `margin` voxels of 0 on every side; every other label is 0 in it.
/// Throws InputError if the label does not occur, naming those that do; `name` begins the message.
LabelVolume crop(const LabelVolume& v, std::int32_t label, int margin, const std::string& name);

}  // namespace carus::imaging
