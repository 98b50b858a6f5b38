// SPDX-License-Identifier: Apache-2.0
#include "carus/imaging/indicator.hpp"

#include <vtkImageData.h>
#include <vtkImageGaussianSmooth.h>
#include <vtkNew.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>

namespace carus::imaging {

std::vector<float> smoothed_indicator(const LabelVolume& v, double smoothing) {
  vtkNew<vtkImageData> image;
  image->SetDimensions(v.size.data());
  image->AllocateScalars(VTK_FLOAT, 1);
  std::transform(v.labels.begin(), v.labels.end(), static_cast<float*>(image->GetScalarPointer()),
                 [](std::int32_t l) { return l != 0 ? 1.F : 0.F; });
  vtkNew<vtkImageGaussianSmooth> smooth;
  smooth->SetInputData(image);
  smooth->SetStandardDeviation(smoothing);
  smooth->SetRadiusFactor(3);
  smooth->Update();
  const auto* p = static_cast<const float*>(smooth->GetOutput()->GetScalarPointer());
  return {p, p + v.labels.size()};
}

namespace {

/// Between voxels by linear interpolation; at: a voxel with neighbours on every side, off: from it, -1 to 1.
double between(const std::vector<float>& values, const LabelVolume& v, std::size_t at,
               const std::array<double, 3>& off) {
  const std::array<std::ptrdiff_t, 3> step{1, v.size[0], std::ptrdiff_t(v.size[0]) * v.size[1]};
  double sum = 0;
  for (int corner = 0; corner < 8; ++corner) {
    double w = 1;
    auto i = static_cast<std::ptrdiff_t>(at);
    for (int k = 0; k < 3; ++k) {
      const bool far = (corner >> k & 1) != 0;
      w *= far ? std::abs(off[k]) : 1 - std::abs(off[k]);
      if (far) i += off[k] < 0 ? -step[k] : step[k];
    }
    if (w > 0) sum += w * static_cast<double>(values[static_cast<std::size_t>(i)]);
  }
  return sum;
}

}  // namespace

double level_of_volume(const std::vector<float>& values, const LabelVolume& v) {
  constexpr float inside = 0.99F, outside = 0.01F;  // farther from the level than it will ever be
  constexpr int points = 8;
  // The sequence of the plastic number's kin in three dimensions (Roberts 2018): in a fixed pattern the points beside a
  // face along the grid would all have one value, and the level would jump over it.
  constexpr std::array<double, 3> step{0.8191725133961645, 0.6710436067037893, 0.5497004779019703};
  std::ptrdiff_t wanted = 0;
  std::vector<float> near_surface;
  for (int k = 1; k + 1 < v.size[2]; ++k)
    for (int j = 1; j + 1 < v.size[1]; ++j)
      for (int i = 1; i + 1 < v.size[0]; ++i) {
        const auto at = v.index(i, j, k);
        if (values[at] <= outside || values[at] >= inside) continue;
        wanted += v.labels[at] != 0 ? points : 0;
        for (int p = 0; p < points; ++p) {
          std::array<double, 3> off{};
          for (int c = 0; c < 3; ++c) {
            const double u = static_cast<double>(near_surface.size()) * step[c];
            off[c] = u - std::floor(u) - 0.5;
          }
          near_surface.push_back(static_cast<float>(between(values, v, at, off)));
        }
      }
  if (wanted == 0 || near_surface.empty()) return 0.5;
  const auto nth = near_surface.begin() + wanted - 1;
  std::nth_element(near_surface.begin(), nth, near_surface.end(), std::greater<>());
  return std::clamp(static_cast<double>(*nth), 0.2, 0.8);
}

}  // namespace carus::imaging
