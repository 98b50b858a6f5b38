// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include <cstdio>
#include <filesystem>

#include "app.hpp"
#include "carus/general/deck.hpp"
#include "carus/report/trajectory.hpp"
#include "carus/results/files.hpp"

namespace carus::app {
namespace {

struct TrajectoryArguments {
  std::string folder, out, axis = "chord";
  double rate = 10, speed = 0, acceleration = 0, stroke = 0;
  bool slow_down = false, to_end = false, no_wrench = false;
};

report::TrajectoryOptions options_of(const TrajectoryArguments& a) {
  report::TrajectoryOptions o;
  o.rate = a.rate, o.slow_down = a.slow_down;
  for (const auto axis : {report::Axis::chord, report::Axis::z, report::Axis::path}) {
    if (a.axis == report::name_of(axis)) o.axis = axis;
  }
  if (a.speed > 0) o.limits.speed = a.speed;
  if (a.acceleration > 0) o.limits.acceleration = a.acceleration;
  if (a.stroke > 0) o.limits.stroke = a.stroke;
  return o;
}

int export_trajectory(const TrajectoryArguments& a) {
  auto folder = report::read_folder(a.folder);
  auto motion = report::motion_of(folder, a.to_end);
  auto notes = folder.notes;
  if (!a.no_wrench) report::add_wrench(motion, folder, notes);
  std::optional<labour::Contractions> contractions;
  if (folder.scenario) contractions = folder.scenario->loads.contractions;
  const auto t = report::resample(motion, contractions, options_of(a));
  for (const auto& note : notes) fmt::print(stderr, "note: {}\n", note);
  const std::filesystem::path out =
      a.out.empty() ? std::filesystem::path(a.folder) / "trajectory" : std::filesystem::path(a.out);
  const auto csv = out.string() + ".csv", json = out.string() + ".json";
  results::write_atomically(csv, report::as_csv(t));
  results::write_atomically(json, report::as_json(t, folder));
  fmt::print("{}, {}: {} rows of {} columns at {:g} Hz, time stretched by {:.6g}\n", csv, json, t.rows.size(),
             t.columns.size(), t.options.rate, t.time_stretch);
  fmt::print(
      "along {}: stroke {:.2f} mm, speed up to {:.4g} mm/s at {:.1f} s, acceleration up to {:.4g} mm/s2 at {:.1f} s\n",
      report::name_of(t.options.axis), t.stroke_high - t.stroke_low, t.speed.value, t.speed.time, t.acceleration.value,
      t.acceleration.time);
  return done;
}

struct DeckArguments {
  std::string scenario, out;
  std::vector<std::string> overrides;
};

int export_deck(const DeckArguments& a) {
  const auto s = scenario::load_model(a.scenario, a.overrides);
  const auto model = general::build(s, general::gather_meshes(s));
  results::write_atomically(a.out, general::ccx_deck(s, model));
  fmt::print("{}: {} elements, {} nodes\n", a.out, model.model.mesh.tets.size(), model.model.mesh.nodes.size());
  return done;
}

void add_deck(CLI::App& parent, int& status) {
  auto a = std::make_shared<DeckArguments>();
  auto* c = parent.add_subcommand("ccx", "A general model as a deck for CalculiX, to be computed there too");
  c->add_option("SCENARIO", a->scenario, "Scenario file (YAML) of kind model")->required();
  c->add_option("--out", a->out, "The deck to write, FILE.inp")->required();
  c->add_option("--set", a->overrides, "Override a key of the scenario, path.to.key=value; may be given again")
      ->expected(1)
      ->take_all();
  c->footer(
      "Example:\n  carus export ccx scenarios/models/cantilever.yaml --out /tmp/cantilever.inp && ccx /tmp/cantilever");
  c->callback([a, &status] { status = export_deck(*a); });
}

}  // namespace

void add_export(CLI::App& app, int& status) {
  auto* c = app.add_subcommand("export", "Write a run's data, or a model, for other programs");
  c->require_subcommand(1);
  add_deck(*c, status);
  auto a = std::make_shared<TrajectoryArguments>();
  auto* t = c->add_subcommand("trajectory", "The head's path, resampled, for a trainer: CSV and JSON");
  t->add_option("DIR", a->folder, "Results folder of carus run")->required();
  t->add_option("--out", a->out, "Where to write, without the ending; default DIR/trajectory");
  t->add_option("--rate", a->rate, "Rows per second [Hz]")->check(CLI::Range(1e-3, 1e5))->capture_default_str();
  t->add_option("--axis", a->axis, "The one axis: chord (start to end), z (straight down), path (along the canal)")
      ->check(CLI::IsMember({"chord", "z", "path"}))
      ->capture_default_str();
  t->add_option("--max-speed", a->speed, "Along the axis [mm/s]")->check(CLI::PositiveNumber);
  t->add_option("--max-acceleration", a->acceleration, "Along the axis [mm/s2]")->check(CLI::PositiveNumber);
  t->add_option("--stroke", a->stroke, "Of the axis [mm]")->check(CLI::PositiveNumber);
  t->add_flag("--slow-down", a->slow_down,
              "Stretch time, all of it by one factor, until speed and acceleration are within their limits");
  t->add_flag("--to-end", a->to_end, "Past birth, to the run's end");
  t->add_flag("--no-wrench", a->no_wrench, "Without forces: frames are not read");
  t->footer(
      "Examples:\n"
      "  carus export trajectory out/reference\n"
      "  carus export trajectory out/reference --rate 100 --stroke 200 --max-speed 50 --max-acceleration 200\n"
      "  carus export trajectory out/reference --max-speed 0.5 --slow-down --out trainer/head\n"
      "A limit that is passed is refused with its place and value (exit status 2), unless --slow-down cures it.");
  t->callback([a, &status] { status = export_trajectory(*a); });
}

}  // namespace carus::app
