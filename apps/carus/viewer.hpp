// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

namespace carus::app {

/// The viewer's page: that of `file`, or the built-in one where `file` is empty. Throws InputError if there is none.
std::string viewer_page(const std::string& file);

}  // namespace carus::app
