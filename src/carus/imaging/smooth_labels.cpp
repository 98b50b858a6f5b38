// SPDX-License-Identifier: Apache-2.0
#include "carus/imaging/smooth_labels.hpp"

#include <Eigen/LU>
#include <algorithm>
#include <cmath>

#include "carus/imaging/indicator.hpp"

namespace carus::imaging {

SmoothLabels::SmoothLabels(const LabelVolume& volume, const std::vector<std::int32_t>& labels, double smoothing,
                           const std::string& name) {
  for (const auto l : labels) {
    const auto v = crop(volume, l, static_cast<int>(std::ceil(3 * smoothing)) + 2, name);
    Field f{l, v.size, v.axes.inverse(), v.origin, smoothed_indicator(v, smoothing), 0, {v.origin, v.origin}};
    f.level = level_of_volume(f.values, v);
    for (int corner = 0; corner < 8; ++corner) {
      const Vec3 x = v.position({(corner & 1) != 0 ? v.size[0] - 1.0 : 0.0, (corner & 2) != 0 ? v.size[1] - 1.0 : 0.0,
                                 (corner & 4) != 0 ? v.size[2] - 1.0 : 0.0});
      f.box.low = f.box.low.cwiseMin(x), f.box.high = f.box.high.cwiseMax(x);
    }
    fields_.push_back(std::move(f));
  }
}

double SmoothLabels::Field::at(const Vec3& x) const {
  if ((x.array() < box.low.array()).any() || (x.array() > box.high.array()).any()) return 0;
  const Vec3 q = to_index * (x - origin);
  std::array<int, 3> c{};
  Vec3 t;
  for (int k = 0; k < 3; ++k) {
    if (!(q[k] >= 0 && q[k] <= size[k] - 1)) return 0;
    c[k] = std::min(static_cast<int>(q[k]), size[k] - 2);
    t[k] = q[k] - c[k];
  }
  double sum = 0;
  for (int corner = 0; corner < 8; ++corner) {
    const int i = corner & 1, j = corner >> 1 & 1, k = corner >> 2;
    const double w = (i != 0 ? t[0] : 1 - t[0]) * (j != 0 ? t[1] : 1 - t[1]) * (k != 0 ? t[2] : 1 - t[2]);
    sum +=
        w * static_cast<double>(values[(static_cast<std::size_t>(c[2] + k) * size[1] + c[1] + j) * size[0] + c[0] + i]);
  }
  return sum;
}

std::int32_t SmoothLabels::label(const Vec3& x) const {
  // Inside what counts where all labels together pass their levels, so that no groove runs along where two of them and
  // the outside meet; there the label is whichever is strongest.
  double together = 0, most = 0;
  std::int32_t best = 0;
  for (const auto& f : fields_) {
    const double v = f.at(x) / f.level;
    together += v;
    if (v > most) most = v, best = f.label;
  }
  return together > 1 ? best : 0;
}

SmoothLabels::Box SmoothLabels::box() const {
  Box b = fields_.front().box;
  for (const auto& f : fields_) b.low = b.low.cwiseMin(f.box.low), b.high = b.high.cwiseMax(f.box.high);
  return b;
}

}  // namespace carus::imaging
