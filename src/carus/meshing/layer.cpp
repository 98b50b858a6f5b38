// SPDX-License-Identifier: Apache-2.0
#include "carus/meshing/layer.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <unordered_map>

#include "carus/core/error.hpp"

namespace carus::meshing {
namespace {

/// Diagonals of the prisms' sides start at the end that comes first in any total order; a scrambled one has no
/// handedness, while the order of numbering would wind all diagonals of a tube the same way.
std::uint32_t scrambled(std::int32_t i) {
  auto h = static_cast<std::uint32_t>(i) * 2654435761u;
  h ^= h >> 15;
  h *= 2246822519u;
  return h ^ (h >> 13);  // a bijection: no ties
}

/// Three tets of the prism over (a,b,c), whose copies are (A,B,C); a comes first in the order.
std::array<mesh::Tet, 3> split(std::int32_t a, std::int32_t b, std::int32_t c, std::int32_t A, std::int32_t B,
                               std::int32_t C) {
  if (scrambled(b) < scrambled(c)) return {{{a, b, c, C}, {a, b, C, B}, {a, B, C, A}}};
  return {{{a, b, c, B}, {a, c, C, B}, {a, B, C, A}}};
}

}  // namespace

mesh::Triangles add_layer(mesh::TetMesh& m, const mesh::Triangles& surface, const Outward& outward,
                          const std::function<std::int32_t(const Vec3&)>& label) {
  std::unordered_map<std::int32_t, std::int32_t> copy;
  for (const auto i : mesh::nodes_of(surface)) {
    copy[i] = static_cast<std::int32_t>(m.nodes.size());
    m.nodes.push_back(outward(m.nodes[i]));
  }
  mesh::Triangles outer;
  for (auto t : surface) {
    outer.push_back({copy[t[0]], copy[t[1]], copy[t[2]]});
    std::rotate(t.begin(),
                std::min_element(t.begin(), t.end(), [](auto i, auto j) { return scrambled(i) < scrambled(j); }),
                t.end());
    Vec3 centre = Vec3::Zero();
    for (const auto i : t) centre += (m.nodes[i] + m.nodes[copy[i]]) / 6;
    for (const auto& tet : split(t[0], t[1], t[2], copy[t[0]], copy[t[1]], copy[t[2]])) {
      m.tets.push_back(tet);
      m.labels.push_back(label(centre));
      if (mesh::volume(m, m.tets.size() - 1) <= 0)
        throw NumericalFailure(fmt::format(
            "meshing: a prism of {} turns over at ({:.1f}, {:.1f}, {:.1f}) mm: the wall is thicker than the "
            "surface's radius of curvature there, or the mesh too fine for it",
            label(centre), centre.x() * 1e3, centre.y() * 1e3, centre.z() * 1e3));
    }
  }
  return outer;
}

}  // namespace carus::meshing
