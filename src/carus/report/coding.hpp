// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace carus::report {

/// Integers as bytes that deflate packs well: zigzag (0, -1, 1, -2, ... become 0, 1, 2, 3, ...), then the lowest bytes
/// of all values, then the second of all, as many planes as the largest value needs (1 to 4).
struct Planes {
  int planes = 1;
  std::vector<std::uint8_t> bytes;  ///< planes x number of values
};
Planes to_planes(std::span<const std::int32_t> values);
/// Throws InputError if `bytes` does not hold `planes` times `count` bytes, or planes is not 1 to 4.
std::vector<std::int32_t> from_planes(std::span<const std::uint8_t> bytes, int planes, std::size_t count);

/// A zlib stream, what a browser's DecompressionStream("deflate") reads. `level` 1 (fast) to 9 (small).
std::string deflate(std::span<const std::uint8_t> raw, int level = 6);
/// Throws InputError if it is none, or does not inflate to exactly `size` bytes.
std::vector<std::uint8_t> inflate(std::string_view packed, std::size_t size);

/// RFC 4648, with padding, without line breaks.
std::string base64(std::string_view bytes);

/// x -> round(x / quantum). The value read back, quantum q, is at most quantum / 2 off. Throws InputError naming `what`
/// if x is not finite or does not fit into 30 bits (differences of two must fit into 32 after zigzag).
class Quantiser {
 public:
  Quantiser(double quantum, std::string what) : quantum_(quantum), what_(std::move(what)) {}
  [[nodiscard]] std::int32_t operator()(double x) const;
  [[nodiscard]] double quantum() const { return quantum_; }

 private:
  double quantum_;
  std::string what_;
};

}  // namespace carus::report
