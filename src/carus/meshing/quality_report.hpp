// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <map>

#include "carus/mesh/tet_mesh.hpp"

namespace carus::meshing {

/// Shape of the tets of one label. Altitudes bound the stable step: dt ~ altitude / speed of sound.
struct LabelQuality {
  std::size_t tets = 0;
  double volume = 0;  ///< [m^3]
  double min_dihedral_deg = 180, max_dihedral_deg = 0;
  double min_altitude = 1e9;  ///< [m]
  double mean_altitude = 0;   ///< [m]
  double max_aspect = 0;
};
std::map<std::int32_t, LabelQuality> quality_report(const mesh::TetMesh& mesh);

}  // namespace carus::meshing
