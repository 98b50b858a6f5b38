// SPDX-License-Identifier: Apache-2.0
#pragma once

#ifdef __AVX2__
#include <immintrin.h>
#endif

#include <algorithm>

#include "carus/core/error.hpp"
#include "carus/fem/element_block.hpp"
#include "carus/material/fibre.hpp"
#include "carus/material/hooke.hpp"
#include "carus/material/mooney_rivlin.hpp"
#include "carus/material/neo_hooke.hpp"
#include "carus/material/prony.hpp"
