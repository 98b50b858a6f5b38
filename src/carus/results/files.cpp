// SPDX-License-Identifier: Apache-2.0
#include "carus/results/files.hpp"

#include <fmt/format.h>

#include <fstream>
#include <sstream>

#include "carus/core/error.hpp"

namespace carus::results {

namespace fs = std::filesystem;

std::string read_text(const fs::path& path) {
  std::ifstream in(path, std::ios::binary);
  std::ostringstream text;
  text << in.rdbuf();
  if (!in) throw InputError(fmt::format("{}: cannot be read", path.string()));
  return text.str();
}

void keep_lines(const fs::path& path, std::size_t lines) {
  const std::string text = read_text(path);
  std::size_t end = 0;
  for (std::size_t i = 0; i < lines; ++i) {
    const auto newline = text.find('\n', end);
    if (newline == std::string::npos) {
      throw InputError(fmt::format("{}: has {} whole lines; the checkpoint knows of {}; the folder was changed since",
                                   path.string(), i, lines));
    }
    end = newline + 1;
  }
  fs::resize_file(path, end);
}

void Hash::add(const void* data, std::size_t bytes) {
  const auto* p = static_cast<const unsigned char*>(data);
  for (std::size_t i = 0; i < bytes; ++i) value_ = (value_ ^ p[i]) * 0x100000001b3ULL;
}

std::string Hash::hex() const { return fmt::format("{:016x}", value_); }

}  // namespace carus::results
