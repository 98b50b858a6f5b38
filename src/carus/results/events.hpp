// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <fstream>
#include <functional>
#include <string>

namespace carus::results {

/// events.jsonl: one JSON object per line, {"time_s": ..., "event": ..., ...}, flushed. `echo` gets each line too.
class Events {
 public:
  using Echo = std::function<void(const std::string& line)>;
  explicit Events(const std::filesystem::path& file, Echo echo = {});            ///< afresh
  Events(const std::filesystem::path& file, std::int64_t keep, Echo echo = {});  ///< after the first `keep` lines

  /// `more`: further members as JSON text, e.g. `"station_mm": 3.2`.
  void add(double time, const std::string& event, const std::string& more = {});
  [[nodiscard]] std::int64_t count() const { return count_; }

 private:
  std::ofstream out_;
  Echo echo_;
  std::int64_t count_ = 0;
};

}  // namespace carus::results
