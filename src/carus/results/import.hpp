// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>

#include "carus/scenario/scenario.hpp"

namespace carus::results {

/// The anatomy that export_anatomy wrote, bit for bit, in place of meshing the scenario's. Its keys must be those that
/// it was meshed with: they describe it, and the canal's axis is taken from them. Throws InputError with all that is
/// wrong: no such folder, a file that is missing, damaged, truncated or another's, a key that differs.
anatomy::Anatomy read_anatomy(const std::filesystem::path& folder, const scenario::Scenario& scenario);

}  // namespace carus::results
