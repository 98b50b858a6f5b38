// SPDX-License-Identifier: Apache-2.0
#pragma once

namespace carus::app {

/// The project's.
extern const char* const program_version;
/// That the build was configured at, "-dirty" with changes; "unknown" without git.
extern const char* const program_commit;

}  // namespace carus::app
