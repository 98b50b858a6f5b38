// SPDX-License-Identifier: Apache-2.0
#include "carus/results/birth_run.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <nlohmann/json.hpp>

#include "carus/core/error.hpp"
#include "carus/results/checkpoint.hpp"
#include "carus/results/curves.hpp"
#include "carus/results/events.hpp"
#include "carus/results/files.hpp"
#include "carus/results/frames.hpp"
#include "carus/results/schedule.hpp"
#include "carus/results/summary.hpp"

namespace carus::results {
namespace {

namespace fs = std::filesystem;
using Clock = std::chrono::steady_clock;

double seconds_since(Clock::time_point t) { return std::chrono::duration<double>(Clock::now() - t).count(); }

class BirthRun {
 public:
  BirthRun(const scenario::Scenario& scenario, const fem::Model& model, const observe::Setup& setup, Engine& engine,
           const RunOptions& options)
      : scenario_(scenario),
        model_(model),
        engine_(engine),
        o_(options),
        observer_(model, setup),
        stops_(schedule_of(scenario)),
        scenario_hash_(hash_of(scenario)),
        mesh_hash_(hash_of(model.mesh)),
        checkpoint_file_(options.out / "checkpoint.h5") {
    wall_[meshing] = options.wall_meshing;
    if (options.resume) {
      resume();
    } else {
      start();
    }
    written_ = Clock::now();
  }

  Outcome run() {
    try {
      while (next_ < stops_.size() && !finished()) {
        if (o_.stop && *o_.stop) {
          checkpoint();
          log(fmt::format("interrupted at {:.1f} s of labour; --resume goes on from here", engine_.state().time));
          return Outcome::interrupted;
        }
        advance();
      }
    } catch (const NumericalFailure& failure) {
      return fail(failure.what());
    }
    return end();
  }

 private:
  enum Wall { meshing, solving, output, wall_count };

  void start() {
    curves_ = std::make_unique<Curves>(o_.out / "curves.csv", observer_.names());
    events_ = std::make_unique<Events>(o_.out / "events.jsonl", o_.event);
    frames_ = std::make_unique<Frames>(o_.out, model_, observer_.strain());
    write_atomically(o_.out / "scenario.resolved.yaml",
                     fmt::format("{}\n{}", build_line(o_.version, o_.commit), scenario::resolved_yaml(scenario_)));
  }

  void resume() {
    const Checkpoint c = read_checkpoint(checkpoint_file_);
    refuse_foreign(checkpoint_file_, c, scenario_hash_, mesh_hash_);
    curves_ = std::make_unique<Curves>(o_.out / "curves.csv", observer_.names(), std::size_t(c.rows));
    events_ = std::make_unique<Events>(o_.out / "events.jsonl", c.events, o_.event);
    frames_ = std::make_unique<Frames>(o_.out, model_, observer_.strain(), c.frame_times);
    note_birth(observe::milestones(curves_->table()));
    engine_.restore(c.state);
    next_ = std::size_t(c.stops);
    for (std::size_t k = 0; k < c.wall.size() && k < wall_count; ++k) wall_[k] += c.wall[k];
    wall_[meshing] = std::max(o_.wall_meshing, c.wall.empty() ? 0 : c.wall[meshing]);
    log(fmt::format("resumed at {:.1f} s of labour: {} rows and {} frames kept", c.state.time, c.rows,
                    c.frame_times.size()));
  }

  void advance() {
    const Stop& stop = stops_[next_];
    const auto begin = Clock::now();
    engine_.advance_to(stop.time);
    wall_[solving] += seconds_since(begin);
    const auto solved = Clock::now();
    if (stop.row) record(stop.frame);
    ++next_;
    wall_[output] += seconds_since(solved);
    if (seconds_since(written_) > o_.checkpoint_every) checkpoint();
  }

  void record(bool frame) {
    const auto& state = engine_.state();
    const auto seen = engine_.observe();
    const auto& rows = curves_->table().rows;
    curves_->append(observer_.measure(state, seen, rows.empty() ? nullptr : &rows.back()));
    if (frame) frames_->write(state, seen.contact_force);
    tell_events();
    tell_progress();
  }

  void tell_events() {
    const auto& table = curves_->table();
    const auto row = table.rows.size() - 1;
    const auto more = [&] {
      return fmt::format(R"("station_mm": {:.2f}, "head_z_mm": {:.2f})", table.at(row, "station_mm"),
                         table.at(row, "head_z_mm"));
    };
    if (row > 0 && table.at(row, "contractions_count") > table.at(row - 1, "contractions_count")) {
      events_->add(table.at(row, "time_s"), "contraction",
                   fmt::format(R"("number": {:.0f}, {})", table.at(row, "contractions_count"), more()));
    }
    const auto milestones = observe::milestones(table);
    for (const auto& m : milestones) {
      if (m.row == row) events_->add(m.time, m.name, more());
    }
    note_birth(milestones);
  }

  void note_birth(const std::vector<observe::Milestone>& milestones) {
    for (const auto& m : milestones) {
      born_ |= m.name == "birth";
      out_ |= m.name == "body_out";
    }
  }

  void tell_progress() {
    if (!o_.progress) return;
    const auto& table = curves_->table();
    const auto row = table.rows.size() - 1;
    const double t = engine_.state().time, end = scenario_.numerics.labour_duration;
    const double left = t > 0 ? (wall_[solving] + wall_[output]) * (end - t) / t : NAN;
    o_.progress({t, end, int(table.at(row, "contractions_count")), table.at(row, "station_mm"),
                 table.at(row, "head_z_mm"), left});
  }

  /// Not before the head is born; then at once, or when the body is out.
  [[nodiscard]] bool finished() const { return born_ && (out_ || !scenario_.output.run_after_birth); }

  void checkpoint() {
    const auto begin = Clock::now();
    Checkpoint c;
    c.state = engine_.state();
    c.scenario_hash = scenario_hash_, c.mesh_hash = mesh_hash_, c.version = o_.version;
    c.rows = std::int64_t(curves_->table().rows.size()), c.stops = std::int64_t(next_), c.events = events_->count();
    c.frame_times = frames_->times();
    c.wall.assign(wall_, wall_ + wall_count);
    write_checkpoint(checkpoint_file_, c);
    written_ = Clock::now();
    wall_[output] += seconds_since(begin);
  }

  /// The last state is always a frame, if frames are wanted at all.
  void last_frame() {
    const auto& times = frames_->times();
    if (scenario_.output.frames > 0 && (times.empty() || times.back() != engine_.state().time)) {
      frames_->write(engine_.state(), engine_.observe().contact_force);
    }
  }

  Outcome end() {
    last_frame();
    checkpoint();
    summarise(born_ ? "born" : "not_born", {});
    return born_ ? Outcome::born : Outcome::not_born;
  }

  Outcome fail(const std::string& reason) {
    log("numerical failure: " + reason);
    checkpoint();
    last_frame();
    events_->add(engine_.state().time, "failure", "\"reason\": " + nlohmann::json(reason).dump());
    summarise("failed", reason);
    return Outcome::failed;
  }

  void summarise(const std::string& outcome, const std::string& reason) {
    const auto facts = engine_.facts();
    RunFacts r;
    r.outcome = outcome, r.reason = reason;
    r.elements = model_.mesh.tets.size(), r.nodes = model_.mesh.nodes.size();
    r.surface_nodes = mesh::nodes_of(mesh::boundary(model_.mesh)).size();
    r.steps = engine_.state().step;
    r.time_step = facts.step.time_step, r.time_scaling = facts.labour_per_pseudo;
    r.unscaled_critical_step = facts.step.unscaled_critical_step,
    r.mass_scaled_fraction = facts.step.mass_scaled_fraction;
    r.limiting_region = facts.step.limiting_region;
    r.stages = engine_.timings();
    r.wall_meshing = wall_[meshing], r.wall_solving = wall_[solving], r.wall_output = wall_[output];
    r.threads = o_.threads, r.version = o_.version, r.commit = o_.commit, r.machine = machine_description();
    write_atomically(o_.out / "summary.json",
                     summary_json(figures_of(curves_->table(), scenario_.loads.contractions), scenario_, r));
  }

  void log(const std::string& line) const {
    if (o_.log) o_.log(line);
  }

  const scenario::Scenario& scenario_;
  const fem::Model& model_;
  Engine& engine_;
  const RunOptions& o_;
  observe::Observer observer_;
  std::vector<Stop> stops_;
  std::string scenario_hash_, mesh_hash_;
  fs::path checkpoint_file_;
  std::unique_ptr<Curves> curves_;
  std::unique_ptr<Events> events_;
  std::unique_ptr<Frames> frames_;
  std::size_t next_ = 0;  // of stops_
  bool born_ = false, out_ = false;
  double wall_[wall_count] = {};
  Clock::time_point written_;
};

}  // namespace

observe::Setup observer_setup(const scenario::Scenario& s, const scenario::Assembly& assembly,
                              const anatomy::Anatomy& anatomy) {
  observe::Setup setup;
  setup.landmarks = anatomy.landmarks;
  for (const char* name : {"point_fundus", "point_lower", "point_left", "point_right", "vulva", "hiatus"}) {
    if (const auto it = assembly.node_sets.find(std::string("uterus.") + name);
        it != assembly.node_sets.end() && !it->second.empty()) {
      setup.nodes[name] = it->second;
    }
  }
  for (const auto& region : assembly.model.regions) {
    if (region.organ == "fetus") setup.fetal_regions.push_back(region.name);
  }
  setup.head_regions = {"skull"};
  setup.trunk_regions = {"fetal_body"};
  const anatomy::CanalAxis axis(anatomy.parameters.canal);
  setup.canal_nearest = [axis](const Vec3& x) { return axis.nearest(x); };
  setup.canal_tangent = [axis](double along) { return axis.tangent(along); };
  setup.contractions = s.loads.contractions;
  return setup;
}

std::string build_line(const std::string& version, const std::string& commit) {
  return fmt::format("# carus {} ({})", version, commit);
}

void prepare_folder(const fs::path& out, bool resume) {
  std::error_code error;
  fs::create_directories(out, error);
  if (!fs::is_directory(out))
    throw InputError(fmt::format("{}: cannot be made a folder for the results: {}", out.string(), error.message()));
  if (resume) return;
  for (const char* file : {"summary.json", "checkpoint.h5", "frames.pvd", "curves.csv", "events.jsonl",
                           "scenario.resolved.yaml", "log.txt"}) {
    fs::remove(out / file);
  }
  if (!fs::is_directory(out / "frames")) return;
  for (const auto& entry : fs::directory_iterator(out / "frames")) {
    if (entry.path().filename().string().starts_with("frame_")) fs::remove(entry.path());
  }
}

Outcome run_birth(const scenario::Scenario& scenario, const fem::Model& model, const observe::Setup& setup,
                  Engine& engine, const RunOptions& options) {
  return BirthRun(scenario, model, setup, engine, options).run();
}

}  // namespace carus::results
