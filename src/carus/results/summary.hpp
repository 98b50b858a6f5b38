// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <utility>
#include <vector>

#include "carus/results/figures.hpp"
#include "carus/scenario/scenario.hpp"

namespace carus::results {

/// What a summary tells of a run beside its curves.
struct RunFacts {
  std::string outcome, reason;  ///< "born", "not_born", "failed" (with the reason)
  std::size_t elements = 0, nodes = 0, surface_nodes = 0;
  std::int64_t steps = 0;
  double time_step = 0, time_scaling = 0, unscaled_critical_step = 0, mass_scaled_fraction = 0;
  std::string limiting_region;
  std::vector<std::pair<std::string, double>> stages;          ///< [s] within the solver
  double wall_meshing = 0, wall_solving = 0, wall_output = 0;  ///< [s]
  int threads = 1;
  std::string version, commit;
  std::string machine;  ///< processor, its threads, system
};

/// "Intel(R) Xeon(R) ..., 2 threads, Linux 6.1 x86_64": this machine.
std::string machine_description();

/// summary.json (schema/summary.schema.json), pretty.
std::string summary_json(const Figures& figures, const scenario::Scenario& scenario, const RunFacts& facts);

}  // namespace carus::results
