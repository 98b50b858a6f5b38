// SPDX-License-Identifier: Apache-2.0
#include "carus/observe/observer.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <limits>

#include "carus/core/error.hpp"
#include "carus/core/units.hpp"
#include "carus/observe/penetration.hpp"
#include "carus/observe/sets.hpp"

namespace carus::observe {
namespace {

constexpr double gap_search = 0.001;  // [m] as far out as the smooth surface may stand from its facets
constexpr double per_mm = 1e3, per_deg = 180 / pi, per_ml = 1e6;

/// What several measurements of one output share.
struct Moment {
  const fem::State& state;
  const solve::Observables& seen;
  const Values* previous;
  Pose head, trunk;
  double s;      // of the head's centre along the canal [m]
  Vec3 tangent;  // there
  Strain::Field strain;
  HeadSkin::Load skin;
  double axial;                   // [N] contact on the fetus along the tangent, net
  std::vector<Penetration> gaps;  // independent check, per pair of bodies
};

double percentile(std::vector<double> v, double share) {
  if (v.empty()) return 0;
  const auto k = std::min(v.size() - 1, std::size_t(share * double(v.size())));
  std::nth_element(v.begin(), v.begin() + std::ptrdiff_t(k), v.end());
  return v[k];
}

}  // namespace

const std::vector<std::string>& required_landmarks() {
  static const std::vector<std::string> names{"occiput",     "sinciput",   "biparietal_right", "biparietal_left",
                                              "spine_right", "spine_left", "vulva_centre",     "vulva_normal"};
  return names;
}

struct Observer::Impl {
  using Measure = std::function<double(const Moment&)>;

  const fem::Model& model;
  Setup setup;
  Strain strain;
  PenetrationCheck penetration;
  Nodes fetus, skull, trunk, coccyx;
  std::vector<std::vector<std::int32_t>> region_tets;
  std::vector<double> region_volume;  // at rest [m^3]
  HeadAxes axes;                      // of the head at rest
  Vec3 trunk_axis;  // at rest: down the canal at the head, so that the attitude begins as the flexion to the canal
  Vec3 spines, spines_normal, vulva, vulva_normal;
  double s_start;
  HeadSkin skin;
  std::vector<std::string> names;
  std::vector<Measure> measures;

  Impl(const fem::Model& m, Setup given)
      : model(m), setup(std::move(given)), strain(m.mesh), penetration(m, gap_search), skin(m.mesh.nodes, {}, {}, {}) {
    check_setup();
    find_sets();
    find_frames();
    add_head();
    add_passage();
    add_occiput();
    add_attitude();
    add_shapes();
    add_loads();
    add_tissue();
    add_energies();
    add_numerics();
  }

  void check_setup() const {
    std::vector<std::string> problems;
    for (const auto& name : required_landmarks()) {
      if (!setup.landmarks.contains(name))
        problems.push_back("anatomy: landmark " + name + ": missing; the measurements need it");
    }
    for (const auto& [what, list] : {std::pair{"head", setup.head_regions}, {"trunk", setup.trunk_regions}}) {
      if (nodes_of(model, tets_of(model, list)).size() < 3) {
        problems.push_back(std::string("model: regions of the ") + what + ": no elements; the pose is fitted to them");
      }
    }
    if (!problems.empty()) throw InputError(problems);
  }

  void find_sets() {
    const auto nodes = [&](const std::vector<std::string>& regions) {
      return nodes_of(model, tets_of(model, regions));
    };
    fetus = nodes(setup.fetal_regions), skull = nodes(setup.head_regions), trunk = nodes(setup.trunk_regions);
    coccyx = nodes({"coccyx"});
    region_tets.resize(model.regions.size());
    for (std::size_t e = 0; e < model.mesh.tets.size(); ++e)
      region_tets[model.mesh.labels[e]].push_back(std::int32_t(e));
    const auto& volume = strain.rest_volume();
    for (const auto& tets : region_tets) {
      double sum = 0;
      for (const auto e : tets) sum += volume[e];
      region_volume.push_back(sum);
    }
    const auto is_fetal = [&](std::int32_t label) {
      const auto& list = setup.fetal_regions;
      return std::find(list.begin(), list.end(), model.regions[label].name) != list.end();
    };
    skin = HeadSkin(model.mesh.nodes, mesh::boundary(model.mesh, is_fetal), skull, trunk);
  }

  void find_frames() {
    const auto& l = setup.landmarks;
    axes = HeadAxes::from(l.at("biparietal_right") - l.at("biparietal_left"), l.at("sinciput") - l.at("occiput"));
    spines = 0.5 * (l.at("spine_right") + l.at("spine_left"));
    spines_normal = setup.canal_tangent(setup.canal_nearest(spines));
    vulva = l.at("vulva_centre"), vulva_normal = l.at("vulva_normal").normalized();
    s_start = setup.canal_nearest(centroid(model.mesh.nodes, skull));
    trunk_axis = setup.canal_tangent(s_start);
  }

  void add(std::string name, Measure measure) {
    names.push_back(std::move(name));
    measures.push_back(std::move(measure));
  }
  [[nodiscard]] std::size_t index(const std::string& name) const {
    const auto it = std::find(names.begin(), names.end(), name);
    CARUS_ASSERT(it != names.end());
    return std::size_t(it - names.begin());
  }
  /// Rate of change of an earlier column since the output before, times `sign` [unit/s of labour].
  void add_rate(const std::string& name, const std::string& of, double sign, const Measure& now) {
    const auto time = index("time_s"), value = index(of);
    add(name, [=](const Moment& m) {
      if (!m.previous) return 0.0;
      const double dt = m.state.time - (*m.previous)[time];
      return dt > 0 ? sign * (now(m) - (*m.previous)[value]) / dt : 0.0;
    });
  }

  void add_head() {
    add("time_s", [](const Moment& m) { return m.state.time; });
    add("contractions_count",
        [c = setup.contractions](const Moment& m) { return double(labour::contractions_begun(c, m.state.time)); });
    for (int k = 0; k < 3; ++k) {
      add(std::string("head_") + "xyz"[k] + "_mm",
          [k](const Moment& m) { return per_mm * (m.head.centre - m.head.rest_centre)[k]; });
    }
    const auto travel = [this](const Moment& m) { return per_mm * (m.s - s_start); };
    add("head_travel_mm", travel);
    add_rate("head_speed_mm_s", "head_z_mm", -1,
             [](const Moment& m) { return per_mm * (m.head.centre - m.head.rest_centre).z(); });
    add_rate("head_path_speed_mm_s", "head_travel_mm", 1, travel);
  }

  void add_passage() {
    const auto lead = [this](const Moment& m) { return most_height(m.state.x, skull, spines, spines_normal); };
    add("station_mm", [=](const Moment& m) { return per_mm * lead(m); });
    add("widest_station_mm", [this](const Moment& m) { return per_mm * (m.head.centre - spines).dot(spines_normal); });
    add("widest_past_inlet_mm", [](const Moment& m) { return -per_mm * m.head.centre.z(); });
    add("widest_past_vulva_mm", [this](const Moment& m) { return per_mm * (m.head.centre - vulva).dot(vulva_normal); });
    add("skull_past_vulva_mm",
        [this](const Moment& m) { return per_mm * least_height(m.state.x, skull, vulva, vulva_normal); });
    add("fetus_past_vulva_mm",
        [this](const Moment& m) { return per_mm * least_height(m.state.x, fetus, vulva, vulva_normal); });
  }

  /// How far the occiput has come below the lower edge of the symphysis, along the canal there: what it pivots under.
  void add_occiput() {
    const auto it = setup.landmarks.find("symphysis_bottom");
    if (it == setup.landmarks.end()) return;
    const Vec3 edge = it->second, down = setup.canal_tangent(setup.canal_nearest(edge));
    add("occiput_below_symphysis_mm", [=, occiput = setup.landmarks.at("occiput")](const Moment& m) {
      const Vec3 now = m.head.centre + m.head.rotation * (occiput - m.head.rest_centre);
      return per_mm * (now - edge).dot(down);
    });
  }

  void add_attitude() {
    const auto head = [this](const Moment& m) { return attitude(axes.turned(m.head.rotation), m.tangent); };
    // The trunk carries its own axis along; the head's angle to it is the attitude of flexion.
    add("flexion_to_trunk_deg", [this](const Moment& m) {
      return per_deg * attitude(axes.turned(m.head.rotation), m.trunk.rotation * trunk_axis).flexion;
    });
    add("flexion_to_canal_deg", [=](const Moment& m) { return per_deg * head(m).flexion; });
    add("occiput_deg", [=](const Moment& m) { return per_deg * head(m).rotation; });
    const double start = attitude(axes, trunk_axis).rotation;
    add("internal_rotation_deg", [=](const Moment& m) { return per_deg * unwrapped(head(m).rotation - start, 0); });
    add("lateral_tilt_deg", [=](const Moment& m) { return per_deg * head(m).tilt; });
    add("trunk_rotation_deg", [=, this](const Moment& m) {
      const Vec3 tangent = setup.canal_tangent(setup.canal_nearest(m.trunk.centre));
      return per_deg * unwrapped(attitude(axes.turned(m.trunk.rotation), tangent).rotation - start, 0);
    });
    for (int k = 0; k < 3; ++k) {
      add(std::string("head_turn_") + "xyz"[k] + "_deg",
          [k](const Moment& m) { return per_deg * rotation_vector(m.head.rotation)[k]; });
    }
  }

  void add_shapes() {
    const auto point = [&](const std::string& name) {
      return setup.nodes.contains(name) ? setup.nodes.at(name).front() : -1;
    };
    const auto fundus = point("point_fundus"), lower = point("point_lower");
    if (fundus >= 0 && lower >= 0) {
      add("uterus_length_mm", [=](const Moment& m) { return per_mm * (m.state.x[fundus] - m.state.x[lower]).norm(); });
    }
    for (const std::string name : {"point_left", "point_right"}) {
      if (const auto n = point(name); n >= 0) {
        add("uterus_" + name.substr(6) + "_x_mm",
            [=, this](const Moment& m) { return per_mm * (m.state.x[n] - model.mesh.nodes[n]).x(); });
      }
    }
    if (coccyx.size() >= 3) {  // backwards is positive: the tip, below the hinge, moves to -y
      add("sacrum_angle_deg", [this](const Moment& m) {
        return -per_deg * rotation_vector(best_fit(model.mesh.nodes, m.state.x, coccyx).rotation).x();
      });
    }
    for (const auto& [name, axis] :
         {std::pair{"occipitofrontal", axes.face}, {"biparietal", axes.right}, {"vertical", axes.vertex}}) {
      const double rest = extent(model.mesh.nodes, skull, axis);
      add(std::string("moulding_") + name + "_mm", [=, this, a = axis](const Moment& m) {
        return per_mm * (extent(m.state.x, skull, m.head.rotation * a) - rest);
      });
    }
    for (std::size_t r = 0; r < model.regions.size(); ++r) {
      if (model.regions[r].rigid || region_tets[r].empty()) continue;
      add("volume_" + model.regions[r].name + "_ml", [=, this](const Moment& m) {
        double sum = 0;
        for (const auto e : region_tets[r]) sum += m.strain.J[e] * strain.rest_volume()[e];
        return per_ml * sum;
      });
    }
    double head_volume = 0;
    const auto head_tets = tets_of(model, setup.head_regions);
    for (const auto e : head_tets) head_volume += strain.rest_volume()[e];
    add("skull_volume_change_percent", [=, this](const Moment& m) {
      double sum = 0;
      for (const auto e : head_tets) sum += m.strain.J[e] * strain.rest_volume()[e];
      return 100 * (sum / head_volume - 1);
    });
  }

  void add_loads() {
    for (std::size_t i = 0; i < model.pressures.size(); ++i) {
      add("pressure_" + model.pressures[i].name + "_mmhg",
          [=](const Moment& m) { return i < m.seen.pressures.size() ? m.seen.pressures[i] / units::mmHg : 0.0; });
    }
    add("expulsive_force_n", [](const Moment& m) { return -m.skin.net.dot(m.tangent); });
    add("axial_contact_force_n", [](const Moment& m) { return m.axial; });
    add("head_contact_force_n", [](const Moment& m) { return m.skin.force; });
    add("head_pressure_mean_kpa", [](const Moment& m) { return m.skin.mean_pressure / units::kPa; });
    add("head_pressure_max_kpa", [](const Moment& m) { return m.skin.max_pressure / units::kPa; });
    add("rest_length_ratio", [](const Moment& m) { return m.seen.rest_length_mean; });
  }

  void add_tissue() {
    for (const auto& [region, name] :
         {std::pair<std::string, std::string>{"levator_ani", "levator"}, {"perineal_body", "perineum"}}) {
      const auto tets = tets_of(model, {region});
      if (tets.empty()) continue;
      const auto stretches = [=](const Moment& m) {
        std::vector<double> v;
        for (const auto e : tets) v.push_back(m.strain.stretch[e]);
        return v;
      };
      add(name + "_stretch_ratio", [=](const Moment& m) { return percentile(stretches(m), 1); });
      add(name + "_stretch_p95_ratio", [=](const Moment& m) { return percentile(stretches(m), 0.95); });
    }
    if (const auto it = setup.nodes.find("hiatus"); it != setup.nodes.end()) {
      const auto axis = setup.canal_tangent(setup.canal_nearest(centroid(model.mesh.nodes, it->second)));
      const Ring ring(model.mesh.nodes, it->second, axis);
      if (const double rest = ring.valid() ? ring.perimeter(model.mesh.nodes) : 0; rest > 0) {
        add("hiatus_perimeter_ratio", [=](const Moment& m) { return ring.perimeter(m.state.x) / rest; });
      }
    }
    if (const auto it = setup.nodes.find("vulva"); it != setup.nodes.end() && !it->second.empty()) {
      const double rest = extent(model.mesh.nodes, it->second, Vec3::UnitX());
      add("vulva_transverse_ratio",
          [=, nodes = it->second](const Moment& m) { return extent(m.state.x, nodes, Vec3::UnitX()) / rest; });
    }
  }

  void add_energies() {
    using O = solve::Observables;
    for (const auto& [name, field] : {std::pair{"kinetic", &O::kinetic},
                                      {"internal", &O::internal},
                                      {"external_work", &O::external_work},
                                      {"contact_work", &O::contact_work},
                                      {"damping_work", &O::damping_work},
                                      {"active_work", &O::active_work},
                                      {"relaxation_work", &O::relaxation_work}}) {
      add(std::string("energy_") + name + "_j", [f = field](const Moment& m) { return m.seen.*f; });
    }
    // What was put in, by loads, contact (what it takes counts negative) and muscle, less what damping took and what is
    // there, by the instantaneous stiffness, of which relaxation spared a part.
    add("energy_imbalance_j", [](const Moment& m) {
      const auto& o = m.seen;
      return o.external_work + o.contact_work + o.active_work + o.relaxation_work - o.damping_work - o.kinetic -
             o.internal;
    });
  }

  void add_numerics() {
    add("time_scaling_ratio", [](const Moment& m) { return m.state.labour_per_pseudo; });
    add("least_gap_mm", [](const Moment& m) { return per_mm * m.seen.least_gap; });
    // Deepest over the pairs of bodies, to flat facets and to the smooth surface; then the latter by pair.
    add("penetration_mm", [](const Moment& m) {
      double deepest = 0;
      for (const auto& p : m.gaps) deepest = std::max(deepest, -p.least_gap);
      return per_mm * deepest;
    });
    add("penetration_smooth_mm", [](const Moment& m) {
      double deepest = 0;
      for (const auto& p : m.gaps) deepest = std::max(deepest, -p.least_smooth_gap);
      return per_mm * deepest;
    });
    const auto pairs = penetration.check(model.mesh.nodes);
    for (std::size_t i = 0; i < pairs.size(); ++i) {
      add("penetration_" + pairs[i].a + "_" + pairs[i].b + "_mm",
          [i](const Moment& m) { return per_mm * std::max(0.0, -m.gaps[i].least_smooth_gap); });
    }
    add("min_J_ratio", [this](const Moment& m) {
      double least = 1;
      for_each_deformable([&](std::int32_t e) { least = std::min(least, m.strain.J[e]); });
      return least;
    });
    add("inverted_count", [this](const Moment& m) {
      int count = 0;
      for_each_deformable([&](std::int32_t e) { count += !(m.strain.J[e] > 0); });
      return double(count);
    });
  }

  /// Elements that carry stress. Those of a rigid body are its picture: where it hinges on another, they overlap.
  template <class F>
  void for_each_deformable(F&& f) const {
    for (std::size_t r = 0; r < region_tets.size(); ++r) {
      if (model.regions[r].rigid) continue;
      for (const auto e : region_tets[r]) f(e);
    }
  }

  [[nodiscard]] Moment moment(const fem::State& state, const solve::Observables& seen, const Values* previous) const {
    const auto& rest = model.mesh.nodes;
    Moment m{state,
             seen,
             previous,
             best_fit(rest, state.x, skull),
             best_fit(rest, state.x, trunk),
             0,
             {},
             strain.field(state.x),
             skin.load(state.x, seen.contact_force),
             0,
             penetration.check(state.x)};
    m.s = setup.canal_nearest(m.head.centre);
    m.tangent = setup.canal_tangent(m.s);
    if (!seen.contact_force.empty()) {
      for (const auto n : fetus) m.axial += seen.contact_force[n].dot(m.tangent);
    }
    return m;
  }
};

Observer::Observer(const fem::Model& model, Setup setup) : impl_(std::make_unique<Impl>(model, std::move(setup))) {}
Observer::~Observer() = default;

const std::vector<std::string>& Observer::names() const { return impl_->names; }
std::size_t Observer::index(const std::string& name) const { return impl_->index(name); }
const Strain& Observer::strain() const { return impl_->strain; }

Pose Observer::head_pose(const fem::State& state) const {
  return best_fit(impl_->model.mesh.nodes, state.x, impl_->skull);
}
Pose Observer::trunk_pose(const fem::State& state) const {
  return best_fit(impl_->model.mesh.nodes, state.x, impl_->trunk);
}

Values Observer::measure(const fem::State& state, const solve::Observables& seen, const Values* previous) const {
  const Moment m = impl_->moment(state, seen, previous);
  Values values;
  values.reserve(impl_->measures.size());
  for (const auto& f : impl_->measures) values.push_back(f(m));
  return values;
}

}  // namespace carus::observe
