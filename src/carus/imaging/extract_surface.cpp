// SPDX-License-Identifier: Apache-2.0
#include "carus/imaging/extract_surface.hpp"

#include <fmt/format.h>
#include <vtkFloatArray.h>
#include <vtkFlyingEdges3D.h>
#include <vtkImageData.h>
#include <vtkImageReslice.h>
#include <vtkNew.h>
#include <vtkPointData.h>
#include <vtkPolyData.h>
#include <vtkWindowedSincPolyDataFilter.h>

#include <Eigen/LU>
#include <algorithm>
#include <cmath>

#include "carus/core/error.hpp"
#include "carus/imaging/indicator.hpp"
#include "carus/imaging/vtk_surface.hpp"

namespace carus::imaging {
namespace {

constexpr double volume_goal = 0.002, volume_limit = 0.01;

/// Values on the voxels' grid, drawn on an isotropic one: origin 0, axes those of the voxels.
vtkSmartPointer<vtkImageData> resampled(std::vector<float>& values, const LabelVolume& v, double spacing) {
  vtkNew<vtkFloatArray> array;
  array->SetArray(values.data(), vtkIdType(values.size()), 1);  // values stays the owner
  vtkNew<vtkImageData> image;
  image->SetDimensions(v.size.data());
  image->SetSpacing(v.spacing().data());
  image->GetPointData()->SetScalars(array);
  vtkNew<vtkImageReslice> resample;
  resample->SetInputData(image);
  const double h = spacing > 0 ? spacing : v.spacing().minCoeff();
  resample->SetOutputSpacing(h, h, h);
  resample->SetInterpolationModeToCubic();
  resample->Update();
  return resample->GetOutput();
}

mesh::Surface level_set(vtkImageData& image, double level, const LabelVolume& v) {
  vtkNew<vtkFlyingEdges3D> contour;
  contour->SetInputData(&image);
  contour->SetValue(0, level);
  contour->ComputeNormalsOff();
  contour->ComputeGradientsOff();
  contour->ComputeScalarsOff();
  // What is left of the steps goes with the surface's highest frequencies (Taubin 1995), which keeps the volume.
  vtkNew<vtkWindowedSincPolyDataFilter> fair;
  fair->SetInputConnection(contour->GetOutputPort());
  fair->SetNumberOfIterations(15);
  fair->SetPassBand(0.1);
  fair->NormalizeCoordinatesOn();
  fair->BoundarySmoothingOff();
  fair->FeatureEdgeSmoothingOff();
  fair->NonManifoldSmoothingOn();
  fair->Update();
  auto s = from_vtk(*fair->GetOutput());
  const Mat3 directions = v.axes * v.spacing().cwiseInverse().asDiagonal();
  for (auto& x : s.nodes) x = v.origin + directions * x;
  if (directions.determinant() < 0)
    for (auto& t : s.triangles) std::swap(t[1], t[2]);
  return s;
}

/// Only the part with the largest volume.
void keep_largest(mesh::Surface& s, std::vector<std::string>& notes) {
  const auto p = mesh::parts(s);
  if (p.count < 2) return;
  std::vector<mesh::Surface> shells(p.count);
  for (std::size_t t = 0; t < s.triangles.size(); ++t) shells[p.of[t]].triangles.push_back(s.triangles[t]);
  std::int32_t best = 0;
  double most = -1;
  for (std::int32_t i = 0; i < p.count; ++i) {
    mesh::Surface shell{s.nodes, shells[i].triangles};
    if (const double v = std::abs(mesh::volume(shell)); v > most) most = v, best = i;
  }
  s.triangles = shells[best].triangles;
  notes.push_back(fmt::format("{} smaller parts left out", p.count - 1));
}

}  // namespace

Extracted extract_surface(const LabelVolume& volume, std::int32_t label, const ExtractOptions& o,
                          const std::string& name) {
  if (!(o.smoothing >= 0.3 && o.smoothing <= 3))
    throw InputError(fmt::format("{}: smoothing {}; allowed 0.3 to 3 voxels", name, o.smoothing));
  const auto v = crop(volume, label, static_cast<int>(std::ceil(3 * o.smoothing)) + 2, name);
  Extracted e;
  e.labelled_volume =
      static_cast<double>(v.labels.size() - std::count(v.labels.begin(), v.labels.end(), 0)) * v.voxel_volume();
  auto values = smoothed_indicator(v, o.smoothing);
  const auto image = resampled(values, v, o.spacing);
  // Secant steps on level -> volume. Cubic interpolation, which overshoots, and fairing move it a little from the first
  // guess.
  double level = level_of_volume(values, v), before = 0, error_before = 0, error = 0;
  for (int it = 0; it < 8; ++it) {
    e.surface = level_set(*image, level, v);
    e.volume = mesh::volume(e.surface);
    error = e.volume / e.labelled_volume - 1;
    if (std::abs(error) < volume_goal) break;
    const double slope = it == 0 ? -1.0 : (error - error_before) / (level - before);
    const double step = std::abs(slope) > 1e-6 ? -error / slope : 0;
    before = level, error_before = error;
    level = std::clamp(level + std::clamp(step, -0.1, 0.1), 0.05, 0.95);
  }
  if (!(std::abs(error) <= volume_limit))
    throw NumericalFailure(fmt::format(
        "{}: label {}: its surface holds {:+.1f} % of its voxels' volume; within 1 % is wanted; it is too thin for its "
        "voxels: smooth less, or give a finer volume",
        name, label, 100 * error));
  if (o.largest_part) keep_largest(e.surface, e.notes);
  auto closed = mesh::closed(std::move(e.surface), fmt::format("{}: label {}", name, label));
  e.surface = std::move(closed.surface);
  for (auto& r : closed.repairs) e.notes.push_back(std::move(r));
  e.volume = mesh::volume(e.surface);
  return e;
}

}  // namespace carus::imaging
