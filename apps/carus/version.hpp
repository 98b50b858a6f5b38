// SPDX-License-Identifier: Apache-2.0
#pragma once

namespace carus::app {

extern const char* const program_version;  ///< the project's
extern const char* const
    program_commit;  ///< that the build was configured at, "-dirty" with changes; "unknown" without git

}  // namespace carus::app
