// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>
#include <spdlog/sinks/basic_file_sink.h>
#include <spdlog/sinks/stdout_color_sinks.h>
#include <spdlog/spdlog.h>
#include <unistd.h>

#include <atomic>
#include <chrono>
#include <cmath>
#include <csignal>
#include <filesystem>
#include <thread>

#include "app.hpp"
#include "carus/core/error.hpp"
#include "carus/core/parallel.hpp"
#include "carus/results/birth_run.hpp"
#include "carus/scenario/assemble.hpp"

namespace carus::app {
namespace {

std::atomic<bool> stop_requested{false};
static_assert(std::atomic<bool>::is_always_lock_free, "set from a signal handler");

struct RunArguments {
  std::string scenario, out;
  std::vector<std::string> overrides;
  int threads = 0, frames = -1;
  bool resume = false, json_events = false;
};

/// One line that overwrites itself on a terminal; on a pipe, a line now and then.
class ProgressLine {
 public:
  void operator()(const results::Progress& p) {
    const auto now = std::chrono::steady_clock::now();
    const bool last = p.time >= p.labour_duration;
    if (!last && now - shown_ < (terminal_ ? std::chrono::milliseconds(200) : std::chrono::milliseconds(5000))) return;
    shown_ = now;
    const std::string left = std::isfinite(p.wall_left) ? fmt::format("{:.0f} s left", p.wall_left) : "";
    fmt::print(stderr, "{}labour {:5.1f} of {:.1f} min  contraction {}  station {:+6.1f} mm  head z {:+7.1f} mm  {}{}",
               terminal_ ? "\r" : "", p.time / 60, p.labour_duration / 60, p.contractions, p.station, p.head_z, left,
               terminal_ ? "   " : "\n");
    open_ = terminal_;
  }
  ~ProgressLine() {
    if (open_) fmt::print(stderr, "\n");
  }

 private:
  bool terminal_ = isatty(STDERR_FILENO) != 0, open_ = false;
  std::chrono::steady_clock::time_point shown_{};
};

void open_log(const std::filesystem::path& out, bool resume) {
  auto file = std::make_shared<spdlog::sinks::basic_file_sink_mt>((out / "log.txt").string(), !resume);
  auto logger = std::make_shared<spdlog::logger>(
      "carus", spdlog::sinks_init_list{file, std::make_shared<spdlog::sinks::stderr_color_sink_mt>()});
  logger->sinks()[1]->set_pattern("%^%v%$");
  logger->flush_on(spdlog::level::info);
  spdlog::set_default_logger(logger);
}

void tell_plan(const scenario::Scenario& s, const fem::Model& model, const results::Engine::Facts& f) {
  spdlog::info("{}: {} elements, {} nodes", s.name, model.mesh.tets.size(), model.mesh.nodes.size());
  spdlog::info(
      "{} steps of {:.3g} s (unscaled critical step {:.3g} s, limited by {}; mass added {:.2f} %); 1 s of pseudo-time "
      "is {:.0f} s of labour",
      f.steps, f.step.time_step, f.step.unscaled_critical_step, f.step.limiting_region,
      100 * f.step.mass_scaled_fraction, f.labour_per_pseudo);
}

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

/// What stops a run before it starts belongs in its log too.
template <class F>
auto logged(F&& f) {
  try {
    return f();
  } catch (const std::exception& e) {
    spdlog::default_logger()->sinks()[0]->log({"carus", spdlog::level::err, e.what()});
    spdlog::default_logger()->flush();
    throw;
  }
}

int run(RunArguments a) {
  if (a.frames >= 0) a.overrides.push_back(fmt::format("output.frames={}", a.frames));
  if (a.threads > 0) a.overrides.push_back(fmt::format("numerics.threads={}", a.threads));
  const auto s = scenario::load(a.scenario, a.overrides);
  results::prepare_folder(a.out, a.resume);
  open_log(a.out, a.resume);
  for (const auto& w : s.warnings) spdlog::warn("{}", w);
  spdlog::info("carus {} ({}): meshing", CARUS_VERSION, CARUS_COMMIT);
  const auto begin = std::chrono::steady_clock::now();
  const parallel::Threads threads(s.numerics.threads);
  const auto anatomy = logged([&] { return build_anatomy(s.anatomy); });
  for (const auto& w : anatomy.warnings) spdlog::warn("{}", w);
  const auto assembly = scenario::assemble(s, anatomy);
  const auto engine = results::make_engine(s, assembly.model);
  tell_plan(s, assembly.model, engine->facts());

  ProgressLine line;
  results::RunOptions o;
  o.out = a.out, o.resume = a.resume, o.version = CARUS_VERSION, o.commit = CARUS_COMMIT;
  o.wall_meshing = std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
  o.threads = s.numerics.threads > 0 ? s.numerics.threads : int(std::thread::hardware_concurrency());
  o.stop = &stop_requested;
  o.progress = [&](const results::Progress& p) { line(p); };
  o.log = [](const std::string& text) { spdlog::info("{}", text); };
  if (a.json_events) o.event = [](const std::string& text) { fmt::print("{}\n", text), std::fflush(stdout); };
  const auto outcome = results::run_birth(s, assembly.model, results::observer_setup(s, assembly, anatomy), *engine, o);
  constexpr const char* words[] = {"born", "not born", "failed", "interrupted"};
  spdlog::info("{}; results in {}", words[int(outcome)], a.out);
  return status_of(outcome);
}

}  // namespace

void add_run(CLI::App& app, int& status) {
  auto a = std::make_shared<RunArguments>();
  auto* c = app.add_subcommand("run", "Run a birth and write its results folder");
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
      "Ctrl-C writes a checkpoint and exits with status 4.");
  c->callback([a, &status] {
    // async-signal-safe: only a flag is set; the loop looks at it between stops.
    for (const int signal : {SIGINT, SIGTERM}) std::signal(signal, [](int) { stop_requested = true; });
    status = run(*a);
  });
}

}  // namespace carus::app
