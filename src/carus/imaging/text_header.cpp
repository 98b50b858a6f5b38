// SPDX-License-Identifier: Apache-2.0
#include "carus/imaging/text_header.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <sstream>

#include "carus/core/error.hpp"

namespace carus::imaging {

std::string trimmed(std::string_view text) {
  const auto first = text.find_first_not_of(" \t\r\n"), last = text.find_last_not_of(" \t\r\n");
  return first == std::string_view::npos ? std::string() : std::string(text.substr(first, last - first + 1));
}

std::string lower(std::string_view text) {
  std::string s(text);
  std::transform(s.begin(), s.end(), s.begin(), [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  return s;
}

std::vector<std::string> words(std::string_view text) {
  std::istringstream in{std::string(text)};
  std::vector<std::string> w;
  for (std::string s; in >> s;) w.push_back(s);
  return w;
}

const std::string& required(const TextHeader& h, const std::string& key, const std::string& name) {
  const auto it = h.fields.find(key);
  if (it == h.fields.end()) throw InputError(fmt::format("{}: its header has no \"{}\"", name, key));
  return it->second;
}

std::vector<double> numbers(const std::string& text, std::size_t n, const std::string& key, const std::string& name) {
  std::string plain = text;
  std::replace_if(
      plain.begin(), plain.end(), [](char c) { return c == '(' || c == ')' || c == ','; }, ' ');
  std::vector<double> values;
  for (const auto& w : words(plain)) {
    if (w == "none") continue;
    double v = 0;
    const auto [end, problem] = std::from_chars(w.data(), w.data() + w.size(), v);
    if (problem != std::errc() || end != w.data() + w.size() || !std::isfinite(v))
      throw InputError(fmt::format("{}: {}: \"{}\" is no number", name, key, w.substr(0, 40)));
    values.push_back(v);
  }
  if (values.size() != n) throw InputError(fmt::format("{}: {}: {} numbers, {} expected", name, key, values.size(), n));
  return values;
}

}  // namespace carus::imaging
