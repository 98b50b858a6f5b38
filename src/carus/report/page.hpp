// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace carus::report {

/// The viewer's page (web/dist/viewer.html) that this build holds; empty in builds made without it.
std::string_view built_in_viewer();

/// JSON that may stand inside a script element: <, >, & and the line separators U+2028, U+2029 become \u escapes, which
/// mean the same inside JSON's strings and occur nowhere else in it.
std::string for_script(std::string_view json);

/// `viewer` with the manifest and the blobs (base64 of each) spliced in at <!--CARUS-DATA-->. Throws InputError if
/// `viewer` does not hold that comment exactly once.
std::string page(std::string_view viewer, std::string_view manifest_json, const std::vector<std::string>& blobs);

}  // namespace carus::report
