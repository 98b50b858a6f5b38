// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "carus/observe/milestones.hpp"
#include "carus/scenario/scenario.hpp"

namespace carus::report {

enum class RunStatus { finished, failed, in_progress };
const char* name_of(RunStatus status);  ///< "finished", "failed", "in_progress"

/// A results folder, but for its frames. What is missing or damaged is named in `notes`; what no report can do without
/// is an error.
struct Folder {
  std::filesystem::path path;
  RunStatus status = RunStatus::in_progress;
  std::string scenario_yaml;                   ///< scenario.resolved.yaml; empty if there is none
  std::optional<scenario::Scenario> scenario;  ///< absent if it cannot be read
  std::string summary_json;                    ///< valid JSON, an object; empty if there is none
  std::vector<std::string> events;             ///< valid JSON, one object each
  observe::Table curves;                       ///< at least one row; times increase
  std::string log;                             ///< its last 64 kB
  std::vector<std::string> notes;

  [[nodiscard]] std::string name() const;  ///< of the scenario, or of the folder
};

/// Throws InputError (what, where, what to do) if `path` is no folder, not one of carus's, or holds no outputs yet.
Folder read_folder(const std::filesystem::path& path);

}  // namespace carus::report
