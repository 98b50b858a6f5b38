// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vtkSmartPointer.h>

#include <filesystem>
#include <functional>
#include <string>

class vtkUnstructuredGrid;

namespace carus::results {

/// What a VTU file holds. Where it is missing, cut off or damaged `refuse` is told so, and throws.
vtkSmartPointer<vtkUnstructuredGrid> read_vtu(const std::filesystem::path& file,
                                              const std::function<void(const std::string& what)>& refuse);

}  // namespace carus::results
