// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vtkAlgorithm.h>
#include <vtkPolyData.h>
#include <vtkSmartPointer.h>

#include <string>

#include "carus/mesh/surface.hpp"

namespace carus::imaging {

vtkSmartPointer<vtkPolyData> to_vtk(const mesh::Surface& s, double scale = 1);
mesh::Surface from_vtk(vtkPolyData& data);  ///< polygons cut into triangles; indices are not checked

/// Runs a reader or writer; what VTK would print as an error is thrown as InputError, beginning with `name`.
void run(vtkAlgorithm& algorithm, const std::string& name);

}  // namespace carus::imaging
