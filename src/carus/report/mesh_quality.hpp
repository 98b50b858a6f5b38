// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "carus/report/frame_file.hpp"

namespace carus::report {

struct MeshQuality {
  double least_angle = 0;  ///< [deg] least dihedral angle of any tet at rest
  double low_angle = 0;    ///< [deg] 1 % of the tets have a lesser one
  double mean_edge = 0;    ///< [m]
};
MeshQuality mesh_quality(const FrameMesh& mesh);

}  // namespace carus::report
