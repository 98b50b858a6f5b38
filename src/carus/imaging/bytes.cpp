// SPDX-License-Identifier: Apache-2.0
#include "carus/imaging/bytes.hpp"

#include <fmt/format.h>
#include <zlib.h>

#include <algorithm>
#include <fstream>

#include "carus/core/error.hpp"

namespace carus::imaging {

std::string read_bytes(const std::filesystem::path& file, std::size_t limit) {
  std::error_code problem;
  const auto size = std::filesystem::file_size(file, problem);
  if (problem)
    throw InputError(fmt::format("{}: cannot be read: {}", file.string(),
                                 std::filesystem::is_directory(file) ? "it is a folder" : problem.message()));
  if (size > limit) throw InputError(fmt::format("{}: {} bytes; at most {}", file.string(), size, limit));
  std::string data(size, '\0');
  std::ifstream in(file, std::ios::binary);
  in.read(data.data(), static_cast<std::streamsize>(size));
  if (!in) throw InputError(fmt::format("{}: cannot be read", file.string()));
  return data;
}

bool is_gzip(std::string_view data) { return data.size() > 2 && data[0] == '\x1f' && data[1] == '\x8b'; }

std::string inflate(std::string_view data, std::size_t limit, const std::string& name) {
  struct Stream {
    z_stream z{};
    ~Stream() { inflateEnd(&z); }
  } s;
  if (inflateInit2(&s.z, 15 + 32) != Z_OK)  // 32: gzip or zlib, told by the first bytes
    throw InputError(fmt::format("{}: zlib: {}", name, s.z.msg ? s.z.msg : "out of memory"));
  std::string out;
  std::size_t fed = 0;
  constexpr std::size_t piece = std::size_t(1) << 24;
  int status = Z_OK;
  while (status != Z_STREAM_END && out.size() < limit) {
    if (s.z.avail_in == 0) {
      const auto n = std::min(piece, data.size() - fed);
      s.z.next_in = reinterpret_cast<Bytef*>(const_cast<char*>(data.data() + fed));
      s.z.avail_in = static_cast<uInt>(n);
      fed += n;
    }
    const auto done = out.size(), room = std::min(piece, limit - done);
    out.resize(done + room);
    s.z.next_out = reinterpret_cast<Bytef*>(out.data() + done);
    s.z.avail_out = static_cast<uInt>(room);
    const auto in_before = s.z.avail_in;
    status = ::inflate(&s.z, Z_NO_FLUSH);
    out.resize(done + room - s.z.avail_out);
    const bool stuck = s.z.avail_in == in_before && out.size() == done && fed == data.size();
    if ((status != Z_OK && status != Z_STREAM_END && status != Z_BUF_ERROR) || (stuck && status != Z_STREAM_END))
      throw InputError(fmt::format("{}: the compressed data is damaged or ends early ({} bytes read): {}", name,
                                   out.size(), s.z.msg ? s.z.msg : "unexpected end"));
  }
  return out;
}

}  // namespace carus::imaging
