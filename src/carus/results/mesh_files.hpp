// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <map>
#include <string>

#include "carus/mesh/tet_mesh.hpp"

namespace carus::results {

/// Writes tetrahedra with their labels, in RAS and millimetres, whole or not at all, by the name's extension:
///
///     .vtu   VTK, cell data "label"
///     .msh   gmsh 2.2 text: a physical volume for each label, a physical surface for each pair of labels that touch
///     .inp   Abaqus: C3D4, an element set for each label
///     .stl   the surfaces only, those between two labels once
///
/// names: of the labels, for .msh and .inp; a label without one is "label_N". Throws InputError for other extensions or
/// if it cannot be written.
void write_mesh(const mesh::TetMesh& mesh, const std::map<std::int32_t, std::string>& names,
                const std::filesystem::path& file);

}  // namespace carus::results
