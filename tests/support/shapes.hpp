// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "carus/mesh/shapes.hpp"

namespace carus {
namespace shapes = mesh::shapes;
}
