// SPDX-License-Identifier: Apache-2.0
#include "carus/study/study.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "birth.hpp"
#include "version.hpp"

namespace carus::app {
namespace {

struct StudyArguments {
  std::string scenario, out, variants;
  std::vector<std::string> overrides;
  int threads = 0, frames = 0;
};

int status_of(const study::Table& table) {
  if (table.interrupted) return interrupted;
  const auto any = [&](const char* outcome) {
    return std::any_of(table.entries.begin(), table.entries.end(),
                       [&](const study::Entry& e) { return e.measures.outcome == outcome; });
  };
  if (any("refused")) return bad_input;
  return any("failed") ? numerical_failure : done;
}

int study_of(StudyArguments a) {
  const auto file = study::find_variants(a.variants, a.scenario);
  a.overrides.push_back(fmt::format("output.frames={}", a.frames));
  if (a.threads > 0) a.overrides.push_back(fmt::format("numerics.threads={}", a.threads));
  const auto rows = study::rows_of(a.scenario, a.overrides, study::read_variants(file));

  ProgressLine line;
  study::Options o;
  o.out = a.out, o.scenario = a.scenario, o.variants = file, o.version = program_version, o.commit = program_commit;
  o.run = [&](const scenario::Scenario& s, const std::filesystem::path& folder, bool resume) {
    BirthOptions b;
    b.out = folder, b.resume = resume, b.log_to_terminal = false;
    if (line.on_terminal()) b.progress = [&](const results::Progress& p) { line(p); };
    return birth(s, b);
  };
  o.tell = [&](const std::string& text) { line.clear(), fmt::print(stderr, "{}\n", text); };
  const auto table = study::run(rows, o);
  fmt::print("{}", study::markdown(table));
  return status_of(table);
}

}  // namespace

void add_study(CLI::App& app, int& status) {
  auto a = std::make_shared<StudyArguments>();
  auto* c = app.add_subcommand("study", "Run a scenario and variants of it, and write one table");
  c->add_option("SCENARIO", a->scenario, "Scenario file (YAML): the base row")->required();
  c->add_option("--variants", a->variants,
                "File of variants (YAML), or the name of one in studies/ beside the scenario")
      ->required();
  c->add_option("--out", a->out, "Folder for study.md, study.json and a results folder per row")->required();
  c->add_option("--threads", a->threads, "Threads; 0: all. The results do not depend on it")
      ->check(CLI::Range(0, 1024));
  c->add_option("--set", a->overrides, "Override a key in every row, path.to.key=value; a row's own settings win")
      ->expected(1)
      ->take_all();
  c->add_option("--frames", a->frames, "Frames over the labour in each row; 0, the default: none")
      ->check(CLI::Range(0, 100000));
  c->footer(
      "Examples:\n"
      "  carus study scenarios/reference.yaml --variants robustness --out out/robustness\n"
      "  carus study scenarios/reference.yaml --variants contact --out out/contact --set resolution=coarse\n"
      "  carus study mine.yaml --variants mine_variants.yaml --out out/mine\n"
      "Rows that are complete are not run again, so the same command goes on after Ctrl-C (status 4) or a kill.\n"
      "Exit status: 0 done (born or not), 2 bad input or a row refused, 3 a row failed numerically, 4 interrupted.");
  c->callback([a, &status] {
    stop_on_signals();
    status = study_of(*a);
  });
}

}  // namespace carus::app
