// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include <initializer_list>

#include "carus/anatomy/sizes.hpp"
#include "carus/core/error.hpp"
#include "carus/scenario/bind.hpp"
#include "carus/scenario/consistency.hpp"
#include "carus/scenario/raw.hpp"
#include "carus/scenario/real_pelvis.hpp"
#include "carus/scenario/settings.hpp"

namespace carus::scenario {

namespace {

/// Fills the members of a scenario from settings. A path that the schema does not know is a bug.
class Reader {
 public:
  explicit Reader(const Settings& settings) : settings_(settings) {}

  void operator()(const std::string& path, double& x) const { x = get<double>(path); }
  void operator()(const std::string& path, int& x) const { x = static_cast<int>(get<double>(path)); }
  void operator()(const std::string& path, bool& x) const { x = get<bool>(path); }
  void operator()(const std::string& path, std::string& x) const { x = get<std::string>(path); }

  template <class E>
  void choice(const std::string& path, E& x, std::initializer_list<std::pair<const char*, E>> names) const {
    for (const auto& [name, value] : names)
      if (name == get<std::string>(path)) {
        x = value;
        return;
      }
    CARUS_ASSERT(false);
  }

  template <class T, class Item>
  void list(const std::string& path, std::vector<T>& x, const Item& item) const {
    x.assign(settings_.sizes.at(path), T{});
    for (std::size_t i = 0; i < x.size(); ++i) item(fmt::format("{}[{}]", path, i), x[i]);
  }

 private:
  template <class T>
  const T& get(const std::string& path) const {
    const auto it = settings_.values.find(path);
    CARUS_ASSERT(it != settings_.values.end());
    return std::get<T>(it->second);
  }

  const Settings& settings_;
};

Scenario build(Raw root, const std::filesystem::path& file, const std::vector<std::string>& overrides,
               Problems problems) {
  // A file that could not be read says nothing about its keys: its own problems are all there is to tell.
  if (!problems.empty()) throw InputError(problems);
  for (const std::string& assignment : overrides) apply_override(root, assignment, problems);
  Problems warnings;
  const Settings settings = settle(root, problems, warnings);
  if (!problems.empty()) throw InputError(problems);

  Scenario s;
  s.file = file.string();
  Reader reader(settings);
  bind(reader, s);
  if (s.name.empty()) s.name = file.stem().string();
  s.warnings = std::move(warnings);
  // Beside the file that names it; on the command line, from where one stands.
  const auto locate = [&](const char* key, std::string& path) {
    if (path.empty()) return;
    const std::string& by = settings.files.at(key);
    const auto folder = by == "--set" ? std::filesystem::path() : std::filesystem::path(by).parent_path();
    path = std::filesystem::absolute(folder / path).lexically_normal().string();
  };
  locate("anatomy.from", s.anatomy_from);
  auto& bones = s.anatomy.bones_from;
  locate("pelvis.from", bones.file);
  locate("pelvis.surfaces.innominate_right", bones.surfaces.right);
  locate("pelvis.surfaces.innominate_left", bones.surfaces.left);
  locate("pelvis.surfaces.sacrum", bones.surfaces.sacrum);
  locate("pelvis.surfaces.coccyx", bones.surfaces.coccyx);
  take_real_pelvis(s);
  problems = inconsistencies(s, settings);
  if (!problems.empty()) throw InputError(problems);

  s.anatomy.mesh = anatomy::mesh_size(name_of(s.resolution));
  auto& mesh = s.anatomy.mesh;
  for (double* edge : {&mesh.fetus, &mesh.uterus, &mesh.abdomen_inner, &mesh.abdomen_outer, &mesh.bone})
    *edge *= s.numerics.mesh_factor;
  return s;
}

}  // namespace

Scenario load(const std::filesystem::path& file, const std::vector<std::string>& overrides) {
  Problems problems;
  Raw root = read_yaml_file(file, problems);
  return build(std::move(root), file, overrides, std::move(problems));
}

Scenario parse(const std::string& yaml, const std::filesystem::path& file, const std::vector<std::string>& overrides) {
  Problems problems;
  Raw root = read_yaml(yaml, file, problems);
  return build(std::move(root), file, overrides, std::move(problems));
}

const char* name_of(Resolution resolution) {
  switch (resolution) {
    case Resolution::coarse:
      return "coarse";
    case Resolution::paper:
      return "paper";
    case Resolution::fine:
      return "fine";
  }
  CARUS_ASSERT(false);
}

solve::ExplicitOptions explicit_options(const Scenario& s) {
  const Numerics& n = s.numerics;
  solve::ExplicitOptions o;
  o.labour_duration = n.labour_duration;
  o.pseudo_duration = n.pseudo_duration * n.pseudo_time_factor;
  // Kinetic energy goes with the square of the time scaling: at twice the pseudo-time a quarter of it is aimed at.
  o.pace = {n.pace_kinetic_ratio / (n.pseudo_time_factor * n.pseudo_time_factor), n.pace_slowest, n.pace_fastest};
  // Edges that shrink shorten the critical step; so the added mass is about the same on all meshes.
  o.time_step = n.time_step * s.anatomy.mesh.uterus / anatomy::mesh_size("paper").uterus;
  o.safety = n.safety;
  o.drag = n.drag * n.drag_factor;
  o.max_node_speed = n.max_node_speed;
  o.contact_sweeps = s.contact.sweeps;
  o.contact_search = s.contact.search;
  o.contact_correction = s.contact.correction_speed;
  o.threads = n.threads;
  return o;
}

solve::ImplicitOptions implicit_options(const Scenario& s) {
  const Implicit& i = s.implicit;
  solve::ImplicitOptions o;
  o.time_step = i.time_step, o.least_time_step = i.least_time_step;
  o.step_tolerance = i.step_tolerance, o.newton_tolerance = i.newton_tolerance;
  o.max_iterations = i.max_iterations, o.linear_tolerance = i.linear_tolerance;
  o.drag = s.numerics.drag * s.numerics.drag_factor;
  o.barrier_distance = i.barrier_distance, o.barrier_pressure = i.barrier_pressure;
  o.friction_speed = i.friction_speed;
  o.threads = s.numerics.threads;
  return o;
}

}  // namespace carus::scenario
