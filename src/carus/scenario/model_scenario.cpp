// SPDX-License-Identifier: Apache-2.0
#include "carus/scenario/model_scenario.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>

#include "carus/core/error.hpp"
#include "carus/scenario/raw.hpp"
#include "carus/scenario/schema.hpp"
#include "carus/scenario/settings.hpp"
#include "carus/scenario/text.hpp"

namespace carus::scenario {

namespace {

using Curve = std::function<double(double)>;

std::uint8_t bits_of(const std::string& axes) {
  std::uint8_t bits = 0;
  for (const char c : axes) bits = std::uint8_t(bits | (1 << (c - 'x')));
  return bits;
}

/// Linear between points, constant outside; points by rising time.
Curve piecewise_linear(std::vector<std::pair<double, double>> points) {
  return [points = std::move(points)](double t) {
    if (t <= points.front().first) return points.front().second;
    for (std::size_t i = 1; i < points.size(); ++i) {
      const auto& [t0, v0] = points[i - 1];
      const auto& [t1, v1] = points[i];
      if (t < t1) return v0 + (v1 - v0) * (t - t0) / (t1 - t0);
    }
    return points.back().second;
  };
}

/// From settings to a ModelScenario; what no schema can say goes to `problems`.
class ModelReader {
 public:
  ModelReader(const Settings& settings, const std::filesystem::path& file, Problems& problems)
      : s_(settings), file_(file), problems_(problems) {}

  ModelScenario read() {
    ModelScenario m;
    m.file = file_.string(), m.name = text("name"), m.description = text("description");
    if (m.name.empty()) m.name = file_.stem().string();
    read_numbers(m);
    read_curves(m.duration);
    read_meshes(m);
    read_sets(m);
    read_constraints(m);
    read_loads(m);
    read_contact(m);
    for (std::size_t i = 0; i < size("output.nodes"); ++i)
      m.output_nodes.push_back(text(fmt::format("output.nodes[{}]", i)));
    return m;
  }

 private:
  [[nodiscard]] std::size_t size(const std::string& list) const { return s_.sizes.at(list); }
  [[nodiscard]] const std::string& text(const std::string& path) const {
    return std::get<std::string>(s_.values.at(path));
  }
  [[nodiscard]] double number(const std::string& path) const { return std::get<double>(s_.values.at(path)); }
  [[nodiscard]] bool flag(const std::string& path) const { return std::get<bool>(s_.values.at(path)); }

  void refuse(const std::string& path, const std::string& what) {
    problems_.push_back(fmt::format("{}: {}: {}", file_.string(), path, what));
  }

  template <class F>
  void each(const std::string& list, F&& f) {
    for (std::size_t i = 0; i < size(list); ++i) f(fmt::format("{}[{}]", list, i));
  }

  std::string required(const std::string& path) {
    const std::string& value = text(path);
    if (value.empty()) refuse(path, "is silent; allowed a name");
    return value;
  }

  /// Three components; `fallback` where the list is empty.
  Vec3 vector(const std::string& path, const Vec3& fallback = Vec3::Zero()) {
    if (size(path) == 0) return fallback;
    if (size(path) != 3) {
      refuse(path, fmt::format("has {} components; allowed 3, or an empty list", size(path)));
      return fallback;
    }
    return {number(path + "[0]"), number(path + "[1]"), number(path + "[2]")};
  }

  Vec3 direction(const std::string& path, const Vec3& fallback) {
    const Vec3 v = vector(path, fallback);
    if (v.norm() > 0) return v.normalized();
    refuse(path, "has no length; allowed any other vector");
    return fallback;
  }

  ModelScenario::Box box(const std::string& path) {
    constexpr double inf = std::numeric_limits<double>::infinity();
    ModelScenario::Box b{vector(path + ".low", Vec3::Constant(-inf)), vector(path + ".high", Vec3::Constant(inf))};
    if ((b.low.array() > b.high.array()).any())
      refuse(path, "low is above high; allowed low <= high in every component");
    return b;
  }

  void read_numbers(ModelScenario& m) {
    m.implicit = text("solver.kind") == "implicit";
    const std::string& analysis = text("solver.analysis");
    m.analysis = analysis == "dynamic"        ? ModelScenario::Analysis::dynamic
                 : analysis == "quasi_static" ? ModelScenario::Analysis::quasi_static
                                              : ModelScenario::Analysis::static_equilibrium;
    m.duration = number("numerics.duration"), m.time_scaling = number("numerics.time_scaling");
    m.time_step = number("numerics.time_step"), m.safety = number("numerics.safety"), m.drag = number("numerics.drag");
    m.max_node_speed = number("numerics.max_node_speed"), m.threads = int(number("numerics.threads"));
    m.frames = int(number("output.frames")), m.rows = int(number("output.rows"));
    if (m.analysis == ModelScenario::Analysis::static_equilibrium && !m.implicit)
      refuse("solver.analysis", "static needs solver.kind implicit; or quasi_static with drag");
    if (m.analysis == ModelScenario::Analysis::dynamic && m.time_scaling != 1)
      refuse("numerics.time_scaling", fmt::format("is {:g} in a dynamic analysis; allowed 1", m.time_scaling));
  }

  void read_curves(double duration) {
    curves_["ramp"] = piecewise_linear({{0, 0}, {duration, 1}});
    curves_["constant"] = [](double) { return 1.0; };
    each("curves", [&](const std::string& path) {
      const std::string name = required(path + ".name");
      std::vector<std::pair<double, double>> points;
      each(path + ".points", [&](const std::string& p) {
        points.emplace_back(number(p + ".time"), number(p + ".value"));
        if (points.size() > 1 && points[points.size() - 2].first >= points.back().first)
          refuse(p + ".time", "is not later than the point before; allowed rising times");
      });
      if (points.empty()) return refuse(path + ".points", "is empty; allowed one point or more");
      if (!curves_.emplace(name, piecewise_linear(std::move(points))).second)
        refuse(path + ".name", fmt::format("\"{}\" is taken; choose another name", name));
    });
  }

  Curve curve(const std::string& path) {
    const auto it = curves_.find(text(path));
    if (it != curves_.end()) return it->second;
    std::vector<std::string> names;
    for (const auto& [name, unused] : curves_) names.push_back(name);
    refuse(path, fmt::format("no curve \"{}\"; allowed {}", text(path), enumerated(names)));
    return curves_.at("constant");
  }

  void read_meshes(ModelScenario& m) {
    using Shape = ModelScenario::Shape;
    static const std::map<std::string, Shape> shapes{
        {"file", Shape::file}, {"box", Shape::box}, {"ball", Shape::ball}, {"tube", Shape::tube}};
    static const std::map<std::string, double> unit{{"m", 1}, {"cm", 1e-2}, {"mm", 1e-3}};
    each("meshes", [&](const std::string& path) {
      ModelScenario::Mesh mesh;
      mesh.shape = shapes.at(text(path + ".shape")), mesh.unit = unit.at(text(path + ".unit"));
      mesh.region = text(path + ".region");
      mesh.low = vector(path + ".low"), mesh.size = vector(path + ".size");
      for (std::size_t i = 0; i < size(path + ".cells"); ++i)
        mesh.cells.push_back(int(number(fmt::format("{}.cells[{}]", path, i))));
      mesh.radius = number(path + ".radius"), mesh.inner_radius = number(path + ".inner_radius");
      mesh.height = number(path + ".height");
      if (mesh.shape == Shape::file) {
        mesh.file = (file_.parent_path() / required(path + ".file")).lexically_normal().string();
        if (!text(path + ".file").empty() && !std::filesystem::exists(mesh.file))
          refuse(path + ".file", fmt::format("\"{}\" is not there; the path is relative to this file", mesh.file));
      }
      check_shape(path, mesh);
      m.meshes.push_back(std::move(mesh));
    });
    if (m.meshes.empty()) refuse("meshes", "is empty; allowed one mesh or more");
    each("regions", [&](const std::string& path) { m.regions.push_back(region(path)); });
  }

  void check_shape(const std::string& path, const ModelScenario::Mesh& mesh) {
    using Shape = ModelScenario::Shape;
    const std::size_t wanted = mesh.shape == Shape::file ? 0 : mesh.shape == Shape::ball ? 1 : 3;
    if (mesh.cells.size() != wanted)
      refuse(path + ".cells",
             fmt::format("has {} numbers; allowed {} for a {}", mesh.cells.size(), wanted, text(path + ".shape")));
    if (mesh.shape == Shape::box && size(path + ".size") == 0)
      refuse(path + ".size", "is silent; a box needs its three edges");
    if (mesh.shape == Shape::tube && mesh.inner_radius >= mesh.radius)
      refuse(path + ".inner_radius",
             fmt::format("is {:g} m; allowed less than radius, {:g} m", mesh.inner_radius, mesh.radius));
    if (mesh.shape == Shape::tube && mesh.cells.size() == 3 && mesh.cells[1] < 3)
      refuse(path + ".cells", "a tube needs three cells around or more");
    double elements = 6;
    for (const int n : mesh.cells) elements *= mesh.shape == Shape::ball ? std::pow(n, 3) : n;
    if (elements > 2e7)
      refuse(path + ".cells", fmt::format("makes {:.3g} elements; allowed up to 2e7: take fewer", elements));
  }

  ModelScenario::Region region(const std::string& path) {
    static const std::map<std::string, material::Law> laws{{"neo_hooke", material::Law::neo_hooke},
                                                           {"mooney_rivlin", material::Law::mooney_rivlin},
                                                           {"hooke_corotated", material::Law::hooke_corotated},
                                                           {"hooke_small_strain", material::Law::hooke_small_strain}};
    ModelScenario::Region r;
    r.name = required(path + ".name"), r.rigid = flag(path + ".rigid");
    const std::string at = path + ".material";
    auto& m = r.material;
    m.law = laws.at(text(at + ".law"));
    m.c10 = number(at + ".c10"), m.c01 = number(at + ".c01"), m.youngs_modulus = number(at + ".youngs_modulus");
    m.poisson = number(at + ".poisson"), m.density = number(at + ".density");
    m.fibre_k1 = number(at + ".fibre.k1"), m.fibre_k2 = number(at + ".fibre.k2");
    each(at + ".prony", [&](const std::string& p) { m.prony.push_back({number(p + ".g"), number(p + ".tau")}); });
    m.average_nodal_pressure = flag(at + ".average_nodal_pressure");
    if (m.fibre_k1 != 0) refuse(at + ".fibre.k1", "a general model has no fibre directions; allowed 0 kPa");
    if (m.prony.size() > 4) refuse(at + ".prony", fmt::format("has {} items; allowed up to 4", m.prony.size()));
    if (!r.rigid) {
      for (const auto& p : material::validate(m, fmt::format("{}: {}", file_.string(), at))) problems_.push_back(p);
    }
    return r;
  }

  void read_sets(ModelScenario& m) {
    each("node_sets", [&](const std::string& p) {
      m.node_sets.push_back({required(p + ".name"), text(p + ".nodes"), box(p)});
    });
    each("surfaces", [&](const std::string& p) {
      m.surfaces.push_back({required(p + ".name"), text(p + ".region"), box(p)});
    });
  }

  void read_constraints(ModelScenario& m) {
    each("fixed", [&](const std::string& p) {
      m.fixed.push_back({required(p + ".nodes"), bits_of(text(p + ".axes"))});
    });
    each("motions", [&](const std::string& p) {
      ModelScenario::Motion motion;
      motion.nodes = required(p + ".nodes"), motion.name = text(p + ".name");
      if (motion.name.empty()) motion.name = motion.nodes;
      motion.axes = bits_of(text(p + ".axes"));
      motion.displacement = vector(p + ".displacement"), motion.point = vector(p + ".point");
      motion.axis = direction(p + ".axis", Vec3::UnitZ()), motion.angle = number(p + ".angle");
      motion.curve = curve(p + ".curve");
      m.motions.push_back(std::move(motion));
    });
    each("ties", [&](const std::string& p) {
      m.ties.push_back({required(p + ".nodes"), required(p + ".surface"), number(p + ".tolerance")});
    });
  }

  void read_loads(ModelScenario& m) {
    each("initial_velocities", [&](const std::string& p) {
      m.initial_velocities.push_back({required(p + ".nodes"), vector(p + ".velocity")});
    });
    if (!m.initial_velocities.empty() && m.analysis == ModelScenario::Analysis::static_equilibrium)
      refuse("initial_velocities", "a static analysis has no velocities; allowed none");
    each("pressures", [&](const std::string& p) {
      ModelScenario::Pressure load;
      load.surface = required(p + ".surface"), load.name = text(p + ".name");
      if (load.name.empty()) load.name = load.surface;
      load.pressure = number(p + ".pressure"), load.directed = size(p + ".direction") > 0;
      if (load.directed) load.direction = direction(p + ".direction", Vec3::UnitZ());
      load.curve = curve(p + ".curve");
      m.pressures.push_back(std::move(load));
    });
    each("body_forces", [&](const std::string& p) {
      m.body_forces.push_back(
          {text(p + ".name"), text(p + ".region"), vector(p + ".acceleration"), curve(p + ".curve")});
    });
  }

  void read_contact(ModelScenario& m) {
    each("contact.pairs", [&](const std::string& p) {
      m.contact_pairs.push_back({required(p + ".a"), required(p + ".b"), number(p + ".friction")});
    });
    m.contact_search = number("contact.search"), m.contact_correction = number("contact.correction_speed");
    m.contact_sweeps = int(number("contact.sweeps"));
    m.barrier_distance = number("contact.barrier_distance"), m.barrier_pressure = number("contact.barrier_pressure");
    m.newton_tolerance = number("numerics.newton_tolerance");
  }

  const Settings& s_;
  std::filesystem::path file_;
  Problems& problems_;
  std::map<std::string, Curve> curves_;
};

ModelScenario build(Raw root, const std::filesystem::path& file, const std::vector<std::string>& overrides,
                    Problems problems) {
  if (!problems.empty()) throw InputError(problems);
  for (const std::string& assignment : overrides) apply_override(root, assignment, problems);
  Problems warnings;
  const Settings settings = settle(root, problems, warnings, model_schema());
  if (!problems.empty()) throw InputError(problems);
  ModelScenario m = ModelReader(settings, file, problems).read();
  if (!problems.empty()) throw InputError(problems);
  m.resolved = settings_yaml(settings, model_schema());
  m.warnings = std::move(warnings);
  return m;
}

}  // namespace

Kind kind_of(const std::filesystem::path& file, const std::vector<std::string>& overrides) {
  Problems problems;
  Raw root = read_yaml_file(file, problems);
  if (!problems.empty()) throw InputError(problems);
  for (const std::string& assignment : overrides) apply_override(root, assignment, problems);
  const Raw* kind = root.find("kind");
  if (kind == nullptr || kind->text == "birth") return Kind::birth;
  if (kind->text == "model") return Kind::model;
  throw InputError(
      fmt::format("{}: kind: \"{}\" is not one of the choices; allowed birth, model", file.string(), kind->text));
}

ModelScenario load_model(const std::filesystem::path& file, const std::vector<std::string>& overrides) {
  Problems problems;
  Raw root = read_yaml_file(file, problems);
  return build(std::move(root), file, overrides, std::move(problems));
}

ModelScenario parse_model(const std::string& yaml, const std::filesystem::path& file,
                          const std::vector<std::string>& overrides) {
  Problems problems;
  Raw root = read_yaml(yaml, file, problems);
  return build(std::move(root), file, overrides, std::move(problems));
}

}  // namespace carus::scenario
