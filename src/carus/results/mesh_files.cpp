// SPDX-License-Identifier: Apache-2.0
#include "carus/results/mesh_files.hpp"

#include <fmt/format.h>
#include <vtkCellData.h>

#include <algorithm>
#include <iterator>
#include <set>

#include "carus/core/error.hpp"
#include "carus/results/export.hpp"
#include "carus/results/files.hpp"
#include "carus/results/vtk_grid.hpp"

namespace carus::results {
namespace {

using Names = std::map<std::int32_t, std::string>;
using Out = std::back_insert_iterator<std::string>;

std::string name_of(const Names& names, std::int32_t label) {
  const auto it = names.find(label);
  std::string n = it == names.end() ? fmt::format("label_{}", label) : it->second;
  std::replace_if(
      n.begin(), n.end(), [](char c) { return std::isalnum(static_cast<unsigned char>(c)) == 0; }, '_');
  return n;
}

/// Facets by the labels on their two sides, 0 outside; each once, outward from the higher label.
std::map<std::pair<std::int32_t, std::int32_t>, mesh::Triangles> interfaces(const mesh::TetMesh& m) {
  std::map<mesh::Triangle, std::pair<std::int32_t, mesh::Triangle>> open;
  std::map<std::pair<std::int32_t, std::int32_t>, mesh::Triangles> found;
  constexpr std::array<std::array<int, 3>, 4> facets{{{1, 2, 3}, {0, 3, 2}, {0, 1, 3}, {0, 2, 1}}};
  for (std::size_t e = 0; e < m.tets.size(); ++e)
    for (const auto& f : facets) {
      const mesh::Triangle t{m.tets[e][f[0]], m.tets[e][f[1]], m.tets[e][f[2]]};
      auto key = t;
      std::sort(key.begin(), key.end());
      const auto [it, fresh] = open.try_emplace(key, m.labels[e], t);
      if (fresh) continue;
      const auto [a, facet_of_a] = it->second;
      const auto b = m.labels[e];
      if (a != b) found[std::minmax(a, b)].push_back(a > b ? facet_of_a : t);
      open.erase(it);
    }
  for (const auto& [key, side] : open) found[{0, side.first}].push_back(side.second);
  return found;
}

std::string msh(const mesh::TetMesh& m, const Names& names) {
  const auto surfaces = interfaces(m);
  const std::set<std::int32_t> labels(m.labels.begin(), m.labels.end());
  std::string text = "$MeshFormat\n2.2 0 8\n$EndMeshFormat\n$PhysicalNames\n";
  Out out(text);
  fmt::format_to(out, "{}\n", surfaces.size() + labels.size());
  int number = 0;
  std::size_t triangles = 0;
  for (const auto& [sides, t] : surfaces) {
    const auto outside = sides.first == 0 ? std::string("outside") : name_of(names, sides.first);
    fmt::format_to(out, "2 {} \"{}_to_{}\"\n", ++number, name_of(names, sides.second), outside);
    triangles += t.size();
  }
  std::map<std::int32_t, int> volumes;
  for (const auto l : labels) fmt::format_to(out, "3 {} \"{}\"\n", volumes[l] = ++number, name_of(names, l));
  fmt::format_to(out, "$EndPhysicalNames\n$Nodes\n{}\n", m.nodes.size());
  for (std::size_t i = 0; i < m.nodes.size(); ++i)
    fmt::format_to(out, "{} {:.9g} {:.9g} {:.9g}\n", i + 1, 1e3 * m.nodes[i].x(), 1e3 * m.nodes[i].y(),
                   1e3 * m.nodes[i].z());
  fmt::format_to(out, "$EndNodes\n$Elements\n{}\n", triangles + m.tets.size());
  std::size_t element = 0;
  number = 0;
  for (const auto& [sides, facets] : surfaces) {
    ++number;
    for (const auto& t : facets)
      fmt::format_to(out, "{} 2 2 {} {} {} {} {}\n", ++element, number, number, t[0] + 1, t[1] + 1, t[2] + 1);
  }
  for (std::size_t e = 0; e < m.tets.size(); ++e) {
    const int v = volumes[m.labels[e]];
    fmt::format_to(out, "{} 4 2 {} {} {} {} {} {}\n", ++element, v, v, m.tets[e][0] + 1, m.tets[e][1] + 1,
                   m.tets[e][2] + 1, m.tets[e][3] + 1);
  }
  return text + "$EndElements\n";
}

std::string inp(const mesh::TetMesh& m, const Names& names) {
  std::string text = "*HEADING\nCarus; millimetres, RAS\n*NODE\n";
  Out out(text);
  for (std::size_t i = 0; i < m.nodes.size(); ++i)
    fmt::format_to(out, "{}, {:.9g}, {:.9g}, {:.9g}\n", i + 1, 1e3 * m.nodes[i].x(), 1e3 * m.nodes[i].y(),
                   1e3 * m.nodes[i].z());
  for (const auto label : std::set<std::int32_t>(m.labels.begin(), m.labels.end())) {
    fmt::format_to(out, "*ELEMENT, TYPE=C3D4, ELSET={}\n", name_of(names, label));
    for (std::size_t e = 0; e < m.tets.size(); ++e)
      if (m.labels[e] == label)
        fmt::format_to(out, "{}, {}, {}, {}, {}\n", e + 1, m.tets[e][0] + 1, m.tets[e][1] + 1, m.tets[e][2] + 1,
                       m.tets[e][3] + 1);
  }
  return text;
}

}  // namespace

void write_mesh(const mesh::TetMesh& m, const Names& names, const std::filesystem::path& file) {
  const auto kind = file.extension();
  if (kind == ".msh") {
    write_atomically(file, msh(m, names));
  } else if (kind == ".inp") {
    write_atomically(file, inp(m, names));
  } else if (kind == ".stl") {
    mesh::Triangles all;
    for (const auto& [sides, t] : interfaces(m)) all.insert(all.end(), t.begin(), t.end());
    write_stl(m, all, file);
  } else if (kind == ".vtu") {
    auto nodes = m.nodes;
    for (auto& x : nodes) x *= 1e3;
    const auto grid = tet_grid(nodes, m.tets);
    set_integers(*grid->GetCellData(), "label", m.labels);
    write_atomically(file, [&](const std::filesystem::path& temporary) { write_vtu(*grid, temporary); });
  } else {
    throw InputError(fmt::format("{}: meshes are written as .vtu, .msh, .inp or .stl", file.string()));
  }
}

}  // namespace carus::results
