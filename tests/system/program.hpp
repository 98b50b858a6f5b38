// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <sys/wait.h>
#include <unistd.h>

#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <sstream>
#include <string>
#include <vector>

/// The program as its users run it.
namespace carus::test {

namespace fs = std::filesystem;

inline const std::string reference = std::string(CARUS_SOURCE_DIR) + "/scenarios/reference.yaml";

/// A path of its own for one test, with nothing there yet.
inline fs::path fresh(const std::string& name) {
  const fs::path dir = fs::temp_directory_path() / ("carus_system_" + std::to_string(getpid())) / name;
  fs::remove_all(dir);
  fs::create_directories(dir.parent_path());
  return dir;
}

/// Starts the program with its output in `log`.
inline pid_t start(std::vector<std::string> arguments, const fs::path& log) {
  arguments.insert(arguments.begin(), CARUS_BINARY);
  const pid_t child = fork();
  if (child != 0) return child;
  if (!std::freopen(log.c_str(), "w", stdout) || dup2(fileno(stdout), STDERR_FILENO) < 0) _exit(127);
  std::vector<char*> argv;
  for (auto& a : arguments) argv.push_back(a.data());
  argv.push_back(nullptr);
  execv(argv[0], argv.data());
  _exit(127);
}

/// Its exit status, or minus the signal that ended it.
inline int wait_for(pid_t child) {
  int status = 0;
  waitpid(child, &status, 0);
  return WIFEXITED(status) ? WEXITSTATUS(status) : -WTERMSIG(status);
}

inline std::string text(const fs::path& file) {
  std::ifstream in(file, std::ios::binary);
  std::ostringstream out;
  out << in.rdbuf();
  return out.str();
}

/// 90 s of the coarse reference birth, in seconds.
inline std::vector<std::string> short_labour(const fs::path& out) {
  return {"run",      reference,
          "--out",    out.string(),
          "--set",    "resolution=coarse",
          "--set",    "numerics.labour_duration=90 s",
          "--set",    "numerics.pseudo_duration=0.09375 s",
          "--frames", "15"};
}

}  // namespace carus::test
