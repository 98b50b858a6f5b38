// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <atomic>
#include <filesystem>
#include <functional>
#include <memory>
#include <string>

#include "carus/general/build.hpp"
#include "carus/results/engine.hpp"

namespace carus::general {

/// The solver that a general model names. Throws InputError where its options do not fit, e.g. a step that would need
/// added mass in a dynamic analysis.
std::unique_ptr<results::Engine> make_engine(const scenario::ModelScenario& scenario, const fem::Model& model);

struct RunOptions {
  std::filesystem::path out;
  bool resume = false;
  double checkpoint_every = 10;  ///< [s of wall]
  double wall_meshing = 0;       ///< [s], for the summary
  int threads = 1;               ///< for the summary
  std::string version, commit;
  const std::atomic<bool>* stop = nullptr;
  std::function<void(double time, double duration)> progress;
  std::function<void(const std::string&)> log;
};

enum class Outcome { done, failed, interrupted };

/// Runs a general model and writes its results folder; every file is valid at any moment.
///
///     scenario.resolved.yaml, curves.csv, summary.json, frames.pvd, frames/*.vtu, checkpoint.h5
///     curves      time_s; per watched set SET_ux_mm.. (mean), SET_rx_n.. (reactions, summed), SET_cx_n.. (contact);
///                 energies in J, least gap, least J
///     frames      points: displacement, velocity, contact_force, reaction, stress; cells: region, J, max_stretch,
///                 stress, von_mises, pressure (observe::Stress)
///
/// A numerical failure is an outcome: logged, in the summary, the last good state a frame and the checkpoint.
Outcome run(const scenario::ModelScenario& scenario, const GeneralModel& model, results::Engine& engine,
            const RunOptions& options);

}  // namespace carus::general
