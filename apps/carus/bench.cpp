// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <optional>
#include <thread>

#include "app.hpp"
#include "carus/results/checkpoint.hpp"
#include "carus/results/engine.hpp"
#include "carus/scenario/assemble.hpp"
#include "scenes.hpp"
#include "version.hpp"

namespace carus::app {
namespace {

struct BenchArguments {
  std::string scenario = "scenarios/reference.yaml";
  std::vector<std::string> overrides;
  std::filesystem::path from;
  int steps = 0, repeats = 5, threads = 0;
  bool only_block = false;
};

using Stages = std::vector<std::pair<std::string, double>>;  ///< [s]; the first is the whole

/// What a time is told in: nanoseconds for each element and step, or milliseconds for each Newton iteration.
enum class Per { element, iteration };

/// Repeats a measurement and prints for each stage the least time, its share of the whole and how far the slowest
/// repetition was off.
template <class Measure>
void print_scene(const std::string& scene, Per per, std::size_t tets, int threads, int repeats, Measure&& measure) {
  std::vector<std::vector<double>> times;  // per stage, one per repetition
  std::vector<std::string> names;
  for (int k = 0; k < repeats; ++k) {
    const auto [stages, passes] = measure();
    times.resize(stages.size()), names.resize(stages.size());
    for (std::size_t i = 0; i < stages.size(); ++i) {
      names[i] = stages[i].first;
      times[i].push_back(stages[i].second / double(passes) * (per == Per::element ? 1e9 / double(tets) : 1e3));
    }
  }
  const double whole = *std::min_element(times[0].begin(), times[0].end());
  for (std::size_t i = 0; i < times.size(); ++i) {
    const auto [least, most] = std::minmax_element(times[i].begin(), times[i].end());
    if (*most <= 0) continue;  // a stage that the scene has not
    fmt::print("{:<34}{:>8}{:>9}  {:<20}{:>8.2f} {:<5}{:>5.0f} %{:>8.0f} %\n", i == 0 ? scene : "",
               i == 0 ? fmt::format("{}", tets) : "", i == 0 ? fmt::format("{}", threads) : "", names[i], *least,
               per == Per::element ? "ns/e" : "ms/it", 100 * *least / whole,
               *least > 0 ? 100 * (*most / *least - 1) : 0);
  }
}

double seconds_since(std::chrono::steady_clock::time_point t) {
  return std::chrono::duration<double>(std::chrono::steady_clock::now() - t).count();
}

void bench_kernel(int repeats) {
  const fem::Model model = bench::block(false);
  bench::Kernel kernel(model);
  constexpr int passes = 50;
  print_scene(fmt::format("element kernel ({})", fem::kernel().name), Per::element, model.mesh.tets.size(), 1, repeats,
              [&] {
                const auto begin = std::chrono::steady_clock::now();
                for (int k = 0; k < passes; ++k) kernel.forces();
                return std::pair(Stages{{"whole", seconds_since(begin)}}, passes);
              });
}

/// Time of each stage between two readings, with the whole in front.
Stages between(const Stages& before, const Stages& after, double whole) {
  Stages out{{"whole", whole}};
  for (std::size_t i = 0; i < after.size(); ++i) out.emplace_back(after[i].first, after[i].second - before[i].second);
  return out;
}

void bench_step(int threads, bool nodal_pressure, int repeats) {
  const fem::Model model = bench::block(nodal_pressure);
  const auto options = bench::step_options(threads);
  solve::Explicit solver(model, options);
  constexpr int steps = 100;
  double t = 0;
  print_scene(nodal_pressure ? "step, average nodal pressure" : "step", Per::element, model.mesh.tets.size(), threads,
              repeats, [&] {
                const auto before = solver.timings();
                const auto begin = std::chrono::steady_clock::now();
                solver.advance_to(t += steps * options.time_step);
                return std::pair(between(before, solver.timings(), seconds_since(begin)), steps);
              });
}

/// The state that a run has left in its folder.
fem::State state_of(const std::filesystem::path& run, const scenario::Scenario& s, const mesh::TetMesh& mesh) {
  const auto file = run / "checkpoint.h5";
  auto checkpoint = results::read_checkpoint(file);
  results::refuse_foreign(file, checkpoint, results::hash_of(s), results::hash_of(mesh));
  return std::move(checkpoint.state);
}

/// Steps of a labour: the first ones, or those after the state of a run; the same ones in each repetition. By default
/// as many as reach the first contraction.
void bench_birth(scenario::Scenario s, const BenchArguments& a, const std::vector<int>& threads) {
  const auto anatomy = build_anatomy(s);
  const auto assembly = scenario::assemble(s, anatomy);
  std::optional<fem::State> start;
  if (!a.from.empty()) start = state_of(a.from, s, assembly.model.mesh);
  const bool newton = s.solver == scenario::SolverKind::implicit_dynamics;
  const int steps = a.steps > 0 ? a.steps : newton ? 10 : 2000;
  const auto where = start ? fmt::format("after {:.1f} min", start->time / 60) : "first steps";
  for (const int n : threads) {
    s.numerics.threads = n;
    const auto scene = fmt::format("{}, {}, {}", s.name, scenario::name_of(s.resolution), where);
    print_scene(scene, newton ? Per::iteration : Per::element, assembly.model.mesh.tets.size(), n, a.repeats, [&] {
      const auto engine = results::make_engine(s, assembly.model);
      const auto facts = engine->facts();
      if (start) engine->restore(*start);
      const auto first = engine->iterations();
      const auto before = engine->timings();
      const auto begin = std::chrono::steady_clock::now();
      engine->advance_to(engine->state().time + steps * facts.step.time_step * engine->state().labour_per_pseudo);
      const double whole = seconds_since(begin);
      return std::pair(between(before, engine->timings(), whole),
                       int(std::max<std::int64_t>(1, engine->iterations() - first)));
    });
  }
}

std::string processor() {
  std::ifstream in("/proc/cpuinfo");
  for (std::string line; std::getline(in, line);) {
    if (line.starts_with("model name")) return line.substr(line.find(':') + 2);
  }
  return "unknown processor";
}

void bench_all(const BenchArguments& a) {
  // Read first: what is wrong with it is not to be told after a minute.
  const auto s = a.only_block ? scenario::Scenario{} : scenario::load(a.scenario, a.overrides);
  const int cores = int(std::max(1u, std::thread::hardware_concurrency()));
  std::vector<int> threads{1};
  if (const int most = a.threads > 0 ? a.threads : cores; most > 1) threads.push_back(most);
  double load = 0;
  const bool known = getloadavg(&load, 1) == 1;
  fmt::print("carus {} ({}) on {}, {} cores, {}; least of {} repetitions, and how much slower the slowest was\n\n",
             program_version, program_commit, processor(), cores,
             known ? fmt::format("load {:.1f} before", load) : "load unknown", a.repeats);
  fmt::print("{:<34}{:>8}{:>9}  {:<20}{:>14}{:>7}{:>10}\n", "scene", "tets", "threads", "stage", "time", "share",
             "spread");
  bench_kernel(a.repeats);
  for (const bool nodal_pressure : {false, true})
    for (const int n : threads) bench_step(n, nodal_pressure, a.repeats);
  if (!a.only_block) bench_birth(s, a, threads);
  fmt::print("\nns/e: nanoseconds per element and step; ms/it: milliseconds per Newton iteration.\n");
}

}  // namespace

void add_bench(CLI::App& app, int& status) {
  auto a = std::make_shared<BenchArguments>();
  auto* c =
      app.add_subcommand("bench", "Measure the solver: time per element and step, or per Newton iteration, by stage");
  c->add_option("SCENARIO", a->scenario, "Scenario whose first steps are measured; scenarios/reference.yaml if silent");
  c->add_option("--steps", a->steps,
                "Steps of the birth; if silent 2000, or 10 of the implicit solver: into the first contraction")
      ->check(CLI::Range(1, 10000000));
  c->add_option("--from", a->from,
                "Results folder of an unfinished run of the scenario: measure from its checkpoint on")
      ->check(CLI::ExistingDirectory);
  c->add_option("--repeats", a->repeats, "Repetitions of each measurement")->check(CLI::Range(1, 1000));
  c->add_option("--threads", a->threads, "Measure with one thread and with this many; 0: all")
      ->check(CLI::Range(0, 1024));
  c->add_option("--set", a->overrides, "Override a key of the scenario, path.to.key=value; may be given again")
      ->expected(1)
      ->take_all();
  c->add_flag("--only-block", a->only_block, "Leave the birth out: no scenario, no meshing");
  c->footer(
      "Examples:\n  carus bench\n  carus bench scenarios/reference.yaml --set resolution=coarse --steps 500\n"
      "  carus bench scenarios/reference.yaml --set resolution=coarse --set solver.kind=implicit --repeats 2\n"
      "  carus bench scenarios/reference.yaml --from out/demo --steps 500\n  carus bench --only-block --threads 1");
  c->callback([a, &status] { bench_all(*a), status = done; });
}

}  // namespace carus::app
