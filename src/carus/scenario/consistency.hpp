// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "carus/scenario/scenario.hpp"
#include "carus/scenario/settings.hpp"

namespace carus::scenario {

/// Relations between keys, each of them in its own range: what no schema can say. In the form of settle()'s problems.
Problems inconsistencies(const Scenario& scenario, const Settings& settings);

}  // namespace carus::scenario
