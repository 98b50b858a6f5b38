// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <vector>

#include "carus/imaging/label_volume.hpp"

namespace carus::imaging {

/// A label volume as a solid without steps: each label's indicator function smoothed and interpolated, each label with
/// the level at which it keeps its volume. Labels that touch share one smooth interface. Thread-safe.
class SmoothLabels {
 public:
  /// labels: those that count, in any order; smoothing: standard deviation of the Gaussian [voxels]. Throws InputError
  /// for labels that do not occur; `name` begins the message.
  SmoothLabels(const LabelVolume& volume, const std::vector<std::int32_t>& labels, double smoothing,
               const std::string& name);
  [[nodiscard]] std::int32_t label(const Vec3& x) const;  ///< 0 outside; nanoseconds per label whose box holds x

  struct Box {
    Vec3 low, high;
  };
  [[nodiscard]] Box box() const;  ///< of everything that counts [m]

 private:
  struct Field {
    std::int32_t label;
    std::array<int, 3> size;
    Mat3 to_index;
    Vec3 origin;
    std::vector<float> values;
    double level;
    Box box;
    [[nodiscard]] double at(const Vec3& x) const;
  };
  std::vector<Field> fields_;
};

}  // namespace carus::imaging
