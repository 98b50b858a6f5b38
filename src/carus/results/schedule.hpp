// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "carus/scenario/scenario.hpp"

namespace carus::results {

/// A time at which the solver stops. All follow from the scenario, never from the clock: results must not depend on the
/// machine.
struct Stop {
  double time;  ///< [s of labour]
  bool row;     ///< a row of curves.csv; else only a place where a run may be interrupted
  bool frame;
};

/// Curve intervals, frames, starts and peaks of contractions, sorted and merged, with stops between them at most every
/// 4 s of labour.
std::vector<Stop> schedule_of(const scenario::Scenario& scenario);

}  // namespace carus::results
