// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>
#include <sys/utsname.h>

#include <fstream>
#include <string>
#include <thread>

#include "carus/results/summary.hpp"

namespace carus::results {

std::string machine_description() {
  std::string processor = "unknown processor";
  std::ifstream in("/proc/cpuinfo");
  for (std::string line; std::getline(in, line);) {
    if (const auto colon = line.find(':'); line.starts_with("model name") && colon + 2 < line.size()) {
      processor = line.substr(colon + 2);
      break;
    }
  }
  utsname system{};
  const std::string name =
      uname(&system) == 0 ? fmt::format(", {} {} {}", system.sysname, system.release, system.machine) : "";
  return fmt::format("{}, {} threads{}", processor, std::thread::hardware_concurrency(), name);
}

}  // namespace carus::results
