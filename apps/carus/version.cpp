// SPDX-License-Identifier: Apache-2.0
#include "version.hpp"

namespace carus::app {

const char* const program_version = CARUS_VERSION;
const char* const program_commit = CARUS_COMMIT;

}  // namespace carus::app
