// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <map>
#include <string>
#include <string_view>
#include <vector>

namespace carus::imaging {

/// "key <separator> value" lines at the start of a file. Keys in lower case; a key that comes twice keeps its last
/// value.
struct TextHeader {
  std::map<std::string, std::string> fields;
  std::size_t end = 0;  ///< offset of the first byte after it
};

std::string trimmed(std::string_view text);
std::string lower(std::string_view text);
std::vector<std::string> words(std::string_view text);

/// The field, or an InputError, beginning with `name`, that says it is missing.
const std::string& required(const TextHeader& h, const std::string& key, const std::string& name);

/// Decimal numbers in a text, whatever brackets and commas stand between them: exactly n, else InputError.
std::vector<double> numbers(const std::string& text, std::size_t n, const std::string& key, const std::string& name);

}  // namespace carus::imaging
