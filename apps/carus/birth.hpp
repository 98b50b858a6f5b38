// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <spdlog/sinks/sink.h>
#include <spdlog/spdlog.h>

#include <atomic>
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

/// From now on what is logged goes to log.txt in the folder, and to the terminal.
void open_log(const std::filesystem::path& out, bool resume, bool to_terminal);

/// What stops a run before it starts belongs in its log too.
template <class F>
auto logged(F&& f) {
  try {
    return f();
  } catch (const std::exception& e) {
    spdlog::default_logger()->sinks()[0]->log({"carus", spdlog::level::err, e.what()});
    spdlog::default_logger()->flush();
    throw;
  }
}

/// Raised by the signals below.
const std::atomic<bool>* stop_flag();

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
