// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "carus/verify/statics.hpp"

/// Pieces of scenes with contact.
namespace carus::verify {

/// The flat part of a body's surface at z: whole boxes have edges, which the smooth gap takes for curvature.
fem::ContactSurface flat_face(const mesh::TetMesh& mesh, const char* name, int label, double z);

/// A follower pressure on the facets at z, risen to its full value at `ramp` [s].
fem::PressureLoad press(const mesh::TetMesh& mesh, double z, double pressure, double ramp);

/// Sum of the contact forces on the nodes of one label [N].
Vec3 force_on(const fem::Model& m, const solve::Observables& o, int label);

}  // namespace carus::verify
