// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include "app.hpp"
#include "carus/core/error.hpp"
#include "carus/scenario/assemble.hpp"
#include "carus/scenario/model_scenario.hpp"
#include "model.hpp"

namespace carus::app {
namespace {

int check(const std::string& file, const std::vector<std::string>& overrides) {
  if (scenario::kind_of(file, overrides) == scenario::Kind::model)
    return check_model(scenario::load_model(file, overrides));
  const auto s = scenario::load(file, overrides);
  for (const auto& w : s.warnings) fmt::print("warning: {}\n", w);
  const auto anatomy = build_anatomy(s);
  for (const auto& w : anatomy.warnings) fmt::print("warning: {}\n", w);
  int errors = 0;
  for (const auto& finding : scenario::preflight(s, anatomy)) {
    fmt::print("{}\n", finding);
    errors += finding.starts_with("error");
  }
  if (errors == 0) static_cast<void>(scenario::assemble(s, anatomy));
  fmt::print("{}: {}\n", file, errors ? fmt::format("refused, {} error{}", errors, errors > 1 ? "s" : "") : "ok");
  return errors ? bad_input : done;
}

}  // namespace

void add_check(CLI::App& app, int& status) {
  struct Arguments {
    std::string scenario;
    std::vector<std::string> overrides;
  };
  auto a = std::make_shared<Arguments>();
  auto* c = app.add_subcommand("check", "Check a scenario and the model built from it; lists all problems");
  c->add_option("SCENARIO", a->scenario, "Scenario file (YAML)")->required();
  c->add_option("--set", a->overrides, "Override a key of the scenario, path.to.key=value; may be given again")
      ->expected(1)
      ->take_all();
  c->footer("Examples:\n  carus check scenarios/reference.yaml\n  carus check my.yaml --set resolution=coarse");
  c->callback([a, &status] { status = check(a->scenario, a->overrides); });
}

}  // namespace carus::app
