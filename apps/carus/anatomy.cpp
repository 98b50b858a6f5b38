// SPDX-License-Identifier: Apache-2.0
#include "carus/anatomy/anatomy.hpp"

#include <fmt/format.h>

#include <cmath>

#include "app.hpp"
#include "carus/core/units.hpp"
#include "carus/results/birth_run.hpp"
#include "carus/results/export.hpp"
#include "carus/scenario/scenario.hpp"
#ifdef CARUS_WITH_MESHING
#include "carus/meshing/quality_report.hpp"
#endif

namespace carus::app {
namespace {

struct AnatomyArguments {
  std::string scenario, out;
  std::vector<std::string> overrides;
};

/// Measures come in SI; a key tells by its end what it is.
std::pair<double, const char*> shown(const std::string& key, double v) {
  if (key.ends_with("angle") || key == "flexion" || key == "asynclitism") return {v / units::deg, "deg"};
  if (key.ends_with("_kg")) return {v, ""};
  if (key.starts_with("volume_")) return {v * 1e6, "ml"};
  return {v / units::mm, "mm"};
}

void print_measures(const anatomy::Anatomy& a) {
  fmt::print("{:<28}{:>12}{:>12}{:>12}\n", "", "requested", "measured", "difference");
  for (const auto& [key, value] : a.measured) {
    const auto [measured, unit] = shown(key, value);
    if (const auto it = a.requested.find(key); it != a.requested.end()) {
      const double requested = shown(key, it->second).first;
      fmt::print("{:<28}{:>12.1f}{:>12.1f}{:>+12.1f} {}\n", key, requested, measured, measured - requested, unit);
    } else {
      fmt::print("{:<28}{:>12}{:>12.1f}{:>12} {}\n", key, "", measured, "", unit);
    }
  }
}

#ifdef CARUS_WITH_MESHING
void print_quality(const anatomy::Anatomy& a) {
  fmt::print("\n{:<20}{:>8}{:>12}{:>10}{:>10}{:>12}{:>12}{:>10}\n", "", "tets", "volume ml", "min deg", "max deg",
             "altitude mm", "mean mm", "aspect");
  for (const auto* body : {&a.fetus, &a.uterus, &a.abdomen}) {
    fmt::print("{}: {} nodes, {} on the surface\n", body->name, body->mesh.nodes.size(),
               mesh::nodes_of(mesh::boundary(body->mesh)).size());
    for (const auto& [label, q] : meshing::quality_report(body->mesh)) {
      fmt::print("  {:<18}{:>8}{:>12.1f}{:>10.1f}{:>10.1f}{:>12.2f}{:>12.2f}{:>10.1f}\n", anatomy::name_of(label),
                 q.tets, 1e6 * q.volume, q.min_dihedral_deg, q.max_dihedral_deg, 1e3 * q.min_altitude,
                 1e3 * q.mean_altitude, q.max_aspect);
    }
  }
}
#else
void print_quality(const anatomy::Anatomy&) {}  // meshing's report
#endif

/// Least distances that decide whether anything fits: between the bodies, and of soft tissue between the canal and each
/// bone.
void print_budget(const anatomy::Anatomy& a) {
  const auto surface = [](const anatomy::Body& body, const std::string& name) {
    for (const auto& s : body.surfaces) {
      if (s.name == name) return s.triangles;
    }
    return mesh::Triangles{};
  };
  const auto line = [](const std::string& what, const mesh::TetMesh& ma, const mesh::Triangles& ta,
                       const mesh::TetMesh& mb, const mesh::Triangles& tb) {
    if (!ta.empty() && !tb.empty())
      fmt::print("  {:<34}{:>8.2f} mm\n", what, mesh::least_gap(ma.nodes, ta, mb.nodes, tb) / units::mm);
  };
  const auto cavity = surface(a.abdomen, "cavity");
  fmt::print("\nleast gaps and tissue at rest\n");
  line("fetus to uterus", a.fetus.mesh, mesh::boundary(a.fetus.mesh), a.uterus.mesh, surface(a.uterus, "inner"));
  line("uterus to the abdomen's cavity", a.uterus.mesh, surface(a.uterus, "outer"), a.abdomen.mesh, cavity);
  for (const auto label : {anatomy::innominate_right, anatomy::innominate_left, anatomy::sacrum, anatomy::coccyx}) {
    const auto bone = mesh::boundary(a.abdomen.mesh, [=](std::int32_t l) { return l == label; });
    line(fmt::format("uterus to {}", anatomy::name_of(label)), a.uterus.mesh, surface(a.uterus, "outer"),
         a.abdomen.mesh, bone);
    line(fmt::format("cavity to {} (0: bare)", anatomy::name_of(label)), a.abdomen.mesh, cavity, a.abdomen.mesh, bone);
  }
}

int write_anatomy(const AnatomyArguments& args) {
  const auto s = scenario::load(args.scenario, args.overrides);
  std::filesystem::create_directories(args.out);
  const auto a = build_anatomy(s);
  const auto files = results::export_anatomy(a, scenario::anatomy_settings(s), args.out);
  print_measures(a);
  print_quality(a);
  print_budget(a);
  for (const auto& w : a.warnings) fmt::print("warning: {}\n", w);
  fmt::print("{} files in {}\n", files.size(), args.out);
  return done;
}

}  // namespace

void add_anatomy(CLI::App& app, int& status) {
  auto a = std::make_shared<AnatomyArguments>();
  auto* c = app.add_subcommand(
      "anatomy", "Write the organs as STL and VTU, ready for anatomy.from; print measures and mesh quality");
  c->add_option("SCENARIO", a->scenario, "Scenario file (YAML)")->required();
  c->add_option("--out", a->out, "Folder for the files")->required();
  c->add_option("--set", a->overrides, "Override a key of the scenario, path.to.key=value; may be given again")
      ->expected(1)
      ->take_all();
  c->footer(
      "Examples:\n  carus anatomy scenarios/reference.yaml --out out/anatomy\n  carus anatomy scenarios/reference.yaml "
      "--out out/op --set fetus.position=OP");
  c->callback([a, &status] { status = write_anatomy(*a); });
}

}  // namespace carus::app
