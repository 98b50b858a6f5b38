// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include <cstdio>

#include "birth.hpp"
#include "carus/core/error.hpp"
#include "carus/scenario/model_scenario.hpp"
#include "model.hpp"

namespace carus::app {
namespace {

struct RunArguments {
  std::string scenario, out;
  std::vector<std::string> overrides;
  int threads = 0, frames = -1;
  bool resume = false, json_events = false;
};

int status_of(results::Outcome outcome) {
  switch (outcome) {
    case results::Outcome::born:
    case results::Outcome::not_born:
      return done;
    case results::Outcome::failed:
      return numerical_failure;
    case results::Outcome::interrupted:
      return interrupted;
  }
  std::abort();
}

int run(RunArguments a) {
  if (a.frames >= 0) a.overrides.push_back(fmt::format("output.frames={}", a.frames));
  if (a.threads > 0) a.overrides.push_back(fmt::format("numerics.threads={}", a.threads));
  if (scenario::kind_of(a.scenario, a.overrides) == scenario::Kind::model)
    return run_model(scenario::load_model(a.scenario, a.overrides), a.out, a.resume);
  const auto s = scenario::load(a.scenario, a.overrides);
  ProgressLine line;
  BirthOptions o;
  o.out = a.out, o.resume = a.resume;
  o.progress = [&](const results::Progress& p) { line(p); };
  if (a.json_events) o.event = [](const std::string& text) { fmt::print("{}\n", text), std::fflush(stdout); };
  return status_of(birth(s, o));
}

}  // namespace

void add_run(CLI::App& app, int& status) {
  auto a = std::make_shared<RunArguments>();
  auto* c = app.add_subcommand("run", "Run a birth, or a general model, and write its results folder");
  c->add_option("SCENARIO", a->scenario, "Scenario file (YAML)")->required();
  c->add_option("--out", a->out, "Results folder; what an earlier run left in it is replaced")->required();
  c->add_option("--threads", a->threads, "Threads; 0: all. The results do not depend on it")
      ->check(CLI::Range(0, 1024));
  c->add_option("--set", a->overrides, "Override a key of the scenario, path.to.key=value; may be given again")
      ->expected(1)
      ->take_all();
  c->add_option("--frames", a->frames, "Frames over the labour (output.frames)")->check(CLI::Range(0, 100000));
  c->add_flag("--resume", a->resume, "Go on from DIR/checkpoint.h5; same scenario and overrides");
  c->add_flag("--json-events", a->json_events, "Print each event as a line of JSON");
  c->footer(
      "Examples:\n"
      "  carus run scenarios/reference.yaml --out out/reference\n"
      "  carus run scenarios/reference.yaml --out out/coarse --set resolution=coarse --set fetus.position=LOA\n"
      "  carus run scenarios/reference.yaml --out out/reference --resume\n"
      "  carus run scenarios/models/cantilever.yaml --out out/cantilever\n"
      "Ctrl-C writes a checkpoint and exits with status 4.");
  c->callback([a, &status] {
    stop_on_signals();
    status = run(*a);
  });
}

}  // namespace carus::app
