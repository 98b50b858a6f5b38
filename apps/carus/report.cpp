// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include <chrono>
#include <cstdio>
#include <filesystem>

#include "app.hpp"
#include "carus/core/error.hpp"
#include "carus/report/manifest.hpp"
#include "carus/report/page.hpp"
#include "carus/results/files.hpp"
#include "version.hpp"
#include "viewer.hpp"

namespace carus::app {
namespace {

namespace fs = std::filesystem;

constexpr double comfortable = 25e6;  // bytes: what a mail or a laptop's browser takes without thought

struct ReportArguments {
  std::vector<std::string> folders;
  std::string out, ghost, viewer;
  bool check = false;
};

/// All folders are read before anything is said: every problem at once.
template <class T, class Read>
std::vector<T> read_all(const std::vector<std::string>& folders, Read read) {
  std::vector<T> all;
  std::vector<std::string> problems;
  for (const auto& folder : folders) {
    try {
      all.push_back(read(folder));
    } catch (const InputError& e) {
      problems.insert(problems.end(), e.problems().begin(), e.problems().end());
    }
  }
  if (!problems.empty()) throw InputError(problems);
  return all;
}

int check(const std::vector<std::string>& paths) {
  const auto folders = read_all<report::Folder>(paths, [](const std::string& p) { return report::read_folder(p); });
  bool met = true;
  for (const auto& f : folders) {
    const auto verdict = report::judge(f);
    if (!f.scenario) throw InputError(verdict.line);
    fmt::print("{}{}", &f == &folders.front() ? "" : "\n", report::as_text(f, verdict));
    met = met && verdict.met;
  }
  if (folders.size() > 1) fmt::print("\n{}\n", met ? "MET: by every run" : "NOT MET: not by every run");
  return met ? done : not_met;
}

int index_of(const std::vector<std::string>& folders, const std::string& folder) {
  for (std::size_t i = 0; i < folders.size(); ++i) {
    std::error_code no_error;
    if (fs::equivalent(folders[i], folder, no_error)) return int(i);
  }
  return -1;
}

void write_report(ReportArguments a) {
  const auto begin = std::chrono::steady_clock::now();
  const std::string viewer = viewer_page(a.viewer);
  report::ManifestOptions options;
  options.version = program_version, options.commit = program_commit, options.created = report::utc_now();
  const auto own = a.folders.size();
  if (!a.ghost.empty()) {
    options.ghost = index_of(a.folders, a.ghost);
    if (options.ghost < 0) options.ghost = int(a.folders.size()), a.folders.push_back(a.ghost);
  }
  const auto runs = read_all<report::Run>(a.folders, [](const std::string& p) { return report::read_run(p); });
  for (const auto& run : runs) {
    for (const auto& note : run.folder.notes) fmt::print(stderr, "note: {}\n", note);
    if (run.packer) {
      for (const auto& note : run.packer->notes()) fmt::print(stderr, "note: {}\n", note);
    }
  }
  const auto manifest = report::manifest_of(runs, options);
  std::vector<std::string> blobs;
  for (const auto& blob : manifest.blobs) blobs.push_back(blob.bytes);
  const auto page = report::page(viewer, manifest.json, blobs);
  const fs::path out =
      !a.out.empty() ? fs::path(a.out) : fs::path(a.folders[0]) / (own == 1 ? "report.html" : "comparison.html");
  results::write_atomically(out, page);
  fmt::print("{}: {:.1f} MB, {:.1f} s\n", out.string(), double(page.size()) / 1e6,
             std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count());
  if (double(page.size()) > comfortable)
    fmt::print(stderr, "note: more than 25 MB is slow to open; carus serve {} shows the same piece by piece\n",
               a.folders[0]);
  for (std::size_t i = 0; i < own; ++i) fmt::print("{}: {}\n", a.folders[i], runs[i].verdict.line);
}

int report_or_check(const ReportArguments& a) {
  int status = done;
  if (!a.check || !a.out.empty()) write_report(a);
  if (a.check) status = check(a.folders);
  return status;
}

}  // namespace

std::string viewer_page(const std::string& file) {
  if (!file.empty()) return results::read_text(file);
  if (report::built_in_viewer().empty())
    throw InputError(
        "this carus was built without the viewer (web/dist/viewer.html was missing); build it with ./dev build, or "
        "name one with --viewer");
  return std::string(report::built_in_viewer());
}

void add_report(CLI::App& app, int& status) {
  auto a = std::make_shared<ReportArguments>();
  auto* c = app.add_subcommand("report", "Turn results folders into one page that opens in a browser, from disk");
  c->add_option("DIR", a->folders, "Results folders of carus run; the first is the one shown")->required();
  c->add_option("--out", a->out, "The page to write; default DIR/report.html, of several runs DIR/comparison.html");
  c->add_option("--ghost", a->ghost, "A run that is drawn as a ghost over the first one");
  c->add_flag("--check", a->check,
              "Print each parameter that a run is judged by, the verdict last; exit status 1 if it is not met");
  c->add_option("--viewer", a->viewer, "Another viewer.html than the built-in one")->check(CLI::ExistingFile);
  c->footer(
      "Examples:\n"
      "  carus report out/reference\n"
      "  carus report out/reference out/softer --out both.html\n"
      "  carus report out/reference --ghost out/softer\n"
      "  carus report out/reference --check");
  c->callback([a, &status] { status = report_or_check(*a); });
}

}  // namespace carus::app
