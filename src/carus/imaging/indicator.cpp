// SPDX-License-Identifier: Apache-2.0
#include "carus/imaging/indicator.hpp"

#include <vtkImageData.h>
#include <vtkImageGaussianSmooth.h>
#include <vtkNew.h>

#include <algorithm>

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

double level_of_volume(const std::vector<float>& values, const std::vector<std::int32_t>& labels) {
  const auto n = static_cast<std::ptrdiff_t>(labels.size()) - std::count(labels.begin(), labels.end(), 0);
  std::vector<float> sorted(values);
  std::nth_element(sorted.begin(), sorted.begin() + n - 1, sorted.end(), std::greater<>());
  // Never below what a plain wall has a voxel outside it, nor so high that the organ falls apart.
  return std::clamp(static_cast<double>(sorted[static_cast<std::size_t>(n - 1)]), 0.2, 0.8);
}

}  // namespace carus::imaging
