// SPDX-License-Identifier: Apache-2.0
#include "carus/report/coding.hpp"

#include <fmt/format.h>
#include <vtkBase64Utilities.h>
#include <zlib.h>

#include <algorithm>
#include <cmath>

#include "carus/core/error.hpp"

namespace carus::report {
namespace {

std::uint32_t zigzag(std::int32_t d) { return (std::uint32_t(d) << 1) ^ std::uint32_t(d >> 31); }
std::int32_t zagzig(std::uint32_t u) { return std::int32_t(u >> 1) ^ -std::int32_t(u & 1U); }

}  // namespace

Planes to_planes(std::span<const std::int32_t> values) {
  std::uint32_t all = 0;
  for (const auto v : values) all |= zigzag(v);
  Planes out;
  while (out.planes < 4 && (all >> (8 * out.planes)) != 0) ++out.planes;
  out.bytes.resize(std::size_t(out.planes) * values.size());
  for (int p = 0; p < out.planes; ++p) {
    std::uint8_t* plane = out.bytes.data() + std::size_t(p) * values.size();
    for (std::size_t i = 0; i < values.size(); ++i) plane[i] = std::uint8_t(zigzag(values[i]) >> (8 * p));
  }
  return out;
}

std::vector<std::int32_t> from_planes(std::span<const std::uint8_t> bytes, int planes, std::size_t count) {
  if (planes < 1 || planes > 4 || bytes.size() != std::size_t(planes) * count)
    throw InputError(fmt::format("{} bytes are not {} planes of {} integers", bytes.size(), planes, count));
  std::vector<std::int32_t> values(count);
  for (std::size_t i = 0; i < count; ++i) {
    std::uint32_t u = 0;
    for (int p = 0; p < planes; ++p) u |= std::uint32_t(bytes[std::size_t(p) * count + i]) << (8 * p);
    values[i] = zagzig(u);
  }
  return values;
}

std::string deflate(std::span<const std::uint8_t> raw, int level) {
  uLongf size = compressBound(uLong(raw.size()));
  std::string out(size, '\0');
  const int status = compress2(reinterpret_cast<Bytef*>(out.data()), &size,
                               raw.empty() ? reinterpret_cast<const Bytef*>("") : raw.data(), uLong(raw.size()), level);
  CARUS_ASSERT(status == Z_OK);  // the buffer is as large as zlib asks for
  out.resize(size);
  return out;
}

std::vector<std::uint8_t> inflate(std::string_view packed, std::size_t size) {
  std::vector<std::uint8_t> out(size + 1);  // one more: a longer stream must not pass for a whole one
  uLongf got = uLongf(out.size());
  const int status = uncompress(out.data(), &got, reinterpret_cast<const Bytef*>(packed.data()), uLong(packed.size()));
  if (status != Z_OK || got != size)
    throw InputError(
        fmt::format("a zlib stream of {} bytes is damaged, or does not hold {} bytes", packed.size(), size));
  out.resize(size);
  return out;
}

std::string base64(std::string_view bytes) {
  std::string out((bytes.size() + 2) / 3 * 4, '\0');
  const auto* in = reinterpret_cast<const unsigned char*>(bytes.data());
  out.resize(vtkBase64Utilities::Encode(in, bytes.size(), reinterpret_cast<unsigned char*>(out.data())));
  return out;
}

std::int32_t Quantiser::operator()(double x) const {
  const double q = std::nearbyint(x / quantum_);
  if (!(std::abs(q) < double(1 << 29)))
    throw InputError(
        fmt::format("{}: the value {:g} is not finite, or too large for steps of {:g}", what_, x, quantum_));
  return std::int32_t(q);
}

}  // namespace carus::report
