// SPDX-License-Identifier: Apache-2.0
#include "carus/general/build.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <set>

#include "carus/core/error.hpp"
#include "carus/mesh/closest_point.hpp"
#include "carus/scenario/schema.hpp"
#include "carus/scenario/text.hpp"
#include "carus/scenario/unguided.hpp"

namespace carus::general {
namespace {

using scenario::ModelScenario;
using Nodes = std::vector<std::int32_t>;

bool inside(const ModelScenario::Box& box, const Vec3& x) {
  // A nanometre of slack: coordinates in mm are no exact metres.
  return ((x - box.low).array() > -1e-9).all() && ((box.high - x).array() > -1e-9).all();
}

class Builder {
 public:
  Builder(const ModelScenario& scenario, mesh::NamedMesh meshes) : s_(scenario), in_(std::move(meshes)) {}

  GeneralModel build() {
    check_shapes();
    take_regions();
    name_sets();
    if (problems_.empty()) {
      hold_rigid_regions();
      take_constraints();
      take_loads();
      take_contact();
      take_ties();
      watch();
      for (const auto& problem : scenario::guided_fetus(out_.model)) refuse("motions", problem);
    }
    if (!problems_.empty()) throw InputError(problems_);
    return std::move(out_);
  }

 private:
  void refuse(const std::string& key, const std::string& what) {
    problems_.push_back(fmt::format("{}: {}: {}", s_.file, key, what));
  }

  void check_shapes() {
    std::size_t bad = 0, first = 0;
    for (std::size_t e = 0; e < in_.mesh.tets.size(); ++e) {
      if (mesh::volume(in_.mesh, e) > 0) continue;
      if (bad++ == 0) first = e;
    }
    if (bad > 0)
      refuse("meshes", fmt::format("{} elements have no volume, the first is {} ({}); mesh again", bad, first,
                                   in_.regions[std::size_t(in_.mesh.labels[first])]));
    std::vector<bool> used(in_.mesh.nodes.size(), false);
    for (const auto& t : in_.mesh.tets) {
      for (const auto n : t) used[std::size_t(n)] = true;
    }
    drop_unused(used);
  }

  /// Nodes of no tet (gmsh keeps the points of its geometry) have no mass: they go.
  void drop_unused(const std::vector<bool>& used) {
    Nodes to(used.size(), -1);
    std::vector<Vec3> kept;
    for (std::size_t i = 0; i < used.size(); ++i) {
      if (used[i]) to[i] = std::int32_t(kept.size()), kept.push_back(in_.mesh.nodes[i]);
    }
    if (kept.size() == used.size()) return;
    in_.mesh.nodes = std::move(kept);
    for (auto& t : in_.mesh.tets) {
      for (auto& n : t) n = to[std::size_t(n)];
    }
    for (auto& set : in_.nodes) {
      for (auto& n : set.nodes) n = to[std::size_t(n)];
      std::erase(set.nodes, -1);
    }
    for (auto& s : in_.surfaces) {
      for (auto& t : s.triangles) {
        for (auto& n : t) n = to[std::size_t(n)];
      }
      std::erase_if(s.triangles, [](const auto& t) { return t[0] < 0 || t[1] < 0 || t[2] < 0; });
    }
  }

  void take_regions() {
    auto& m = out_.model;
    m.mesh = in_.mesh;
    m.blocked.assign(m.mesh.nodes.size(), fem::none);
    for (const auto& name : in_.regions) {
      const auto it = std::find_if(s_.regions.begin(), s_.regions.end(), [&](const auto& r) { return r.name == name; });
      if (it == s_.regions.end())
        refuse("regions",
               fmt::format("silent about \"{}\", which the meshes have; add an item with its material", name));
      fem::Region region;
      region.name = region.organ = name;
      if (it != s_.regions.end()) region.material = it->material, region.rigid = it->rigid;
      m.regions.push_back(std::move(region));
    }
    for (const auto& r : s_.regions) {
      if (std::find(in_.regions.begin(), in_.regions.end(), r.name) == in_.regions.end())
        refuse("regions", fmt::format("\"{}\" is in no mesh; allowed {}", r.name, scenario::enumerated(in_.regions)));
    }
  }

  void add_nodes(const std::string& key, const std::string& name, Nodes nodes) {
    std::sort(nodes.begin(), nodes.end());
    nodes.erase(std::unique(nodes.begin(), nodes.end()), nodes.end());
    if (nodes.empty())
      refuse(key, fmt::format("\"{}\" has no nodes; look at its box and at the unit of the mesh", name));
    if (!nodes_.emplace(name, std::move(nodes)).second)
      refuse(key, fmt::format("\"{}\" is a name twice; regions, surfaces and node sets share their names", name));
  }

  void add_surface(const std::string& key, const std::string& name, mesh::Triangles triangles) {
    add_nodes(key, name, mesh::nodes_of(triangles));
    surfaces_.emplace(name, std::move(triangles));
  }

  void name_sets() {
    const auto& mesh = out_.model.mesh;
    for (std::size_t r = 0; r < in_.regions.size(); ++r) {
      Nodes nodes;
      for (std::size_t e = 0; e < mesh.tets.size(); ++e) {
        if (mesh.labels[e] == std::int32_t(r)) nodes.insert(nodes.end(), mesh.tets[e].begin(), mesh.tets[e].end());
      }
      add_nodes("meshes", in_.regions[r], std::move(nodes));
    }
    for (const auto& s : in_.surfaces) add_surface("meshes", s.name, s.triangles);
    for (const auto& set : in_.nodes) add_nodes("meshes", set.name, set.nodes);
    for (const auto& s : s_.surfaces) {
      mesh::Triangles of = s.region.empty() ? mesh::boundary(mesh) : mesh::Triangles{};
      if (!s.region.empty()) {
        const auto label = region("surfaces.region", s.region);
        of = mesh::boundary(mesh, [label](std::int32_t l) { return l == label; });
      }
      std::erase_if(of, [&](const auto& t) {
        return !std::all_of(t.begin(), t.end(), [&](auto n) { return inside(s.box, mesh.nodes[n]); });
      });
      add_surface("surfaces", s.name, std::move(of));
    }
    for (const auto& set : s_.node_sets) {
      Nodes nodes;
      for (const auto n : set.nodes.empty() ? all_nodes() : named("node_sets.nodes", set.nodes)) {
        if (inside(set.box, mesh.nodes[n])) nodes.push_back(n);
      }
      add_nodes("node_sets", set.name, std::move(nodes));
    }
  }

  [[nodiscard]] Nodes all_nodes() const {
    Nodes nodes(out_.model.mesh.nodes.size());
    for (std::size_t i = 0; i < nodes.size(); ++i) nodes[i] = std::int32_t(i);
    return nodes;
  }

  template <class T>
  const T* find(const std::map<std::string, T>& in, const std::string& key, const std::string& name, const char* what) {
    const auto it = in.find(name);
    if (it != in.end()) return &it->second;
    std::vector<std::string> names;
    for (const auto& [known, unused] : in) names.push_back(known);
    refuse(key, names.empty() ? fmt::format("no {} \"{}\"; there is none", what, name)
                              : fmt::format("no {} \"{}\"; did you mean \"{}\"? There are {}", what, name,
                                            scenario::nearest_word(name, names), scenario::enumerated(names)));
    return nullptr;
  }

  Nodes named(const std::string& key, const std::string& name) {
    const Nodes* nodes = find(nodes_, key, name, "node set, surface or region");
    return nodes == nullptr ? Nodes{} : *nodes;
  }
  mesh::Triangles surface(const std::string& key, const std::string& name) {
    const mesh::Triangles* s = find(surfaces_, key, name, "surface");
    return s == nullptr ? mesh::Triangles{} : *s;
  }
  std::int32_t region(const std::string& key, const std::string& name) {
    const auto it = std::find(in_.regions.begin(), in_.regions.end(), name);
    if (it == in_.regions.end())
      refuse(key, fmt::format("no region \"{}\"; allowed {}", name, scenario::enumerated(in_.regions)));
    return std::int32_t(it - in_.regions.begin());
  }

  /// A rigid region that no motion moves is held; one that is moved in part is refused.
  void hold_rigid_regions() {
    auto& m = out_.model;
    for (std::size_t r = 0; r < m.regions.size(); ++r) {
      if (!m.regions[r].rigid) continue;
      const Nodes& own = nodes_.at(m.regions[r].name);
      std::set<std::int32_t> moved;
      bool free_axis = false;
      for (const auto& motion : s_.motions) {
        for (const auto n : named("motions.nodes", motion.nodes)) {
          if (!std::binary_search(own.begin(), own.end(), n)) continue;
          moved.insert(n);
          free_axis |= motion.axes != fem::all;
        }
      }
      if (!moved.empty() && (moved.size() < own.size() || free_axis))
        refuse("motions", fmt::format("the rigid region \"{}\" is moved in part ({} of {} nodes{}); move all its nodes "
                                      "along xyz",
                                      m.regions[r].name, moved.size(), own.size(), free_axis ? ", not all axes" : ""));
      if (moved.empty()) {
        for (const auto n : own) m.blocked[n] = fem::all;
      }
    }
  }

  void take_constraints() {
    auto& m = out_.model;
    for (const auto& f : s_.fixed) {
      for (const auto n : named("fixed.nodes", f.nodes)) m.blocked[n] = std::uint8_t(m.blocked[n] | f.axes);
    }
    std::vector<std::uint8_t> imposed = m.blocked;
    for (const auto& motion : s_.motions) {
      fem::Motion to;
      to.name = motion.name, to.axes = motion.axes, to.point = motion.point, to.axis = motion.axis;
      to.nodes = named("motions.nodes", motion.nodes);
      to.displacement = [u = motion.displacement, c = motion.curve](double t) -> Vec3 { return c(t) * u; };
      if (motion.angle != 0) to.angle = [a = motion.angle, c = motion.curve](double t) { return a * c(t); };
      std::size_t twice = 0;
      for (const auto n : to.nodes) {
        twice += (imposed[n] & motion.axes) != 0;
        imposed[n] = std::uint8_t(imposed[n] | motion.axes);
      }
      if (twice > 0)
        refuse("motions", fmt::format("{} nodes of \"{}\" are fixed, or moved by another motion, along the same axes; "
                                      "take them out of one of them",
                                      twice, motion.nodes));
      m.motions.push_back(std::move(to));
    }
    if (s_.initial_velocities.empty()) return;
    out_.initial_velocity.assign(m.mesh.nodes.size(), Vec3::Zero());
    for (const auto& v : s_.initial_velocities) {
      for (const auto n : named("initial_velocities.nodes", v.nodes)) out_.initial_velocity[n] = v.velocity;
    }
  }

  void take_loads() {
    auto& m = out_.model;
    for (const auto& p : s_.pressures) {
      fem::PressureLoad load;
      load.name = p.name, load.surface = surface("pressures.surface", p.surface);
      load.pressure = [p0 = p.pressure, c = p.curve](double t) { return p0 * c(t); };
      load.directed = p.directed;
      if (p.directed) load.direction = p.direction;
      m.pressures.push_back(std::move(load));
    }
    for (const auto& b : s_.body_forces) {
      fem::BodyForce load;
      load.name = b.name;
      if (!b.region.empty()) load.regions = {region("body_forces.region", b.region)};
      load.acceleration = [a = b.acceleration, c = b.curve](double t) -> Vec3 { return c(t) * a; };
      m.body_forces.push_back(std::move(load));
    }
  }

  int contact_surface(const std::string& key, const std::string& name) {
    auto& all = out_.model.contact_surfaces;
    for (std::size_t i = 0; i < all.size(); ++i) {
      if (all[i].name == name) return int(i);
    }
    all.push_back({name, surface(key, name)});
    return int(all.size()) - 1;
  }

  void take_contact() {
    for (const auto& p : s_.contact_pairs)
      out_.model.contact_pairs.push_back(
          {contact_surface("contact.pairs.a", p.a), contact_surface("contact.pairs.b", p.b), p.friction});
  }

  void take_ties() {
    auto& m = out_.model;
    std::vector<std::uint8_t> role(m.mesh.nodes.size(), 0);  // 1: glued, 2: glued to
    std::set<std::int32_t> in_contact;
    for (const auto& s : m.contact_surfaces) {
      for (const auto& t : s.triangles) in_contact.insert(t.begin(), t.end());
    }
    for (const auto& tie : s_.ties) {
      const auto triangles = surface("ties.surface", tie.surface);
      const Nodes nodes = named("ties.nodes", tie.nodes);
      if (triangles.empty() || nodes.empty()) continue;
      std::size_t glued = 0, touching = 0, held = 0, chained = 0;
      for (const auto n : nodes) {
        double least = tie.tolerance;
        fem::Tie best{-1, {}, {}};
        for (const auto& t : triangles) {
          if (std::find(t.begin(), t.end(), n) != t.end()) continue;
          const auto& X = m.mesh.nodes;
          const Vec3 w = mesh::closest_point_weights(X[n], X[t[0]], X[t[1]], X[t[2]]);
          const double d = (w[0] * X[t[0]] + w[1] * X[t[1]] + w[2] * X[t[2]] - X[n]).norm();
          if (d <= least) least = d, best = {n, t, w};
        }
        if (best.node < 0) continue;
        ++glued;
        touching += in_contact.contains(n);
        held += m.blocked[n] != 0;
        chained +=
            role[n] != 0 || std::any_of(best.facet.begin(), best.facet.end(), [&](auto k) { return role[k] == 1; });
        role[n] = 1;
        for (const auto k : best.facet) role[k] = std::uint8_t(role[k] | 2);
        m.ties.push_back(best);
      }
      const auto complain = [&](std::size_t count, const char* what) {
        if (count > 0) refuse("ties", fmt::format("{} nodes of \"{}\" {}", count, tie.nodes, what));
      };
      complain(touching, "are also in contact; leave them out of the contact's surface");
      complain(held, "are fixed too; leave them out of the tie or of fixed");
      complain(chained, "are tied twice, or to nodes that are tied themselves; glue one side to the other only");
      if (glued == 0)
        refuse("ties", fmt::format("no node of \"{}\" is within {:g} mm of \"{}\"; raise the tolerance, or look at the "
                                   "meshes",
                                   tie.nodes, tie.tolerance * 1e3, tie.surface));
      out_.notes.push_back(
          fmt::format("tie: {} of {} nodes of {} glued to {}", glued, nodes.size(), tie.nodes, tie.surface));
    }
    if (!problems_.empty()) return;
    for (const auto& tie : m.ties) {
      Vec3 x = Vec3::Zero();
      for (int k = 0; k < 3; ++k) x += tie.weights[k] * m.mesh.nodes[tie.facet[k]];
      m.mesh.nodes[tie.node] = x;
    }
    for (std::size_t e = 0; !m.ties.empty() && e < m.mesh.tets.size(); ++e) {
      if (mesh::volume(m.mesh, e) <= 0)
        return refuse("ties", fmt::format("moving the glued nodes onto their surface inverts element {}; lower the "
                                          "tolerance",
                                          e));
    }
  }

  void watch() {
    std::vector<std::string> names = s_.output_nodes;
    if (names.empty()) {
      for (const auto& f : s_.fixed) names.push_back(f.nodes);
      for (const auto& m : s_.motions) names.push_back(m.nodes);
      for (const auto& r : s_.regions) {
        if (r.rigid) names.push_back(r.name);
      }
    }
    std::set<std::string> seen;
    for (const auto& name : names) {
      if (seen.insert(name).second) out_.watched.push_back({name, named("output.nodes", name)});
    }
  }

  const ModelScenario& s_;
  mesh::NamedMesh in_;
  GeneralModel out_;
  std::map<std::string, Nodes> nodes_;
  std::map<std::string, mesh::Triangles> surfaces_;
  std::vector<std::string> problems_;
};

}  // namespace

GeneralModel build(const ModelScenario& scenario, mesh::NamedMesh meshes) {
  return Builder(scenario, std::move(meshes)).build();
}

}  // namespace carus::general
