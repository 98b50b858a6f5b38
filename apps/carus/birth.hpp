// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <chrono>
#include <filesystem>
#include <functional>
#include <string>

#include "app.hpp"
#include "carus/results/birth_run.hpp"

namespace carus::app {

struct BirthOptions {
  std::filesystem::path out;
  bool resume = false;
  bool log_to_terminal = true;  ///< else to log.txt alone
  std::function<void(const results::Progress&)> progress;
  std::function<void(const std::string&)> event;
};

/// From a scenario to its results folder: meshes, assembles, solves, writes. Every command that runs a birth does it
/// here. Throws InputError, which log.txt tells too.
results::Outcome birth(const scenario::Scenario& scenario, const BirthOptions& options);

/// From now on SIGINT and SIGTERM end a birth at its next stop, with a checkpoint.
void stop_on_signals();

/// One line that overwrites itself on a terminal; on a pipe, a line now and then.
class ProgressLine {
 public:
  ProgressLine();
  ~ProgressLine();
  ProgressLine(const ProgressLine&) = delete;
  ProgressLine& operator=(const ProgressLine&) = delete;
  void operator()(const results::Progress& p);
  [[nodiscard]] bool on_terminal() const { return terminal_; }
  void clear();  ///< makes room on the terminal for another line

 private:
  bool terminal_, open_ = false;
  std::chrono::steady_clock::time_point shown_{};
};

}  // namespace carus::app
