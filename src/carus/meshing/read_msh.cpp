// SPDX-License-Identifier: Apache-2.0
#include "carus/meshing/read_msh.hpp"

#include <fmt/format.h>
#include <gmsh.h>

#include <map>
#include <stdexcept>

#include "carus/core/error.hpp"

namespace carus::meshing {
namespace {

namespace fs = std::filesystem;
constexpr int tetrahedron = 4, triangle = 2;  // gmsh's numbers of the linear ones

/// gmsh, open as long as it lives.
class Session {
 public:
  Session() {
    gmsh::initialize(0, nullptr, false);
    gmsh::option::setNumber("General.Terminal", 0);
  }
  ~Session() { gmsh::finalize(); }
  Session(const Session&) = delete;
  Session& operator=(const Session&) = delete;
};

class MshFile {
 public:
  explicit MshFile(fs::path file) : file_(std::move(file)) {
    if (!fs::is_regular_file(file_)) refuse("no such file");
    gmsh::open(file_.string());
  }

  mesh::NamedMesh read() {
    mesh::NamedMesh m;
    read_nodes(m);
    read_volumes(m);
    read_groups(m);
    return m;
  }

  [[noreturn]] void refuse(const std::string& what) const {
    throw InputError(fmt::format("{}: {}; allowed a gmsh MSH file of linear tetrahedra", file_.string(), what));
  }

 private:
  void read_nodes(mesh::NamedMesh& m) {
    std::vector<std::size_t> tags;
    std::vector<double> x, unused;
    gmsh::model::mesh::getNodes(tags, x, unused);
    for (std::size_t i = 0; i < tags.size(); ++i) {
      node_of_[tags[i]] = std::int32_t(i);
      m.mesh.nodes.emplace_back(x[3 * i], x[3 * i + 1], x[3 * i + 2]);
      if (!m.mesh.nodes.back().allFinite()) refuse(fmt::format("node {} is not finite", tags[i]));
    }
  }

  static std::string name_of(int dimension, int tag) {
    std::string name;
    gmsh::model::getPhysicalName(dimension, tag, name);
    constexpr const char* kind[] = {"point", "curve", "surface", "volume"};
    return name.empty() ? fmt::format("{} {}", kind[dimension], tag) : name;
  }

  /// Corners of the elements of one type of an entity; others than vertices, lines and that one are refused.
  std::vector<std::size_t> corners(int dimension, int entity, int wanted) {
    std::vector<int> types;
    std::vector<std::vector<std::size_t>> elements, nodes;
    gmsh::model::mesh::getElements(types, elements, nodes, dimension, entity);
    std::vector<std::size_t> out;
    for (std::size_t k = 0; k < types.size(); ++k) {
      if (types[k] != wanted)
        refuse(fmt::format("element {} is of gmsh type {}; a linear tetrahedron is 4, a triangle 2",
                           elements[k].empty() ? 0 : elements[k][0], types[k]));
      out.insert(out.end(), nodes[k].begin(), nodes[k].end());
    }
    return out;
  }

  void read_volumes(mesh::NamedMesh& m) {
    std::map<int, std::int32_t> region_of;  // of an entity
    gmsh::vectorpair groups, volumes;
    gmsh::model::getPhysicalGroups(groups, 3);
    for (const auto& [dimension, tag] : groups) {
      std::vector<int> entities;
      gmsh::model::getEntitiesForPhysicalGroup(3, tag, entities);
      for (const int e : entities) {
        if (!region_of.try_emplace(e, std::int32_t(m.regions.size())).second)
          refuse(fmt::format("volume {} is in two physical groups, one of them \"{}\"", e, name_of(3, tag)));
      }
      m.regions.push_back(name_of(3, tag));
    }
    gmsh::model::getEntities(volumes, 3);
    for (const auto& [dimension, entity] : volumes) {
      const auto nodes = corners(3, entity, tetrahedron);
      if (nodes.empty()) continue;
      if (!region_of.contains(entity)) {
        region_of[entity] = std::int32_t(m.regions.size());
        m.regions.emplace_back();
      }
      for (std::size_t i = 0; i + 3 < nodes.size(); i += 4) {
        m.mesh.tets.push_back(
            {node_of_.at(nodes[i]), node_of_.at(nodes[i + 1]), node_of_.at(nodes[i + 2]), node_of_.at(nodes[i + 3])});
        m.mesh.labels.push_back(region_of[entity]);
      }
    }
    if (m.mesh.tets.empty()) refuse("has no tetrahedra");
  }

  void read_groups(mesh::NamedMesh& m) {
    gmsh::vectorpair groups;
    gmsh::model::getPhysicalGroups(groups);
    for (const auto& [dimension, tag] : groups) {
      if (dimension == 2) {
        mesh::NamedSurface s{name_of(2, tag), {}};
        std::vector<int> entities;
        gmsh::model::getEntitiesForPhysicalGroup(2, tag, entities);
        for (const int e : entities) {
          const auto nodes = corners(2, e, triangle);
          for (std::size_t i = 0; i + 2 < nodes.size(); i += 3)
            s.triangles.push_back({node_of_.at(nodes[i]), node_of_.at(nodes[i + 1]), node_of_.at(nodes[i + 2])});
        }
        m.surfaces.push_back(std::move(s));
      } else if (dimension < 2) {
        std::vector<std::size_t> tags;
        std::vector<double> unused;
        gmsh::model::mesh::getNodesForPhysicalGroup(dimension, tag, tags, unused);
        mesh::NamedNodes set{name_of(dimension, tag), {}};
        for (const auto t : tags) set.nodes.push_back(node_of_.at(t));
        m.nodes.push_back(std::move(set));
      }
    }
  }

  fs::path file_;
  std::map<std::size_t, std::int32_t> node_of_;
};

}  // namespace

mesh::NamedMesh read_msh(const fs::path& file) {
  const Session session;
  try {
    return MshFile(file).read();
  } catch (const InputError&) {
    throw;
  } catch (const std::exception& error) {  // gmsh's own
    throw InputError(fmt::format("{}: cannot be read by gmsh ({}); allowed a gmsh MSH file of linear tetrahedra",
                                 file.string(), error.what()));
  }
}

}  // namespace carus::meshing
