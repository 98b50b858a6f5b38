// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vtkSmartPointer.h>
#include <vtkUnstructuredGrid.h>

#include <filesystem>

#include "carus/mesh/tet_mesh.hpp"

namespace carus::results {

enum class Precision { single, full };
vtkSmartPointer<vtkUnstructuredGrid> tet_grid(const std::vector<Vec3>& x, const std::vector<mesh::Tet>& tets,
                                              Precision of_points = Precision::single);
void set_vectors(vtkDataSetAttributes& to, const char* name, const std::vector<Vec3>& values, double scale = 1);
void set_scalars(vtkDataSetAttributes& to, const char* name, const std::vector<double>& values);
void set_integers(vtkDataSetAttributes& to, const char* name, const std::vector<std::int32_t>& values);
void set_names(vtkUnstructuredGrid& grid, const char* name, const std::vector<std::string>& values);

/// Appended raw, zlib level 1, 32-bit indices. Throws InputError if it cannot be written.
void write_vtu(vtkUnstructuredGrid& grid, const std::filesystem::path& file);

}  // namespace carus::results
