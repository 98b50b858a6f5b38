// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <fmt/format.h>

#include <filesystem>
#include <fstream>
#include <functional>
#include <string_view>

#include "carus/core/error.hpp"

namespace carus {

/// Calls `write` with a temporary name beside `path`, then renames it over `path`: whoever reads, at any moment and
/// after any kill, finds the old file or the new one, whole.
inline void write_atomically(const std::filesystem::path& path,
                             const std::function<void(const std::filesystem::path&)>& write) {
  std::filesystem::path temporary = path;
  temporary += ".tmp";
  try {
    write(temporary);
    std::filesystem::rename(temporary, path);
  } catch (const std::filesystem::filesystem_error& e) {
    throw InputError(fmt::format("{}: cannot be written: {}", path.string(), e.code().message()));
  } catch (...) {
    std::error_code ignored;
    std::filesystem::remove(temporary, ignored);  // half of a file is no use to anyone
    throw;
  }
}
inline void write_atomically(const std::filesystem::path& path, std::string_view text) {
  write_atomically(path, [&](const std::filesystem::path& temporary) {
    std::ofstream out(temporary, std::ios::binary);
    out << text;
    out.close();
    if (!out)
      throw InputError(fmt::format("{}: cannot be written; is the disk full, or the folder read-only?", path.string()));
  });
}

}  // namespace carus
