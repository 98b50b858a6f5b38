// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "carus/anatomy/pelvic_floor.hpp"
#include "carus/anatomy/uterus.hpp"

namespace carus::meshing {

/// The uterine wall as one layer of prisms on a surface of staggered rings about the canal's axis, from the pole of the
/// dome to a flat end at the vulva. h: edge [m]. No CGAL: the wall's rings are its coordinates, its end is exactly
/// plane, its altitudes are near its thickness.
/// The pelvic floor follows in layers of its own on the canal's end: levator sheet, perineal body.
mesh::TetMesh mesh_wall(const anatomy::Uterus& uterus, const anatomy::PelvicFloor& floor, double levator_thickness,
                        double h);

}  // namespace carus::meshing
