// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "carus/anatomy/anatomy.hpp"

namespace carus::anatomy {

/// Facet edges of a named resolution: "coarse" (seconds to mesh), "paper" (the surface nodes of the paper's Table 1),
/// "fine". Throws InputError for any other name.
MeshSize mesh_size(const std::string& resolution);

}  // namespace carus::anatomy
