// SPDX-License-Identifier: Apache-2.0
#include "carus/general/run.hpp"

#include <fmt/format.h>
#include <vtkCellData.h>
#include <vtkPointData.h>
#include <vtkUnstructuredGrid.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <limits>
#include <nlohmann/json.hpp>

#include "carus/core/error.hpp"
#include "carus/observe/strain.hpp"
#include "carus/observe/stress.hpp"
#include "carus/results/birth_run.hpp"
#include "carus/results/checkpoint.hpp"
#include "carus/results/curves.hpp"
#include "carus/results/files.hpp"
#include "carus/results/frames.hpp"
#include "carus/results/summary.hpp"
#include "carus/results/vtk_grid.hpp"
#include "carus/solve/implicit.hpp"
#include "carus/solve/mass.hpp"

namespace carus::general {
namespace {

namespace fs = std::filesystem;
using Clock = std::chrono::steady_clock;
using scenario::ModelScenario;

double seconds_since(Clock::time_point t) { return std::chrono::duration<double>(Clock::now() - t).count(); }

solve::ExplicitOptions explicit_options(const ModelScenario& s, const fem::Model& model) {
  solve::ExplicitOptions o;
  o.labour_duration = s.duration, o.pseudo_duration = s.duration / s.time_scaling;
  o.safety = s.safety, o.drag = s.drag, o.max_node_speed = s.max_node_speed, o.threads = s.threads;
  o.contact_sweeps = s.contact_sweeps, o.contact_search = s.contact_search;
  o.contact_correction = s.contact_correction;
  double critical = std::numeric_limits<double>::infinity();
  for (std::size_t e = 0; e < model.mesh.tets.size(); ++e) {
    if (!model.regions[std::size_t(model.mesh.labels[e])].rigid)
      critical = std::min(critical, solve::critical_step(model, e));
  }
  if (!std::isfinite(critical))
    throw InputError(fmt::format("{}: regions: all are rigid, nothing is to be computed", s.file));
  // What follows from the step is kept from rounding up to more than it by a hair.
  o.time_step = s.time_step > 0 ? s.time_step : (1 - 1e-9) * s.safety * critical;
  if (s.analysis == ModelScenario::Analysis::dynamic && o.time_step > s.safety * critical)
    throw InputError(
        fmt::format("{}: numerics.time_step: {:g} us is above safety times the least critical step, {:g} us, "
                    "and a dynamic analysis adds no mass; allowed up to that, or 0 us",
                    s.file, s.time_step * 1e6, s.safety * critical * 1e6));
  return o;
}

solve::ImplicitOptions implicit_options(const ModelScenario& s, const fem::Model& model) {
  solve::ImplicitOptions o;
  o.time_step = s.time_step > 0 ? s.time_step : s.duration / 100;
  o.least_time_step = o.time_step / 1024;
  Vec3 low = model.mesh.nodes[0], high = low;
  for (const Vec3& x : model.mesh.nodes) low = low.cwiseMin(x), high = high.cwiseMax(x);
  o.newton_tolerance = s.newton_tolerance > 0 ? s.newton_tolerance : 1e-6 * (high - low).norm();
  o.linear_tolerance = 0.1;
  o.drag = s.drag, o.inertia = s.analysis == ModelScenario::Analysis::dynamic;
  o.barrier_distance = s.barrier_distance, o.barrier_pressure = s.barrier_pressure;
  o.threads = s.threads;
  return o;
}

void set_stress(vtkDataSetAttributes& to, const char* name, const std::vector<observe::Stress::Sym>& values) {
  constexpr const char* part[] = {"xx", "yy", "zz", "xy", "yz", "zx"};
  std::vector<double> one(values.size());
  for (std::size_t k = 0; k < 6; ++k) {
    for (std::size_t i = 0; i < one.size(); ++i) one[i] = values[i][k];
    results::set_scalars(to, fmt::format("{}_{}", name, part[k]).c_str(), one);
  }
}

std::vector<std::string> column_names(const GeneralModel& m) {
  std::vector<std::string> names{"time_s"};
  for (const auto& set : m.watched) {
    for (const char* what : {"u{}_mm", "r{}_n", "c{}_n"}) {
      for (const char axis : {'x', 'y', 'z'}) names.push_back(set.name + "_" + fmt::format(fmt::runtime(what), axis));
    }
  }
  for (const char* name : {"kinetic_j", "internal_j", "external_work_j", "contact_work_j", "damping_work_j",
                           "relaxation_work_j", "least_gap_mm", "min_J"})
    names.emplace_back(name);
  return names;
}

class Run {
 public:
  Run(const ModelScenario& s, const GeneralModel& m, results::Engine& engine, const RunOptions& o)
      : s_(s),
        m_(m),
        engine_(engine),
        o_(o),
        strain_(m.model.mesh),
        stress_(m.model),
        checkpoint_file_(o.out / "checkpoint.h5") {
    results::Hash hash;
    hash.add_all(s.resolved);
    scenario_hash_ = hash.hex(), mesh_hash_ = results::hash_of(m.model.mesh);
    wall_ = {o.wall_meshing, 0, 0};
    // Rows and frames at multiples of their own intervals, merged.
    for (int k = 0; k <= s.rows; ++k) times_.push_back(s.duration * k / s.rows);
    for (int k = 1; k <= s.frames; ++k) frame_times_.push_back(s.duration * k / s.frames);
    times_.insert(times_.end(), frame_times_.begin(), frame_times_.end());
    std::sort(times_.begin(), times_.end());
    times_.erase(
        std::unique(times_.begin(), times_.end(), [&](double a, double b) { return b - a < 1e-9 * s.duration; }),
        times_.end());
    if (o.resume)
      resume();
    else
      start();
    written_ = Clock::now();
  }

  Outcome run() {
    try {
      for (; next_ < times_.size(); ++next_) {
        if (o_.stop && *o_.stop) {
          checkpoint();
          log(fmt::format("interrupted at {:.6g} s; --resume goes on from here", engine_.state().time));
          return Outcome::interrupted;
        }
        advance();
      }
    } catch (const NumericalFailure& failure) {
      log(fmt::format("numerical failure: {}", failure.what()));
      frame();
      checkpoint();
      write_summary("failed", failure.what());
      return Outcome::failed;
    }
    checkpoint();
    write_summary("done", "");
    return Outcome::done;
  }

 private:
  void start() {
    if (!m_.initial_velocity.empty()) {
      fem::State state = engine_.state();
      state.v = m_.initial_velocity;
      for (Vec3& v : state.v) v *= state.labour_per_pseudo;
      engine_.restore(state);
    }
    curves_ = std::make_unique<results::Curves>(o_.out / "curves.csv", column_names(m_));
    frames_ = std::make_unique<results::Frames>(o_.out, m_.model, strain_);
    results::write_atomically(o_.out / "scenario.resolved.yaml",
                              fmt::format("{}\n{}", results::build_line(o_.version, o_.commit), s_.resolved));
    frame();
  }

  void resume() {
    const auto c = results::read_checkpoint(checkpoint_file_);
    results::refuse_foreign(checkpoint_file_, c, scenario_hash_, mesh_hash_);
    curves_ = std::make_unique<results::Curves>(o_.out / "curves.csv", column_names(m_), std::size_t(c.rows));
    frames_ = std::make_unique<results::Frames>(o_.out, m_.model, strain_, c.frame_times);
    engine_.restore(c.state);
    next_ = std::size_t(c.stops);
    for (std::size_t k = 1; k < wall_.size() && k < c.wall.size(); ++k) wall_[k] += c.wall[k];
    log(fmt::format("resumed at {:.6g} s", c.state.time));
  }

  void advance() {
    const double t = times_[next_];
    const auto begin = Clock::now();
    engine_.advance_to(t);
    wall_[1] += seconds_since(begin);
    const auto solved = Clock::now();
    row();
    if (std::any_of(frame_times_.begin(), frame_times_.end(),
                    [&](double f) { return std::abs(f - t) < 1e-9 * s_.duration; }))
      frame();
    wall_[2] += seconds_since(solved);
    if (o_.progress) o_.progress(t, s_.duration);
    if (seconds_since(written_) > o_.checkpoint_every) checkpoint(1);
  }

  void row() {
    const auto& x = engine_.state().x;
    const auto seen = engine_.observe();
    observe::Values row{engine_.state().time};
    for (const auto& set : m_.watched) {
      Vec3 u = Vec3::Zero(), r = u, c = u;
      for (const auto n : set.nodes) {
        u += x[n] - m_.model.mesh.nodes[n];
        if (!seen.reaction.empty()) r += seen.reaction[n];
        if (!seen.contact_force.empty()) c += seen.contact_force[n];
      }
      u *= 1e3 / double(set.nodes.size());
      for (const Vec3& v : {u, r, c}) row.insert(row.end(), v.data(), v.data() + 3);
    }
    const double gap = std::isfinite(seen.least_gap) ? 1e3 * seen.least_gap : s_.contact_search * 1e3;
    for (const double v : {seen.kinetic, seen.internal, seen.external_work, seen.contact_work, seen.damping_work,
                           seen.relaxation_work, gap, seen.min_J})
      row.push_back(v);
    curves_->append(row);
    inverted_ = seen.inverted;
  }

  void frame() {
    const auto seen = engine_.observe();
    const auto& state = engine_.state();
    frames_->write(state, seen.contact_force, [&](vtkUnstructuredGrid& grid) {
      const auto stress = stress_.field(state.x);
      if (!seen.reaction.empty()) results::set_vectors(*grid.GetPointData(), "reaction", seen.reaction);
      set_stress(*grid.GetPointData(), "stress", stress.node);
      set_stress(*grid.GetCellData(), "stress", stress.tet);
      results::set_scalars(*grid.GetCellData(), "von_mises", stress.von_mises);
      results::set_scalars(*grid.GetCellData(), "pressure", stress.pressure);
    });
  }

  void checkpoint(std::size_t done = 0) {
    results::Checkpoint c;
    c.state = engine_.state();
    c.scenario_hash = scenario_hash_, c.mesh_hash = mesh_hash_, c.version = o_.version;
    c.rows = std::int64_t(curves_->table().rows.size()), c.stops = std::int64_t(next_ + done);
    c.frame_times = frames_->times();
    c.wall = {wall_.begin(), wall_.end()};
    results::write_checkpoint(checkpoint_file_, c);
    written_ = Clock::now();
  }

  void write_summary(const std::string& outcome, const std::string& reason) {
    const auto facts = engine_.facts();
    const auto& table = curves_->table();
    nlohmann::ordered_json j{{"kind", "model"}, {"name", s_.name}, {"outcome", outcome}};
    if (!reason.empty()) j["reason"] = reason;
    if (!table.rows.empty()) {
      for (std::size_t k = 0; k < table.names.size(); ++k) j["end"][table.names[k]] = table.rows.back()[k];
      const auto last = table.rows.size() - 1;
      const double in = table.at(last, "external_work_j") + table.at(last, "contact_work_j") +
                        table.at(last, "relaxation_work_j") - table.at(last, "damping_work_j");
      const double stored = table.at(last, "kinetic_j") + table.at(last, "internal_j");
      const double first = table.at(0, "kinetic_j") + table.at(0, "internal_j");
      const double most = std::max({std::abs(table.at(last, "external_work_j")), stored, first});
      // The implicit solver keeps no account of what imposed motions do.
      if (!s_.implicit) j["numerics"]["energy_balance_error"] = most > 0 ? std::abs(stored - first - in) / most : 0;
      j["numerics"]["kinetic_over_internal_end"] =
          table.at(last, "internal_j") > 0 ? table.at(last, "kinetic_j") / table.at(last, "internal_j") : 0;
    }
    auto& n = j["numerics"];
    n["elements"] = m_.model.mesh.tets.size(), n["nodes"] = m_.model.mesh.nodes.size();
    n["steps"] = facts.steps, n["time_step_s"] = facts.step.time_step, n["inverted"] = inverted_;
    n["unscaled_critical_step_s"] = facts.step.unscaled_critical_step;
    n["mass_scaled_fraction"] = facts.step.mass_scaled_fraction, n["time_scaling"] = s_.time_scaling;
    j["wall_s"] = {
        {"meshing", wall_[0]}, {"solving", wall_[1]}, {"output", wall_[2]}, {"total", wall_[0] + wall_[1] + wall_[2]}};
    j["threads"] = o_.threads, j["version"] = o_.version, j["commit"] = o_.commit;
    j["machine"] = results::machine_description();
    results::write_atomically(o_.out / "summary.json", j.dump(2) + "\n");
  }

  void log(const std::string& text) const {
    if (o_.log) o_.log(text);
  }

  const ModelScenario& s_;
  const GeneralModel& m_;
  results::Engine& engine_;
  const RunOptions& o_;
  observe::Strain strain_;
  observe::Stress stress_;
  fs::path checkpoint_file_;
  std::string scenario_hash_, mesh_hash_;
  std::vector<double> times_, frame_times_;
  std::array<double, 3> wall_{};  // meshing, solving, output
  std::size_t next_ = 0;
  int inverted_ = 0;
  std::unique_ptr<results::Curves> curves_;
  std::unique_ptr<results::Frames> frames_;
  Clock::time_point written_;
};

}  // namespace

std::unique_ptr<results::Engine> make_engine(const ModelScenario& s, const fem::Model& model) {
  if (s.implicit) return results::make_engine(model, implicit_options(s, model), s.duration);
  return results::make_engine(model, explicit_options(s, model));
}

Outcome run(const ModelScenario& scenario, const GeneralModel& model, results::Engine& engine,
            const RunOptions& options) {
  return Run(scenario, model, engine, options).run();
}

}  // namespace carus::general
