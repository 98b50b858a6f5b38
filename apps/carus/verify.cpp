// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include <algorithm>
#include <cstdio>
#include <filesystem>

#include "app.hpp"
#include "carus/core/error.hpp"
#include "carus/results/files.hpp"
#include "carus/results/summary.hpp"
#include "carus/verify/problem.hpp"
#include "version.hpp"

namespace carus::app {
namespace {

struct VerifyArguments {
  std::vector<std::string> only;
  std::string table, page;
  bool quick = false, list = false;
};

const verify::Problem& named(const std::string& name) {
  const auto& all = verify::problems();
  const auto it = std::find_if(all.begin(), all.end(), [&](const auto& p) { return p.name == name; });
  if (it != all.end()) return *it;
  std::string names;
  for (const auto& p : all) names += (names.empty() ? "" : ", ") + p.name;
  throw InputError(fmt::format("--only: no problem \"{}\"; allowed {}", name, names));
}

int verify_all(const VerifyArguments& a) {
  std::vector<const verify::Problem*> chosen;
  for (const auto& name : a.only) chosen.push_back(&named(name));
  if (chosen.empty()) {
    for (const auto& p : verify::problems()) {
      if (!a.quick || p.quick) chosen.push_back(&p);
    }
  }
  if (a.list) {
    for (const auto* p : chosen) fmt::print("{:<18}{} {}\n", p->name, p->quick ? "      " : "(slow)", p->title);
    return done;
  }
  std::vector<verify::Outcome> outcomes;
  for (const auto* p : chosen) {
    outcomes.push_back(verify::run(*p));
    fmt::print("{}", verify::as_text(outcomes.back()));
    std::fflush(stdout);
  }
  if (!a.table.empty()) results::write_atomically(a.table, verify::as_csv(outcomes));
  if (!a.page.empty())
    results::write_atomically(a.page,
                              verify::as_markdown(outcomes, results::machine_description(),
                                                  fmt::format("carus {} ({})", program_version, program_commit)));
  fmt::print("{}\n", verify::verdict(outcomes));
  return std::all_of(outcomes.begin(), outcomes.end(), [](const auto& o) { return o.met(); }) ? done : not_met;
}

}  // namespace

void add_verify(CLI::App& app, int& status) {
  auto a = std::make_shared<VerifyArguments>();
  auto* c = app.add_subcommand("verify", "Compute the verification problems and hold them against their references");
  c->add_flag("--quick", a->quick, "Leave out the problems that take minutes");
  c->add_option("--only", a->only, "These problems only; may be given again")->expected(1)->take_all();
  c->add_flag("--list", a->list, "Name the problems, compute nothing");
  c->add_option("--table", a->table, "Write all checks as CSV");
  c->add_option("--page", a->page, "Write them as the page docs/theory/verification.md");
  c->footer(
      "Examples:\n"
      "  carus verify --quick\n"
      "  carus verify --table out/verification.csv --page docs/theory/verification.md\n"
      "  carus verify --only thick_sphere --only cantilever\n"
      "The verdict is the last line, and the exit status: 0 met, 1 not met.");
  c->callback([a, &status] { status = verify_all(*a); });
}

}  // namespace carus::app
