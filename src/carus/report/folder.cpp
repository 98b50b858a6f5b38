// SPDX-License-Identifier: Apache-2.0
#include "carus/report/folder.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>

#include "carus/core/error.hpp"
#include "carus/results/curves.hpp"
#include "carus/results/files.hpp"

namespace carus::report {
namespace {

namespace fs = std::filesystem;
using Json = nlohmann::json;

constexpr std::size_t log_bytes = 64 * 1024;
constexpr int deepest_json = 32;

/// Text of a file that may be missing; what is wrong with it becomes a note.
std::string optional_text(const fs::path& file, std::vector<std::string>& notes) {
  if (!fs::is_regular_file(file)) return {};
  try {
    return results::read_text(file);
  } catch (const InputError& e) {
    notes.push_back(e.what());
    return {};
  }
}

/// JSON from a folder; discarded if it is none, or nested deeper than anything that carus writes: what walks it
/// recurses.
Json parse_shallow(const std::string& text) {
  int depth = 0, deepest = 0;
  bool in_string = false;
  for (std::size_t i = 0; i < text.size(); ++i) {
    const char c = text[i];
    if (in_string) {
      if (c == '\\') ++i;
      if (c == '"') in_string = false;
      continue;
    }
    if (c == '"') in_string = true;
    if (c == '{' || c == '[') deepest = std::max(deepest, ++depth);
    if (c == '}' || c == ']') --depth;
  }
  if (deepest > deepest_json) return Json(Json::value_t::discarded);
  return Json::parse(text, nullptr, false);
}

void require_results_folder(const fs::path& path) {
  if (!fs::exists(path))
    throw InputError(
        fmt::format("{}: no such folder; give the one that carus run SCENARIO --out DIR wrote", path.string()));
  if (!fs::is_directory(path))
    throw InputError(
        fmt::format("{}: is no folder; give the one that carus run SCENARIO --out DIR wrote", path.string()));
  if (fs::is_regular_file(path / "curves.csv")) return;
  if (fs::is_regular_file(path / "scenario.resolved.yaml") || fs::is_regular_file(path / "log.txt"))
    throw InputError(
        fmt::format("{}: has no curves.csv: the run has not come to its first output; wait for it, or see {}",
                    path.string(), (path / "log.txt").string()));
  throw InputError(
      fmt::format("{}: is no results folder of carus (it has neither curves.csv nor scenario.resolved.yaml); give the "
                  "one that carus run SCENARIO --out DIR wrote",
                  path.string()));
}

void read_curves(Folder& f) {
  const auto file = f.path / "curves.csv";
  f.curves = results::read_curves(file);
  if (f.curves.names.empty() || f.curves.names[0] != "time_s")
    throw InputError(
        fmt::format("{}: is no table of carus: the first column is not time_s; run the birth again", file.string()));
  if (f.curves.rows.empty())
    throw InputError(fmt::format("{}: holds no outputs yet; wait for the run, or see {}", file.string(),
                                 (f.path / "log.txt").string()));
  for (std::size_t i = 0; i < f.curves.rows.size(); ++i) {
    const double t = f.curves.rows[i][0];
    if (!std::isfinite(t) || (i > 0 && t <= f.curves.rows[i - 1][0]))
      throw InputError(fmt::format("{}: line {}: time_s: {}; allowed are increasing numbers; run the birth again",
                                   file.string(), i + 2, t));
  }
}

void read_scenario(Folder& f) {
  const auto file = f.path / "scenario.resolved.yaml";
  f.scenario_yaml = optional_text(file, f.notes);
  if (f.scenario_yaml.empty()) {
    f.notes.push_back(fmt::format("{}: missing or empty; the run cannot be judged without it", file.string()));
    return;
  }
  try {
    f.scenario = scenario::parse(f.scenario_yaml, file);
  } catch (const std::exception& e) {
    const std::string what = e.what();
    f.notes.push_back(
        fmt::format("{}: not a scenario of this version of carus: {}", file.string(), what.substr(0, what.find('\n'))));
  }
}

void read_summary(Folder& f) {
  const auto file = f.path / "summary.json";
  if (!fs::is_regular_file(file)) {
    f.notes.push_back(fmt::format(
        "No summary.json: the run is in progress, or was interrupted (carus run SCENARIO --out {} --resume goes on).",
        f.path.string()));
    return;
  }
  const auto text = optional_text(file, f.notes);
  const auto j = parse_shallow(text);
  f.status = RunStatus::failed;
  if (!j.is_object()) {
    f.notes.push_back(fmt::format("{}: is damaged or cut off; run the birth again", file.string()));
    return;
  }
  f.summary_json = text;
  const auto outcome = j.find("outcome");
  if (outcome != j.end() && (*outcome == "born" || *outcome == "not_born")) f.status = RunStatus::finished;
  if (const auto reason = j.find("reason"); reason != j.end() && reason->is_string())
    f.notes.push_back("The run failed: " + reason->get<std::string>());
}

void read_events(Folder& f) {
  const auto text = optional_text(f.path / "events.jsonl", f.notes);
  std::size_t line = 0;
  for (std::size_t begin = 0, end; (end = text.find('\n', begin)) != std::string::npos; begin = end + 1) {
    ++line;
    auto one = text.substr(begin, end - begin);
    const auto j = parse_shallow(one);
    const bool fits = j.is_object() && j.contains("time_s") && j["time_s"].is_number() && j.contains("event") &&
                      j["event"].is_string();
    if (fits) {
      f.events.push_back(std::move(one));
    } else {
      f.notes.push_back(fmt::format("{}: line {} is no event; left out", (f.path / "events.jsonl").string(), line));
    }
  }
}

}  // namespace

const char* name_of(RunStatus status) {
  switch (status) {
    case RunStatus::finished:
      return "finished";
    case RunStatus::failed:
      return "failed";
    case RunStatus::in_progress:
      return "in_progress";
  }
  CARUS_ASSERT(false);
}

std::string Folder::name() const {
  if (scenario && !scenario->name.empty()) return scenario->name;
  const auto own = fs::absolute(path).lexically_normal();
  return own.has_filename() ? own.filename().string() : own.parent_path().filename().string();
}

Folder read_folder(const fs::path& path) {
  require_results_folder(path);
  Folder f;
  f.path = path;
  read_curves(f);
  read_scenario(f);
  read_summary(f);
  read_events(f);
  f.log = optional_text(path / "log.txt", f.notes);
  if (f.log.size() > log_bytes) {
    const auto cut = f.log.find('\n', f.log.size() - log_bytes);
    f.log = "...\n" + f.log.substr(cut == std::string::npos ? f.log.size() - log_bytes : cut + 1);
  }
  return f;
}

}  // namespace carus::report
