// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "carus/anatomy/anatomy.hpp"

namespace carus::meshing {

/// The whole reference anatomy: three bodies of tets that do not touch, with named nodes, surfaces, landmarks and
/// measurements. Throws InputError where parameters contradict each other. Seconds (coarse) to a minute (paper); the
/// same input gives the same bits.
anatomy::Anatomy build(const anatomy::Parameters& p);

}  // namespace carus::meshing
