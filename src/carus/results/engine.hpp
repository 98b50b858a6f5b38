// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "carus/scenario/scenario.hpp"
#include "carus/solve/implicit.hpp"

namespace carus::results {

/// What a run needs of a solver, whichever it is. Stopping at a time may change the numbers, so a run stops at times
/// that follow from its scenario alone; from `restore`d states it goes on to the very same bits.
class Engine {
 public:
  virtual ~Engine() = default;
  virtual void advance_to(double time) = 0;  ///< [s of labour]; throws NumericalFailure and keeps the last good state
  virtual const fem::State& state() const = 0;
  virtual void restore(const fem::State& state) = 0;
  virtual solve::Observables observe() const = 0;

  struct Facts {
    std::int64_t steps = 0;        ///< of the whole labour, at the mean pace
    double labour_per_pseudo = 1;  ///< seconds of labour in one of pseudo-time, over what has been computed
    solve::StepReport step{};
    std::string plan;  ///< for the log: steps, and what limits them
  };
  virtual Facts facts() const = 0;
  /// What the time goes into, since construction: steps of the explicit solver, Newton iterations of the implicit one.
  virtual std::int64_t iterations() const = 0;
  virtual std::vector<std::pair<std::string, double>> timings() const = 0;
};

/// The solver that the scenario names. Throws InputError where the model cannot be solved by it.
std::unique_ptr<Engine> make_engine(const scenario::Scenario& scenario, const fem::Model& model);
/// The explicit solver with these options.
std::unique_ptr<Engine> make_engine(const fem::Model& model, const solve::ExplicitOptions& options);
/// The implicit solver with these options, for `duration` [s].
std::unique_ptr<Engine> make_engine(const fem::Model& model, const solve::ImplicitOptions& options, double duration);

}  // namespace carus::results
