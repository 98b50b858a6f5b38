// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "carus/mesh/surface.hpp"

namespace carus::imaging {

/// A value at each node of a surface; its unit is in its name.
struct NodeField {
  std::string name;
  std::vector<double> values;
};

/// Writes a surface in RAS and millimetres, whole or not at all: .stl, .ply or, with fields, .vtp, by the name's
/// extension. Throws InputError for other extensions or if it cannot be written.
void write_surface(const mesh::Surface& s, const std::filesystem::path& file,
                   const std::vector<NodeField>& fields = {});

}  // namespace carus::imaging
