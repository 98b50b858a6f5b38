// SPDX-License-Identifier: Apache-2.0
#include "birth.hpp"

#include <fmt/format.h>
#include <spdlog/sinks/basic_file_sink.h>
#include <spdlog/sinks/stdout_color_sinks.h>
#include <spdlog/spdlog.h>
#include <unistd.h>

#include <atomic>
#include <cmath>
#include <csignal>
#include <thread>

#include "carus/core/error.hpp"
#include "carus/core/parallel.hpp"
#include "carus/scenario/assemble.hpp"
#include "version.hpp"

namespace carus::app {
namespace {

std::atomic<bool> stop_requested{false};
static_assert(std::atomic<bool>::is_always_lock_free, "set from a signal handler");

void tell_plan(const scenario::Scenario& s, const fem::Model& model, const results::Engine::Facts& f) {
  spdlog::info("{}: {} elements, {} nodes", s.name, model.mesh.tets.size(), model.mesh.nodes.size());
  spdlog::info("{}", f.plan);
}

}  // namespace

void open_log(const std::filesystem::path& out, bool resume, bool to_terminal) {
  std::vector<spdlog::sink_ptr> sinks{
      std::make_shared<spdlog::sinks::basic_file_sink_mt>((out / "log.txt").string(), !resume)};
  if (to_terminal) {
    sinks.push_back(std::make_shared<spdlog::sinks::stderr_color_sink_mt>());
    sinks.back()->set_pattern("%^%v%$");
  }
  auto logger = std::make_shared<spdlog::logger>("carus", sinks.begin(), sinks.end());
  logger->flush_on(spdlog::level::info);
  spdlog::set_default_logger(logger);
}

const std::atomic<bool>* stop_flag() { return &stop_requested; }

void stop_on_signals() {
  // async-signal-safe: only a flag is set; the loop looks at it between stops.
  for (const int signal : {SIGINT, SIGTERM}) std::signal(signal, [](int) { stop_requested = true; });
}

results::Outcome birth(const scenario::Scenario& s, const BirthOptions& options) {
  results::prepare_folder(options.out, options.resume);
  open_log(options.out, options.resume, options.log_to_terminal);
  for (const auto& w : s.warnings) spdlog::warn("{}", w);
  spdlog::info("carus {} ({}): meshing", program_version, program_commit);
  const auto begin = std::chrono::steady_clock::now();
  const parallel::Threads threads(s.numerics.threads);
  const auto anatomy = logged([&] { return build_anatomy(s); });
  for (const auto& w : anatomy.warnings) spdlog::warn("{}", w);
  const auto assembly = logged([&] { return scenario::assemble(s, anatomy); });
  const auto engine = logged([&] { return results::make_engine(s, assembly.model); });
  tell_plan(s, assembly.model, engine->facts());

  results::RunOptions o;
  o.out = options.out, o.resume = options.resume, o.version = program_version, o.commit = program_commit;
  o.wall_meshing = std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
  o.threads = s.numerics.threads > 0 ? s.numerics.threads : int(std::thread::hardware_concurrency());
  o.stop = &stop_requested;
  o.progress = options.progress, o.event = options.event;
  o.log = [](const std::string& text) { spdlog::info("{}", text); };
  const auto outcome = results::run_birth(s, assembly.model, results::observer_setup(s, assembly, anatomy), *engine, o);
  constexpr const char* words[] = {"born", "not born", "failed", "interrupted"};
  spdlog::info("{}; results in {}", words[int(outcome)], options.out.string());
  return outcome;
}

ProgressLine::ProgressLine() : terminal_(isatty(STDERR_FILENO) != 0) {}

ProgressLine::~ProgressLine() {
  if (open_) fmt::print(stderr, "\n");
}

void ProgressLine::operator()(const results::Progress& p) {
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

void ProgressLine::clear() {
  if (open_) fmt::print(stderr, "\r{:100}\r", "");
  open_ = false;
}

}  // namespace carus::app
