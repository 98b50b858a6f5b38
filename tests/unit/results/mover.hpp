// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <unistd.h>

#include <cmath>
#include <filesystem>

#include "../observe/blocks.hpp"
#include "carus/core/error.hpp"
#include "carus/results/birth_run.hpp"

namespace carus::test {

/// A stand-in for a solver: the fetus sinks at a steady pace with a swing, and its state carries history in `internal`,
/// so that a run resumed from anything less than the full state would differ.
class Mover final : public results::Engine {
 public:
  explicit Mover(const fem::Model& model, double descent = 0.4, double fails_at = 1e9)
      : model_(model), descent_(descent), fails_at_(fails_at) {
    state_.x = model.mesh.nodes;
    state_.v.assign(state_.x.size(), Vec3(0, 0, -descent_));
    state_.internal = {0.1};
    state_.rest_length = {1.0, 0.9};
  }
  void advance_to(double time) override {
    if (time > fails_at_) throw NumericalFailure("inversion of element 7 (skull)");
    while (state_.step < std::llround(time / step_)) {
      ++state_.step;
      state_.time = double(state_.step) * step_;
      state_.internal[0] = std::fmod(3.7 * state_.internal[0] + 0.01, 1.0);
      for (auto& x : state_.x)
        x += Vec3(0, 1e-7 * state_.internal[0], -descent_ * step_ / 1920 + 1e-5 * (state_.internal[0] - 0.5));
    }
    if (on_advance) on_advance(state_.time);
  }
  const fem::State& state() const override { return state_; }
  void restore(const fem::State& state) override { state_ = state; }
  solve::Observables observe() const override { return {}; }
  Facts facts() const override { return {1920, 960, {}, {}}; }
  std::int64_t iterations() const override { return state_.step; }
  std::vector<std::pair<std::string, double>> timings() const override { return {}; }

  std::function<void(double)> on_advance;

 private:
  const fem::Model& model_;
  double descent_, fails_at_, step_ = 1;
  fem::State state_;
};

inline scenario::Scenario quick_scenario() {
  return scenario::parse("output: {frames: 8, curve_interval: 60 s}\n",
                         std::filesystem::path(CARUS_SOURCE_DIR) / "scenarios" / "test.yaml");
}

/// A folder of its own for one test, removed with it.
class Folder {
 public:
  explicit Folder(const std::string& name)
      : path_(std::filesystem::temp_directory_path() / ("carus_" + name + "_" + std::to_string(getpid()))) {
    std::filesystem::remove_all(path_);
    std::filesystem::create_directories(path_);
  }
  ~Folder() { std::filesystem::remove_all(path_); }
  Folder(const Folder&) = delete;
  Folder& operator=(const Folder&) = delete;
  std::filesystem::path operator/(const std::string& name) const { return path_ / name; }
  const std::filesystem::path& path() const { return path_; }

 private:
  std::filesystem::path path_;
};

}  // namespace carus::test
