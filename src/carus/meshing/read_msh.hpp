// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>

#include "carus/mesh/named_mesh.hpp"

namespace carus::meshing {

/// A gmsh MSH file (any version that gmsh reads) of linear tetrahedra, in its own unit. Physical groups of volumes are
/// regions, of surfaces surfaces, of points and curves node sets; those without a name are called "volume 1" and so on.
/// Tets in no group become a region without name. Throws InputError. Not thread-safe: gmsh has one state.
mesh::NamedMesh read_msh(const std::filesystem::path& file);

}  // namespace carus::meshing
