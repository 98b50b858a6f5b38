// SPDX-License-Identifier: Apache-2.0
#include "carus/results/events.hpp"

#include <fmt/format.h>

#include "carus/results/files.hpp"

namespace carus::results {

Events::Events(const std::filesystem::path& file, Echo echo) : out_(file, std::ios::trunc), echo_(std::move(echo)) {}

Events::Events(const std::filesystem::path& file, std::int64_t keep, Echo echo) : echo_(std::move(echo)), count_(keep) {
  keep_lines(file, std::size_t(keep));
  out_.open(file, std::ios::app);
}

void Events::add(double time, const std::string& event, const std::string& more) {
  const auto line =
      fmt::format(R"({{"time_s": {:.3f}, "event": "{}"{}{}}})", time, event, more.empty() ? "" : ", ", more);
  out_ << line << '\n' << std::flush;
  if (echo_) echo_(line);
  ++count_;
}

}  // namespace carus::results
