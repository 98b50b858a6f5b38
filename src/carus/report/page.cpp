// SPDX-License-Identifier: Apache-2.0
#include "carus/report/page.hpp"

#include <fmt/format.h>

#include "carus/core/error.hpp"
#include "carus/report/coding.hpp"

namespace carus::report {
namespace {

constexpr std::string_view place = "<!--CARUS-DATA-->";

}  // namespace

std::string for_script(std::string_view json) {
  std::string out;
  out.reserve(json.size() + json.size() / 16);
  for (std::size_t i = 0; i < json.size(); ++i) {
    const char c = json[i];
    if (c == '<') {
      out += "\\u003c";
    } else if (c == '>') {
      out += "\\u003e";
    } else if (c == '&') {
      out += "\\u0026";
    } else if (const auto three = json.substr(i, 3); three == "\xE2\x80\xA8" || three == "\xE2\x80\xA9") {
      out += three[2] == '\xA8' ? "\\u2028" : "\\u2029";
      i += 2;
    } else {
      out += c;
    }
  }
  return out;
}

std::string page(std::string_view viewer, std::string_view manifest_json, const std::vector<std::string>& blobs) {
  const auto at = viewer.find(place);
  if (at == std::string_view::npos || viewer.find(place, at + 1) != std::string_view::npos)
    throw InputError(fmt::format("the viewer's page does not hold {} exactly once; build it with ./dev build", place));
  std::size_t size = viewer.size() + manifest_json.size() + 4096;
  for (const auto& b : blobs) size += b.size() * 4 / 3 + 128;
  std::string out;
  out.reserve(size);
  out += viewer.substr(0, at);
  out += "<script id=\"carus-manifest\" type=\"application/json\">";
  out += for_script(manifest_json);
  out += "</script>\n";
  for (std::size_t i = 0; i < blobs.size(); ++i) {
    out += fmt::format("<script id=\"carus-blob-{}\" type=\"text/plain\">", i);
    out += base64(blobs[i]);
    out += "</script>\n";
  }
  out += viewer.substr(at + place.size());
  return out;
}

}  // namespace carus::report
