// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <CLI/CLI.hpp>
#include <string>
#include <vector>

#include "carus/scenario/scenario.hpp"

namespace carus::app {

/// Exit statuses, the contract of docs/guide/results.md.
enum Status : int { done = 0, not_met = 1, bad_input = 2, numerical_failure = 3, interrupted = 4 };

/// Each adds its subcommand; when it is chosen, its work is done at parsing's end and `status` set.
void add_run(CLI::App& app, int& status);
void add_check(CLI::App& app, int& status);
void add_anatomy(CLI::App& app, int& status);
void add_mesh(CLI::App& app, int& status);
void add_study(CLI::App& app, int& status);
void add_bench(CLI::App& app, int& status);
void add_report(CLI::App& app, int& status);
void add_export(CLI::App& app, int& status);
void add_serve(CLI::App& app, int& status);
void add_verify(CLI::App& app, int& status);

/// A scenario's anatomy, read from anatomy.from or meshed; throws InputError in builds that cannot mesh.
anatomy::Anatomy build_anatomy(const scenario::Scenario& scenario);

}  // namespace carus::app
