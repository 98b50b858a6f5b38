// SPDX-License-Identifier: Apache-2.0
// Wavefront OBJ: lines "v x y z" and "f i/t/n j/t/n k/t/n ...", indices from 1, negative ones from the end.
#include <fmt/format.h>

#include <charconv>

#include "carus/core/error.hpp"
#include "carus/imaging/read_surface.hpp"
#include "carus/imaging/text_header.hpp"

namespace carus::imaging {
namespace {

std::int32_t index_of(const std::string& corner, std::size_t nodes, std::size_t line, const std::string& name) {
  long long i = 0;
  const auto slash = std::min(corner.find('/'), corner.size());
  const auto [end, problem] = std::from_chars(corner.data(), corner.data() + slash, i);
  const auto n = static_cast<long long>(nodes);
  const long long from_0 = i < 0 ? n + i : i - 1;
  if (problem != std::errc() || end != corner.data() + slash || i == 0 || from_0 < 0 || from_0 >= n)
    throw InputError(fmt::format("{}: line {}: corner \"{}\"; there are {} nodes before it", name, line,
                                 corner.substr(0, 40), nodes));
  return static_cast<std::int32_t>(from_0);
}

}  // namespace

mesh::Surface read_obj(std::string_view bytes, const std::string& name) {
  mesh::Surface s;
  std::size_t at = 0;
  for (std::size_t line = 1; at < bytes.size(); ++line) {
    const auto end = std::min(bytes.find('\n', at), bytes.size());
    const auto text = bytes.substr(at, end - at);
    at = end + 1;
    const bool node = text.starts_with("v ") || text.starts_with("v\t"),
               face = text.starts_with("f ") || text.starts_with("f\t");
    if (!node && !face) continue;
    auto w = words(text.substr(2));
    if (face) {
      std::vector<std::int32_t> polygon;
      for (const auto& corner : w) polygon.push_back(index_of(corner, s.nodes.size(), line, name));
      if (polygon.size() < 3)
        throw InputError(fmt::format("{}: line {}: a face of {} corners", name, line, polygon.size()));
      for (std::size_t k = 2; k < polygon.size(); ++k) s.triangles.push_back({polygon[0], polygon[k - 1], polygon[k]});
    } else {
      if (w.size() < 3) throw InputError(fmt::format("{}: line {}: a node of {} numbers", name, line, w.size()));
      w.resize(3);  // colours may follow
      const auto x = numbers(fmt::format("{}", fmt::join(w, " ")), 3, fmt::format("line {}", line), name);
      s.nodes.emplace_back(x[0], x[1], x[2]);
    }
  }
  return s;
}

}  // namespace carus::imaging
