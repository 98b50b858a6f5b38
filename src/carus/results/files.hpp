// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <string_view>

#include "carus/core/atomic_file.hpp"

namespace carus::results {

using carus::write_atomically;

/// Whole text of a file; throws InputError if it cannot be read.
std::string read_text(const std::filesystem::path& path);

/// Keeps the first `lines` lines of a text file and drops the rest, a torn last line among it. Throws InputError if it
/// has fewer.
void keep_lines(const std::filesystem::path& path, std::size_t lines);

/// FNV-1a, 64 bit: tells one scenario or mesh from another, no more.
class Hash {
 public:
  void add(const void* data, std::size_t bytes);
  template <class Container>
  void add_all(const Container& c) {
    add(c.data(), c.size() * sizeof(*c.data()));
  }
  [[nodiscard]] std::string hex() const;

 private:
  std::uint64_t value_ = 0xcbf29ce484222325ULL;
};

}  // namespace carus::results
