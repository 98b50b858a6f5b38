// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "carus/verify/models.hpp"
#include "shapes.hpp"

namespace carus::models {
using namespace verify;
}
