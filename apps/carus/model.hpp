// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>

#include "app.hpp"
#include "carus/scenario/model_scenario.hpp"

namespace carus::app {

/// From a general model's scenario to its results folder; the exit status.
int run_model(const scenario::ModelScenario& scenario, const std::filesystem::path& out, bool resume);

/// Builds it, prints what it is made of; the exit status.
int check_model(const scenario::ModelScenario& scenario);

}  // namespace carus::app
