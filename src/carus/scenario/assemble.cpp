// SPDX-License-Identifier: Apache-2.0
#include "carus/scenario/assemble.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <set>

#include "carus/core/error.hpp"
#include "carus/scenario/unguided.hpp"

namespace carus::scenario {

namespace {

using anatomy::Anatomy;
using anatomy::Body;
using mesh::Triangles;

bool is_bone(std::int32_t label) { return label >= anatomy::innominate_right && label <= anatomy::coccyx; }

/// Nodes of the tets that have the label.
std::vector<std::int32_t> nodes_with_label(const mesh::TetMesh& m, std::int32_t label) {
  std::set<std::int32_t> nodes;
  for (std::size_t e = 0; e < m.tets.size(); ++e)
    if (m.labels[e] == label) nodes.insert(m.tets[e].begin(), m.tets[e].end());
  return {nodes.begin(), nodes.end()};
}

mesh::Triangle sorted(mesh::Triangle t) {
  std::sort(t.begin(), t.end());
  return t;
}

/// `triangles` that are (or are not) among `others`, whatever their orientation.
Triangles filtered(const Triangles& triangles, const Triangles& others, bool among) {
  std::set<mesh::Triangle> known;
  for (const mesh::Triangle& t : others) known.insert(sorted(t));
  Triangles out;
  for (const mesh::Triangle& t : triangles)
    if (known.contains(sorted(t)) == among) out.push_back(t);
  return out;
}

/// Neck: the tets of the body, and of the skin over them, within half the way to the shoulders from the head's upper
/// end, along the axis of the fetus.
class Neck {
 public:
  explicit Neck(const Anatomy& a) {
    const auto head = a.landmarks.find("head_centre"), neck = a.landmarks.find("neck"),
               right = a.landmarks.find("shoulder_right"), left = a.landmarks.find("shoulder_left");
    const auto end = a.landmarks.end();
    if (head == end || neck == end || right == end || left == end) return;
    const Vec3 shoulders = (right->second + left->second) / 2;
    at_ = neck->second;
    axis_ = (neck->second - head->second).normalized();
    half_ = std::abs((shoulders - at_).dot(axis_)) / 2;
    const auto& m = a.fetus.mesh;
    trunk_.assign(m.nodes.size(), false), skull_.assign(m.nodes.size(), false);
    for (std::size_t e = 0; e < m.tets.size(); ++e)
      for (const std::int32_t n : m.tets[e]) {
        if (m.labels[e] == anatomy::fetal_body) trunk_[n] = true;
        if (m.labels[e] == anatomy::skull) skull_[n] = true;
      }
  }
  [[nodiscard]] bool contains(const mesh::TetMesh& m, std::size_t tet) const {
    Vec3 centre = Vec3::Zero();
    for (const std::int32_t n : m.tets[tet]) centre += m.nodes[n] / 4;
    if (std::abs((centre - at_).dot(axis_)) >= half_) return false;
    if (m.labels[tet] == anatomy::fetal_body) return true;
    // Skin over the neck: joins the trunk and no part of the skull.
    if (m.labels[tet] != anatomy::fetal_skin) return false;
    const auto& t = m.tets[tet];
    return std::any_of(t.begin(), t.end(), [&](std::int32_t n) { return trunk_[n]; }) &&
           std::none_of(t.begin(), t.end(), [&](std::int32_t n) { return skull_[n]; });
  }

 private:
  Vec3 at_ = Vec3::Zero(), axis_ = Vec3::Zero();
  double half_ = 0;
  std::vector<bool> trunk_, skull_;  ///< per node of the fetus: in a tet of that label
};

class Assembler {
 public:
  Assembler(const Scenario& s, const Anatomy& a) : s_(s), a_(a) {}

  Assembly run() {
    for (const Body* body : {&a_.fetus, &a_.uterus, &a_.abdomen}) append(*body);
    require();
    model().blocked.assign(model().mesh.nodes.size(), fem::Blocked::none);
    attachments();
    bones();
    ties();
    canal_bed();
    loads();
    contacts();
    retraction();
    fibres();
    landmarks();
    return std::move(out_);
  }

 private:
  fem::Model& model() { return out_.model; }

  std::int32_t region(const std::string& name, const std::string& organ, const std::string& material, bool rigid) {
    auto& regions = model().regions;
    const auto it = std::find_if(regions.begin(), regions.end(), [&](const fem::Region& r) { return r.name == name; });
    if (it != regions.end()) return static_cast<std::int32_t>(it - regions.begin());
    const auto& m = s_.materials.at(material);
    regions.push_back({.name = name, .organ = organ, .material = m, .rigid = rigid, .fibres = m.fibre_k1 > 0});
    return static_cast<std::int32_t>(regions.size()) - 1;
  }

  std::int32_t region_of(const Body& body, std::size_t tet, const Neck& neck) {
    const std::int32_t label = body.mesh.labels[tet];
    const std::string name = anatomy::name_of(label);
    if (is_bone(label))
      return region(name, body.name, "bone", label != anatomy::coccyx || s_.coccyx.model != CoccyxModel::elastic);
    if ((label == anatomy::fetal_body || label == anatomy::fetal_skin) && neck.contains(body.mesh, tet))
      return region("neck", body.name, "neck", false);
    if (!s_.materials.contains(name))
      throw InputError(
          fmt::format("anatomy: {}: label {} has no material; allowed the regions of materials", body.name, label));
    return region(name, body.name, name, false);
  }

  void append(const Body& body) {
    auto& m = model().mesh;
    BodyRange range;
    range.node_begin = static_cast<std::int32_t>(m.nodes.size());
    range.tet_begin = static_cast<std::int32_t>(m.tets.size());
    m.nodes.insert(m.nodes.end(), body.mesh.nodes.begin(), body.mesh.nodes.end());
    const Neck neck(a_);
    for (std::size_t e = 0; e < body.mesh.tets.size(); ++e) {
      mesh::Tet tet = body.mesh.tets[e];
      for (std::int32_t& n : tet) n += range.node_begin;
      m.tets.push_back(tet);
      m.labels.push_back(region_of(body, e, neck));
    }
    range.node_end = static_cast<std::int32_t>(m.nodes.size());
    range.tet_end = static_cast<std::int32_t>(m.tets.size());
    for (const mesh::NamedNodes& set : body.nodes) {
      auto& nodes = out_.node_sets[body.name + "." + set.name];
      for (const std::int32_t n : set.nodes) nodes.push_back(n + range.node_begin);
    }
    for (const mesh::NamedSurface& surface : body.surfaces)
      out_.surfaces[body.name + "." + surface.name] = shifted(surface.triangles, range);
    out_.bodies[body.name] = range;
  }

  static Triangles shifted(Triangles triangles, const BodyRange& range) {
    for (mesh::Triangle& t : triangles)
      for (std::int32_t& n : t) n += range.node_begin;
    return triangles;
  }

  void require() const {
    std::vector<std::string> problems;
    for (const char* name : {"fetus.skin", "uterus.inner", "uterus.outer", "uterus.contraction", "uterus.push",
                             "uterus.tone", "abdomen.cavity"})
      if (const auto it = out_.surfaces.find(name); it == out_.surfaces.end() || it->second.empty())
        problems.push_back(fmt::format("anatomy: {}: no such surface, or it is empty; the model needs it", name));
    for (const char* name : {"uterus.vaginal_canal", "uterus.lower_uterus_tie", "abdomen.back", "abdomen.thighs"})
      if (const auto it = out_.node_sets.find(name); it == out_.node_sets.end() || it->second.empty())
        problems.push_back(fmt::format("anatomy: {}: no such set of nodes, or it is empty; the model needs it", name));
    if (s_.coccyx.model == CoccyxModel::hinge && !a_.landmarks.contains("coccyx_hinge"))
      problems.push_back(
          "anatomy: coccyx_hinge: no such landmark; coccyx.model hinge needs it; set coccyx.model to elastic or fixed");
    if (s_.retraction.enabled && a_.uterine_wall.size() != a_.uterus.mesh.tets.size())
      problems.push_back(fmt::format(
          "anatomy: uterine_wall: {} frames; allowed one per element of the uterus, {}; retraction needs them",
          a_.uterine_wall.size(), a_.uterus.mesh.tets.size()));
    if (!problems.empty()) throw InputError(problems);
  }

  [[nodiscard]] std::vector<std::int32_t> set_or_empty(const std::string& name) const {
    const auto it = out_.node_sets.find(name);
    return it == out_.node_sets.end() ? std::vector<std::int32_t>{} : it->second;
  }

  void block(const std::vector<std::int32_t>& nodes, std::uint8_t bits) {
    for (const std::int32_t n : nodes) model().blocked[n] |= bits;
  }

  /// The paper, section 3.4: birth chair and thighs; the canal moves only in its transverse plane, which turns with its
  /// axis, so that the vulva may stretch. Not so the bend's inner side, where the planes run together and what is held
  /// between them would be crushed as the head opens the canal.
  void attachments() {
    for (const char* name : {"abdomen.back", "abdomen.thighs"}) block(set_or_empty(name), fem::Blocked::all);
    if (!s_.attachments.canal_blocked) return;
    auto& direction = model().blocked_direction;
    direction.assign(model().mesh.nodes.size(), Vec3::Zero());
    const anatomy::CanalAxis axis(a_.parameters.canal);
    for (const char* name : {"uterus.vaginal_canal", "abdomen.canal"})
      for (const std::int32_t n : set_or_empty(name))
        if (!axis.inside_bend(model().mesh.nodes[n])) direction[n] = axis.tangent(axis.nearest(model().mesh.nodes[n]));
  }

  void bones() {
    const BodyRange& range = out_.bodies.at(a_.abdomen.name);
    const auto nodes_of_bone = [&](std::int32_t label) {
      std::vector<std::int32_t> nodes = nodes_with_label(a_.abdomen.mesh, label);
      for (std::int32_t& n : nodes) n += range.node_begin;
      return nodes;
    };
    for (const std::int32_t label : {anatomy::innominate_right, anatomy::innominate_left, anatomy::sacrum})
      block(nodes_of_bone(label), fem::Blocked::all);
    std::vector<std::int32_t> coccyx = nodes_of_bone(anatomy::coccyx);
    if (s_.coccyx.model == CoccyxModel::fixed) block(coccyx, fem::Blocked::all);
    if (s_.coccyx.model != CoccyxModel::hinge || coccyx.empty()) return;
    // Shared with the sacrum, or held by the chair: not the hinge's to move.
    std::erase_if(coccyx, [&](std::int32_t n) { return model().blocked[n] == fem::Blocked::all; });
    fem::Hinge hinge{.name = "coccyx",
                     .nodes = std::move(coccyx),
                     .point = a_.landmarks.at("coccyx_hinge"),
                     .axis = Vec3::UnitX(),
                     .stiffness = s_.coccyx.stiffness,
                     .damping = s_.coccyx.damping,
                     .inertia = 0};
    hinge.inertia = inertia(hinge);
    for (const std::int32_t n : hinge.nodes)
      model().blocked[n] = fem::Blocked::none;  // the hinge moves them, nothing else holds them
    model().hinges.push_back(std::move(hinge));
  }

  /// About the hinge's axis, of the coccyx' mass lumped at its nodes: sum over tets of rho V/4 r^2.
  [[nodiscard]] double inertia(const fem::Hinge& hinge) const {
    double sum = 0;
    for (std::size_t e = 0; e < a_.abdomen.mesh.tets.size(); ++e) {
      if (a_.abdomen.mesh.labels[e] != anatomy::coccyx) continue;
      const double share = s_.materials.at("bone").density * mesh::volume(a_.abdomen.mesh, e) / 4;
      for (const std::int32_t n : a_.abdomen.mesh.tets[e])
        sum += share * (a_.abdomen.mesh.nodes[n] - hinge.point).cross(hinge.axis).squaredNorm();
    }
    return sum;
  }

  /// Ligaments: the total stiffness, shared out by the wall's volume at each tied node so that the mesh does not
  /// matter.
  void ties() {
    const std::vector<std::int32_t> tied = set_or_empty("uterus.lower_uterus_tie");
    std::map<std::int32_t, double> share;
    for (const std::int32_t n : tied) share[n] = 0;
    const BodyRange& range = out_.bodies.at(a_.uterus.name);
    double total = 0;
    for (std::int32_t e = range.tet_begin; e < range.tet_end; ++e)
      for (const std::int32_t n : model().mesh.tets[e])
        if (const auto it = share.find(n); it != share.end()) {
          const double part = mesh::volume(model().mesh, e) / 4;
          it->second += part;
          total += part;
        }
    const Vec3 stiffness(s_.attachments.tie_transverse, s_.attachments.tie_transverse, s_.attachments.tie_axial);
    for (const auto& [node, part] : share)
      for (int k = 0; k < 3; ++k) model().tethers.push_back({node, Vec3::Unit(k), part / total * stiffness[k]});
  }

  /// The bed of canal and floor, by the area of their outer face at each node: towards the front behind the axis, along
  /// x all round. Where the canal is narrow, its bed is deeper by as much, and softer in proportion.
  void canal_bed() {
    const auto outer = out_.surfaces.find("uterus.outer");
    const double posterior = s_.attachments.bed_posterior, lateral = s_.attachments.bed_lateral;
    if (outer == out_.surfaces.end() || (posterior == 0 && lateral == 0)) return;
    std::map<std::int32_t, double> area;
    for (const std::int32_t n : set_or_empty("uterus.bed")) area[n] = 0;
    for (const mesh::Triangle& t : outer->second) {
      const Vec3 u = model().mesh.nodes[t[1]] - model().mesh.nodes[t[0]],
                 w = model().mesh.nodes[t[2]] - model().mesh.nodes[t[0]];
      for (const std::int32_t n : t)
        if (const auto it = area.find(n); it != area.end()) it->second += u.cross(w).norm() / 6;
    }
    const anatomy::CanalAxis axis(a_.parameters.canal);
    for (const auto& [node, a] : area) {
      if (a == 0) continue;
      const Vec3& x = model().mesh.nodes[node];
      const double s = axis.nearest(x), depth = s_.attachments.bed_depth;
      const double narrowed = axis.radius(0) - axis.radius(s), forward = (axis.centre(s) - axis.point(s)).norm();
      const Vec3 front = axis.tangent(s).cross(Vec3::UnitX());
      model().tethers.push_back({node, Vec3::UnitX(), a * lateral * depth / (depth + narrowed)});
      if ((x - axis.centre(s)).dot(front) < 0)
        model().tethers.push_back({node, front, a * posterior * depth / (depth + narrowed + forward)});
    }
  }

  void loads() {
    const Loads& l = s_.loads;
    const auto surface = [&](const std::string& region) { return out_.surfaces.at("uterus." + region); };
    model().pressures.push_back(
        {.name = "contraction", .surface = surface(l.contractions_region), .pressure = [c = l.contractions](double t) {
           return labour::contraction_pressure(c, t);
         }});
    // The push goes along the canal's axis at the inlet, straight down.
    model().pressures.push_back(
        {.name = "push",
         .surface = surface(l.push_region),
         .pressure = [p = l.push, c = l.contractions](double t) { return labour::push_pressure(p, c, t); },
         .directed = l.push.directed,
         .direction = -Vec3::UnitZ()});
    model().pressures.push_back({.name = "tone",
                                 .surface = surface(l.residual_tone_region),
                                 .pressure = [r = l.residual_tone](double t) { return labour::tone_pressure(r, t); }});
  }

  /// The named surface of the abdomen, or, where the anatomy has none, the outer facets of its bones' tets.
  [[nodiscard]] Triangles bone_surface(const std::string& name, const std::function<bool(std::int32_t)>& labels) const {
    if (const auto it = out_.surfaces.find("abdomen." + name); it != out_.surfaces.end()) return it->second;
    const Triangles exposed = filtered(mesh::boundary(a_.abdomen.mesh, labels), mesh::boundary(a_.abdomen.mesh), true);
    return shifted(exposed, out_.bodies.at(a_.abdomen.name));
  }

  int surface(const std::string& name, Triangles triangles) {
    if (triangles.empty()) return -1;
    model().contact_surfaces.push_back({name, std::move(triangles)});
    return static_cast<int>(model().contact_surfaces.size()) - 1;
  }

  void contacts() {
    // Cavity, bones and coccyx in one: a surface that ends where another goes on lets nodes slip in between.
    Triangles abdomen = out_.surfaces.at("abdomen.cavity");
    const auto join = [&](const Triangles& more) {
      const Triangles fresh = filtered(more, abdomen, false);
      abdomen.insert(abdomen.end(), fresh.begin(), fresh.end());
    };
    join(bone_surface("bone", [](std::int32_t l) { return is_bone(l) && l != anatomy::coccyx; }));
    join(bone_surface("coccyx", [](std::int32_t l) { return l == anatomy::coccyx; }));
    const int skin = surface("skin", out_.surfaces.at("fetus.skin"));
    // Inside, outside and rim in one: which side a facet faces tells which body it can touch.
    const int uterus = surface("uterus", shifted(mesh::boundary(a_.uterus.mesh), out_.bodies.at(a_.uterus.name)));
    const int hard = surface("abdomen", abdomen);
    const auto pair = [&](int a, int b) {
      if (a >= 0 && b >= 0) model().contact_pairs.push_back({a, b, s_.contact.friction});
    };
    pair(skin, uterus);
    pair(uterus, hard);
    // The fundus folds behind the breech and may follow it into the canal; the floor's layers cannot meet each other.
    const Triangles floor = mesh::boundary(a_.uterus.mesh, [](std::int32_t l) { return l > anatomy::vaginal_canal; });
    const int wall = surface("wall", filtered(shifted(mesh::boundary(a_.uterus.mesh), out_.bodies.at(a_.uterus.name)),
                                              shifted(floor, out_.bodies.at(a_.uterus.name)), false));
    pair(wall, wall);
    pair(skin, hard);  // below the vulva
  }

  void retraction() {
    const Retraction& from = s_.retraction;
    if (!from.enabled) return;
    fem::Retraction& r = model().retraction;
    r.kind = from.kind;
    const BodyRange& range = out_.bodies.at(a_.uterus.name);
    for (std::size_t e = 0; e < a_.uterus.mesh.tets.size(); ++e) {
      const std::int32_t label = a_.uterus.mesh.labels[e];
      const double strength = label == anatomy::uterine_fundus || label == anatomy::uterine_body ? 1
                              : label == anatomy::lower_segment ? from.lower_segment_strength
                                                                : 0;
      if (strength <= 0) continue;
      const anatomy::WallFrame& wall = a_.uterine_wall[e];
      r.elements.push_back(range.tet_begin + static_cast<std::int32_t>(e));
      r.meridian.push_back(wall.meridian);
      r.normal.push_back(wall.normal);
      r.dome.push_back(wall.dome);
      r.s.push_back(wall.s);
      r.strength.push_back(strength);
    }
    r.ring_width = from.ring_width;
    r.tau = from.tau, r.isometric_strain = from.isometric_strain;
    r.floor = from.floor;
    r.imposed = [end = from.final, duration = s_.numerics.labour_duration](double t) {
      return 1 + (end - 1) * std::clamp(t / duration, 0.0, 1.0);
    };
    r.activity = [c = s_.loads.contractions](double t) { return labour::contraction_activity(c, t); };
  }

  /// Muscle fibres of the uterus run along the meridians.
  void fibres() {
    const auto& regions = model().regions;
    if (std::none_of(regions.begin(), regions.end(), [](const fem::Region& r) { return r.fibres; })) return;
    if (a_.uterine_wall.size() != a_.uterus.mesh.tets.size())
      throw InputError("anatomy: uterine_wall: no frames; materials with fibres need one per element of the uterus");
    model().fibre.assign(model().mesh.tets.size(), Vec3::Zero());
    const BodyRange& range = out_.bodies.at(a_.uterus.name);
    for (std::size_t e = 0; e < a_.uterine_wall.size(); ++e)
      model().fibre[range.tet_begin + e] = a_.uterine_wall[e].meridian;
  }

  void landmarks() {
    for (const auto& [body, range] : out_.bodies)
      for (const auto& [name, point] : a_.landmarks) {
        std::int32_t nearest = range.node_begin;
        for (std::int32_t n = range.node_begin; n < range.node_end; ++n)
          if ((model().mesh.nodes[n] - point).squaredNorm() < (model().mesh.nodes[nearest] - point).squaredNorm())
            nearest = n;
        if (range.node_begin < range.node_end) out_.nodes[body + "." + name] = nearest;
      }
  }

  const Scenario& s_;
  const Anatomy& a_;
  Assembly out_;
};

}  // namespace

Assembly assemble(const Scenario& scenario, const Anatomy& anatomy) {
  auto assembly = Assembler(scenario, anatomy).run();
  if (const auto problems = guided_fetus(assembly.model); !problems.empty()) throw InputError(problems);
  return assembly;
}

}  // namespace carus::scenario
