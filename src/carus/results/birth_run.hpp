// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <atomic>
#include <filesystem>
#include <functional>
#include <string>

#include "carus/observe/observer.hpp"
#include "carus/results/engine.hpp"
#include "carus/scenario/assemble.hpp"

namespace carus::results {

/// What a person who waits wants to know.
struct Progress {
  double time, labour_duration;  ///< [s of labour]
  int contractions;
  double station, head_z;  ///< [mm]
  double wall_left;        ///< [s] if the whole labour is run
};

struct RunOptions {
  std::filesystem::path out;
  bool resume = false;
  double checkpoint_every = 10;  ///< [s of wall]
  double wall_meshing = 0;       ///< [s], for the summary
  int threads = 1;               ///< for the summary
  std::string version, commit;
  const std::atomic<bool>* stop = nullptr;  ///< set by a signal: write a checkpoint and leave
  std::function<void(const Progress&)> progress;
  std::function<void(const std::string&)> log;
  std::function<void(const std::string&)> event;  ///< every line of events.jsonl
};

enum class Outcome { born, not_born, failed, interrupted };

/// The measurements' view of an assembled model.
observe::Setup observer_setup(const scenario::Scenario& scenario, const scenario::Assembly& assembly,
                              const anatomy::Anatomy& anatomy);

/// The beginning of scenario.resolved.yaml, which tells what computed a folder.
std::string build_line(const std::string& version, const std::string& commit);

/// Makes the folder; unless resuming, removes what an earlier run left in it (only files that a run writes).
void prepare_folder(const std::filesystem::path& out, bool resume);

/// Runs a labour and writes its results folder; every file is valid at any moment, and after a resume all but wall
/// times are as if nothing had happened. A numerical failure is an outcome: its reason is logged and in the summary,
/// the last good state a frame and the checkpoint. Throws InputError, e.g. when the checkpoint belongs to another
/// scenario or mesh.
Outcome run_birth(const scenario::Scenario& scenario, const fem::Model& model, const observe::Setup& setup,
                  Engine& engine, const RunOptions& options);

}  // namespace carus::results
