// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include <algorithm>
#include <filesystem>

#include "carus/core/error.hpp"
#include "carus/general/build.hpp"
#include "carus/mesh/shapes.hpp"
#include "carus/results/read_mesh.hpp"
#ifdef CARUS_WITH_MESHING
#include "carus/meshing/read_msh.hpp"
#endif

namespace carus::general {
namespace {

using scenario::ModelScenario;

mesh::NamedMesh read_file(const std::string& file) {
  std::string ending = std::filesystem::path(file).extension().string();
  std::transform(ending.begin(), ending.end(), ending.begin(), [](unsigned char c) { return char(std::tolower(c)); });
  if (ending == ".vtu") return results::read_vtu(file);
#ifdef CARUS_WITH_MESHING
  if (ending == ".msh") return meshing::read_msh(file);
#else
  if (ending == ".msh")
    throw InputError(
        fmt::format("{}: this build has no gmsh (CARUS_MESHING=OFF); allowed .vtu, or configure with "
                    "-DCARUS_MESHING=ON",
                    file));
#endif
  throw InputError(fmt::format("{}: ends in \"{}\"; allowed .vtu, .msh", file, ending));
}

mesh::NamedMesh made(const ModelScenario::Mesh& m) {
  using Shape = ModelScenario::Shape;
  mesh::NamedMesh out;
  const auto& n = m.cells;
  if (m.shape == Shape::box) {
    out.mesh = mesh::shapes::box(m.low, m.size, n[0], n[1], n[2]);
    out.regions = {"box"};
  } else if (m.shape == Shape::ball) {
    out.mesh = mesh::shapes::ball(m.low, m.radius, n[0]);
    out.regions = {"ball"};
  } else {
    out.mesh = mesh::shapes::tube(m.inner_radius, m.radius, 0, m.height, n[0], n[1], n[2]);
    for (Vec3& x : out.mesh.nodes) x += m.low;
    out.regions = {"tube"};
  }
  return out;
}

mesh::NamedMesh one(const ModelScenario::Mesh& m) {
  const bool file = m.shape == ModelScenario::Shape::file;
  mesh::NamedMesh out = file ? read_file(m.file) : made(m);
  if (file) {
    for (Vec3& x : out.mesh.nodes) x = m.unit * x + m.low;
    for (auto& name : out.regions) {
      if (name.empty()) name = m.region.empty() ? std::filesystem::path(m.file).stem().string() : m.region;
    }
  } else if (!m.region.empty()) {
    out.regions = {m.region};
  }
  mesh::orient_tets(out.mesh);
  for (auto& s : out.surfaces) mesh::orient_outward(out.mesh, s.triangles);
  return out;
}

/// Regions of one name are one region.
std::int32_t region_index(std::vector<std::string>& regions, const std::string& name) {
  const auto it = std::find(regions.begin(), regions.end(), name);
  if (it == regions.end()) regions.push_back(name);
  return std::int32_t(std::find(regions.begin(), regions.end(), name) - regions.begin());
}

void append(mesh::NamedMesh& all, mesh::NamedMesh part) {
  const auto offset = std::int32_t(all.mesh.nodes.size());
  std::vector<std::int32_t> label;
  for (const auto& name : part.regions) label.push_back(region_index(all.regions, name));
  for (auto& l : part.mesh.labels) l = label[std::size_t(l)];
  all.mesh = mesh::shapes::join(all.mesh, part.mesh);
  for (auto& set : part.nodes) {
    for (auto& n : set.nodes) n += offset;
    all.nodes.push_back(std::move(set));
  }
  for (auto& s : part.surfaces) {
    for (auto& t : s.triangles) {
      for (auto& n : t) n += offset;
    }
    all.surfaces.push_back(std::move(s));
  }
}

}  // namespace

mesh::NamedMesh gather_meshes(const ModelScenario& scenario) {
  mesh::NamedMesh all;
  std::vector<std::string> problems;
  for (const auto& m : scenario.meshes) {
    try {
      append(all, one(m));
    } catch (const InputError& error) {
      problems.insert(problems.end(), error.problems().begin(), error.problems().end());
    }
  }
  if (!problems.empty()) throw InputError(problems);
  return all;
}

}  // namespace carus::general
