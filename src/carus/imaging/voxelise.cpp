// SPDX-License-Identifier: Apache-2.0
#include "carus/imaging/voxelise.hpp"

#include <fmt/format.h>
#include <vtkImageStencilData.h>
#include <vtkNew.h>
#include <vtkPolyDataToImageStencil.h>

#include "carus/core/error.hpp"
#include "carus/imaging/vtk_surface.hpp"

namespace carus::imaging {

LabelVolume voxelise(const std::vector<LabelledSurface>& surfaces, double spacing) {
  constexpr int margin = 6;
  constexpr double most = 2e8;
  Eigen::AlignedBox3d box;
  for (const auto& s : surfaces) box.extend(mesh::box(s.surface));
  const Vec3 wanted = (box.sizes() / spacing).array().ceil() + 2 * margin + 1;
  if (!(wanted.prod() <= most))
    throw InputError(
        fmt::format("voxels of {:.2g} mm over {:.0f} x {:.0f} x {:.0f} mm: more than {:.0f} million; are "
                    "the surfaces in the unit that is said?",
                    1e3 * spacing, 1e3 * box.sizes().x(), 1e3 * box.sizes().y(), 1e3 * box.sizes().z(), most / 1e6));
  LabelVolume v;
  for (int k = 0; k < 3; ++k) v.size[k] = static_cast<int>(wanted[k]);
  v.axes *= spacing;
  v.origin = box.min().array() - margin * spacing;
  v.labels.resize(v.index(0, 0, v.size[2]));
  for (const auto& [surface, label] : surfaces) {
    // In voxels, since VTK keeps coordinates in single precision.
    auto in_voxels = surface;
    for (auto& x : in_voxels.nodes) x = (x - v.origin) / spacing;
    vtkNew<vtkPolyDataToImageStencil> inside;
    inside->SetInputData(to_vtk(in_voxels));
    inside->SetOutputWholeExtent(0, v.size[0] - 1, 0, v.size[1] - 1, 0, v.size[2] - 1);
    run(*inside, "voxels of a surface");
    for (int k = 0; k < v.size[2]; ++k)
      for (int j = 0; j < v.size[1]; ++j) {
        int from = 0, to = 0, next = 0;
        while (inside->GetOutput()->GetNextExtent(from, to, 0, v.size[0] - 1, j, k, next) != 0)
          for (int i = from; i <= to; ++i)
            if (auto& l = v.labels[v.index(i, j, k)]; l == 0) l = label;
      }
  }
  return v;
}

}  // namespace carus::imaging
