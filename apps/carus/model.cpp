// SPDX-License-Identifier: Apache-2.0
#include "model.hpp"

#include <fmt/format.h>
#include <spdlog/spdlog.h>

#include <chrono>
#include <thread>

#include "birth.hpp"
#include "carus/core/parallel.hpp"
#include "carus/general/run.hpp"
#include "version.hpp"

namespace carus::app {

int run_model(const scenario::ModelScenario& s, const std::filesystem::path& out, bool resume) {
  results::prepare_folder(out, resume);
  open_log(out, resume, true);
  for (const auto& w : s.warnings) spdlog::warn("{}", w);
  spdlog::info("carus {} ({}): {}", program_version, program_commit, s.name);
  const auto begin = std::chrono::steady_clock::now();
  const parallel::Threads threads(s.threads);
  const auto model = logged([&] { return general::build(s, general::gather_meshes(s)); });
  for (const auto& note : model.notes) spdlog::info("{}", note);
  const auto engine = logged([&] { return general::make_engine(s, model.model); });
  const auto facts = engine->facts();
  spdlog::info("{} elements, {} nodes, {} steps of {:.3g} s (mass added {:.2f} %)", model.model.mesh.tets.size(),
               model.model.mesh.nodes.size(), facts.steps, facts.step.time_step, 100 * facts.step.mass_scaled_fraction);
  general::RunOptions o;
  o.out = out, o.resume = resume, o.version = program_version, o.commit = program_commit;
  o.wall_meshing = std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
  o.threads = s.threads > 0 ? s.threads : int(std::thread::hardware_concurrency());
  o.stop = stop_flag();
  o.log = [](const std::string& text) { spdlog::info("{}", text); };
  auto shown = begin;
  o.progress = [&](double time, double duration) {
    const auto now = std::chrono::steady_clock::now();
    if (now - shown < std::chrono::seconds(5)) return;
    shown = now;
    spdlog::info("{:.4g} of {:.4g} s", time, duration);
  };
  const auto outcome = general::run(s, model, *engine, o);
  constexpr const char* words[] = {"done", "failed", "interrupted"};
  constexpr int status[] = {done, numerical_failure, interrupted};
  spdlog::info("{}; results in {}", words[int(outcome)], out.string());
  return status[int(outcome)];
}

int check_model(const scenario::ModelScenario& s) {
  for (const auto& w : s.warnings) fmt::print("warning: {}\n", w);
  const auto model = general::build(s, general::gather_meshes(s));
  const auto engine = general::make_engine(s, model.model);
  for (const auto& note : model.notes) fmt::print("{}\n", note);
  fmt::print("{} elements, {} nodes, {} steps\n", model.model.mesh.tets.size(), model.model.mesh.nodes.size(),
             engine->facts().steps);
  fmt::print("{}: ok\n", s.file);
  return done;
}

}  // namespace carus::app
