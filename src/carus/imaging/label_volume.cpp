// SPDX-License-Identifier: Apache-2.0
#include "carus/imaging/label_volume.hpp"

#include <fmt/format.h>

#include <Eigen/LU>
#include <algorithm>
#include <cmath>

#include "carus/core/error.hpp"

namespace carus::imaging {

std::int32_t LabelVolume::label(const Vec3& x) const {
  const Vec3 ijk = axes.inverse() * (x - origin);
  std::array<int, 3> v{};
  for (int k = 0; k < 3; ++k) {
    if (!(ijk[k] > -0.5 && ijk[k] < size[k] - 0.5)) return 0;
    v[k] = static_cast<int>(std::floor(ijk[k] + 0.5));
  }
  return labels[index(v[0], v[1], v[2])];
}

std::map<std::int32_t, std::size_t> count_labels(const LabelVolume& v) {
  std::map<std::int32_t, std::size_t> count;
  std::size_t run = 0;  // labels come in runs: one look-up for each
  for (std::size_t i = 0; i < v.labels.size(); ++i) {
    ++run;
    if (i + 1 < v.labels.size() && v.labels[i + 1] == v.labels[i]) continue;
    if (v.labels[i] != 0) count[v.labels[i]] += run;
    run = 0;
  }
  return count;
}

LabelVolume crop(const LabelVolume& v, std::int32_t label, int margin, const std::string& name) {
  std::array<int, 3> low = v.size, high{-1, -1, -1};
  for (int k = 0; k < v.size[2]; ++k)
    for (int j = 0; j < v.size[1]; ++j)
      for (int i = 0; i < v.size[0]; ++i) {
        if (v.labels[v.index(i, j, k)] != label) continue;
        const std::array<int, 3> at{i, j, k};
        for (int a = 0; a < 3; ++a) low[a] = std::min(low[a], at[a]), high[a] = std::max(high[a], at[a]);
      }
  if (high[0] < 0) {
    std::vector<std::int32_t> present;
    for (const auto& [l, n] : count_labels(v)) present.push_back(l);
    throw InputError(fmt::format("{}: label {} does not occur; there are {}", name, label, fmt::join(present, ", ")));
  }
  LabelVolume c;
  c.axes = v.axes;
  const Vec3 first(low[0] - margin, low[1] - margin, low[2] - margin);
  c.origin = v.position(first);
  for (int a = 0; a < 3; ++a) c.size[a] = high[a] - low[a] + 1 + 2 * margin;
  c.labels.assign(static_cast<std::size_t>(c.size[0]) * c.size[1] * c.size[2], 0);
  for (int k = low[2]; k <= high[2]; ++k)
    for (int j = low[1]; j <= high[1]; ++j)
      for (int i = low[0]; i <= high[0]; ++i)
        if (v.labels[v.index(i, j, k)] == label)
          c.labels[c.index(i - low[0] + margin, j - low[1] + margin, k - low[2] + margin)] = label;
  return c;
}

}  // namespace carus::imaging
