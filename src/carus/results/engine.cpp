// SPDX-License-Identifier: Apache-2.0
#include "carus/results/engine.hpp"

#include "carus/core/error.hpp"

namespace carus::results {
namespace {

class ExplicitEngine final : public Engine {
 public:
  ExplicitEngine(const fem::Model& model, const solve::ExplicitOptions& options)
      : scale_(options.labour_duration / options.pseudo_duration), solver_(model, options) {}
  void advance_to(double time) override { solver_.advance_to(time); }
  const fem::State& state() const override { return solver_.state(); }
  void restore(const fem::State& state) override { solver_.restore(state); }
  solve::Observables observe() const override { return solver_.observe(); }
  Facts facts() const override { return {solver_.steps(), scale_, solver_.step_report()}; }
  std::vector<std::pair<std::string, double>> timings() const override { return solver_.timings(); }

 private:
  double scale_;
  solve::Explicit solver_;
};

}  // namespace

std::unique_ptr<Engine> make_engine(const scenario::Scenario& scenario, const fem::Model& model) {
  if (scenario.solver != scenario::SolverKind::explicit_dynamics) {
    throw InputError(scenario.file + ": solver.kind: implicit is not in this build; allowed: explicit");
  }
  return make_engine(model, scenario::explicit_options(scenario));
}

std::unique_ptr<Engine> make_engine(const fem::Model& model, const solve::ExplicitOptions& options) {
  return std::make_unique<ExplicitEngine>(model, options);
}

}  // namespace carus::results
