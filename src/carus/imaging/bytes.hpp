// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <bit>
#include <cstdint>
#include <cstring>
#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

namespace carus::imaging {

/// Whole content of a file, refused above `limit` bytes. Throws InputError if it cannot be read.
std::string read_bytes(const std::filesystem::path& file, std::size_t limit = std::size_t(2) << 30);

/// Undoes gzip or zlib; stops after `limit` bytes, whatever the stream claims. Throws InputError, beginning with
/// `name`, if the stream is damaged or ends early.
std::string inflate(std::string_view data, std::size_t limit, const std::string& name);

bool is_gzip(std::string_view data);

/// A number at an offset, which must lie within the data.
template <class T>
T number_at(std::string_view data, std::size_t offset, bool swap = false) {
  char b[sizeof(T)];
  std::memcpy(b, data.data() + offset, sizeof(T));
  if (swap)
    for (std::size_t i = 0; i < sizeof(T) / 2; ++i) std::swap(b[i], b[sizeof(T) - 1 - i]);
  T v;
  std::memcpy(&v, b, sizeof(T));
  return v;
}

inline constexpr bool little_endian = std::endian::native == std::endian::little;

}  // namespace carus::imaging
