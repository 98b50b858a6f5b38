// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>

#include "carus/mesh/named_mesh.hpp"

namespace carus::results {

/// A VTU file of linear tetrahedra, in its own unit. Taken from it:
///
///     cell data    region (or label), integers; field data region_names, one per number from 0, or "region N"
///     triangles    cells among the tets: surfaces, by `region` too, or by cell data surface with surface_names
///     point data   arrays of integers: node sets, of the nodes where they are not 0
///     field data   nodes:NAME and surface:NAME, indices, as carus anatomy writes them
///
/// Throws InputError with file, cell and what is allowed.
mesh::NamedMesh read_vtu(const std::filesystem::path& file);

}  // namespace carus::results
