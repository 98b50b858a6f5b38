// SPDX-License-Identifier: Apache-2.0
#include "carus/results/engine.hpp"

#include <fmt/format.h>

#include <cmath>

namespace carus::results {
namespace {

class ExplicitEngine final : public Engine {
 public:
  ExplicitEngine(const fem::Model& model, const solve::ExplicitOptions& options)
      : options_(options), solver_(model, options) {}
  void advance_to(double time) override { solver_.advance_to(time); }
  const fem::State& state() const override { return solver_.state(); }
  void restore(const fem::State& state) override { solver_.restore(state); }
  solve::Observables observe() const override { return solver_.observe(); }
  std::int64_t iterations() const override { return solver_.state().step; }
  Facts facts() const override {
    const auto step = solver_.step_report();
    const double mean = options_.labour_duration / options_.pseudo_duration;
    const auto& [ratio, slowest, fastest] = options_.pace;
    std::string plan = fmt::format(
        "{} steps of {:.3g} s (unscaled critical step {:.3g} s, limited by {}; mass added {:.2f} %); 1 s "
        "of pseudo-time is {:.0f} s of labour",
        solver_.steps(), step.time_step, step.unscaled_critical_step, step.limiting_region,
        100 * step.mass_scaled_fraction, mean);
    if (slowest < fastest)
      plan += fmt::format(", times {:g} to {:g} as kinetic/internal energy allows ({:g})", slowest, fastest, ratio);
    const auto& state = solver_.state();
    return {solver_.steps(), state.step > 0 ? state.time / (double(state.step) * step.time_step) : mean, step, plan};
  }
  std::vector<std::pair<std::string, double>> timings() const override { return solver_.timings(); }

 private:
  solve::ExplicitOptions options_;
  solve::Explicit solver_;
};

class ImplicitEngine final : public Engine {
 public:
  ImplicitEngine(const fem::Model& model, const solve::ImplicitOptions& options, double duration)
      : model_(model), options_(options), duration_(duration), solver_(model, options) {}
  void advance_to(double time) override { solver_.advance_to(time); }
  const fem::State& state() const override { return solver_.state(); }
  void restore(const fem::State& state) override { solver_.restore(state); }
  solve::Observables observe() const override { return solver_.observe(); }
  std::vector<std::pair<std::string, double>> timings() const override { return solver_.timings(); }

  std::int64_t iterations() const override { return solver_.counts().newton; }
  Facts facts() const override {
    const auto steps = std::int64_t(std::ceil(duration_ / options_.time_step));
    return {steps, 1, {options_.time_step, options_.time_step, "none", 0}, plan(steps)};
  }

 private:
  /// The initial gaps tell what the barrier does before anything moves.
  std::string plan(std::int64_t steps) const {
    constexpr double looked = 5e-3;  // [m]
    const auto least = solver_.least_distances(looked);
    std::string gaps;
    for (std::size_t p = 0; p < least.size(); ++p) {
      const auto name = [&](int s) { return model_.contact_surfaces[std::size_t(s)].name; };
      gaps += fmt::format("; {} to {} {}", name(model_.contact_pairs[p].a), name(model_.contact_pairs[p].b),
                          std::isfinite(least[p]) ? fmt::format("{:.3f} mm", 1e3 * least[p]) : "more than 5 mm");
    }
    return fmt::format("implicit: {} steps of at most {:.3g} s; barrier {:.2f} mm; least distances at the start{}",
                       steps, options_.time_step, 1e3 * options_.barrier_distance, gaps);
  }

  const fem::Model& model_;
  solve::ImplicitOptions options_;
  double duration_;
  solve::Implicit solver_;
};

}  // namespace

std::unique_ptr<Engine> make_engine(const scenario::Scenario& scenario, const fem::Model& model) {
  if (scenario.solver == scenario::SolverKind::implicit_dynamics)
    return make_engine(model, scenario::implicit_options(scenario), scenario.numerics.labour_duration);
  return make_engine(model, scenario::explicit_options(scenario));
}

std::unique_ptr<Engine> make_engine(const fem::Model& model, const solve::ExplicitOptions& options) {
  return std::make_unique<ExplicitEngine>(model, options);
}

std::unique_ptr<Engine> make_engine(const fem::Model& model, const solve::ImplicitOptions& options, double duration) {
  return std::make_unique<ImplicitEngine>(model, options, duration);
}

}  // namespace carus::results
