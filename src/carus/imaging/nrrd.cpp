// SPDX-License-Identifier: Apache-2.0
// NRRD: "key: value" lines, an empty line, voxels (teem.sourceforge.net/nrrd/format.html).
#include <fmt/format.h>

#include <map>

#include "carus/core/error.hpp"
#include "carus/imaging/bytes.hpp"
#include "carus/imaging/read_labels.hpp"
#include "carus/imaging/text_header.hpp"
#include "carus/imaging/voxels.hpp"

namespace carus::imaging {
namespace {

TextHeader header_of(std::string_view bytes, const std::string& name) {
  TextHeader h;
  std::size_t at = 0;
  while (true) {
    const auto end = bytes.find('\n', at);
    if (end == std::string_view::npos) {  // a detached header may simply end
      h.end = bytes.size();
      return h;
    }
    if (end - at > 100000)
      throw InputError(fmt::format("{}: is no NRRD file: a header line of {} bytes", name, end - at));
    const auto line = trimmed(bytes.substr(at, end - at));
    at = end + 1;
    if (line.empty()) {
      h.end = at;
      return h;
    }
    if (line[0] == '#') continue;
    if (const auto colon = line.find(':'); colon != std::string::npos && line.substr(colon, 2) != ":=")
      h.fields[lower(trimmed(line.substr(0, colon)))] = trimmed(line.substr(colon + 1));
  }
}

Scalar scalar_of(const std::string& type, const std::string& name) {
  static const std::map<std::string, Scalar> types{
      {"signed char", Scalar::i8},     {"int8", Scalar::i8},     {"int8_t", Scalar::i8},    {"uchar", Scalar::u8},
      {"unsigned char", Scalar::u8},   {"uint8", Scalar::u8},    {"uint8_t", Scalar::u8},   {"short", Scalar::i16},
      {"signed short", Scalar::i16},   {"int16", Scalar::i16},   {"int16_t", Scalar::i16},  {"ushort", Scalar::u16},
      {"unsigned short", Scalar::u16}, {"uint16", Scalar::u16},  {"uint16_t", Scalar::u16}, {"int", Scalar::i32},
      {"signed int", Scalar::i32},     {"int32", Scalar::i32},   {"int32_t", Scalar::i32},  {"uint", Scalar::u32},
      {"unsigned int", Scalar::u32},   {"uint32", Scalar::u32},  {"uint32_t", Scalar::u32}, {"longlong", Scalar::i64},
      {"int64", Scalar::i64},          {"int64_t", Scalar::i64}, {"uint64", Scalar::u64},   {"uint64_t", Scalar::u64},
      {"float", Scalar::f32},          {"double", Scalar::f64}};
  const auto it = types.find(lower(type));
  if (it == types.end())
    throw InputError(fmt::format("{}: type \"{}\"; allowed the integer types, float, double", name, type));
  return it->second;
}

/// The columns that turn the file's space into RAS.
Mat3 space_to_ras(const TextHeader& h, const std::string& name) {
  const auto it = h.fields.find("space");
  const auto space = it == h.fields.end() ? std::string() : lower(it->second);
  if (space == "ras" || space == "right-anterior-superior") return Mat3::Identity();
  if (space == "lps" || space == "left-posterior-superior") return Vec3(-1, -1, 1).asDiagonal();
  if (space == "las" || space == "left-anterior-superior") return Vec3(-1, 1, 1).asDiagonal();
  throw InputError(fmt::format(
      "{}: space \"{}\"; allowed right-anterior-superior, left-posterior-superior, left-anterior-superior: otherwise "
      "which side is right cannot be told",
      name, space));
}

double unit_of(const TextHeader& h, const std::string& name, std::vector<std::string>& notes) {
  const auto it = h.fields.find("space units");
  if (it == h.fields.end()) {
    notes.push_back(fmt::format("{}: states no unit; taken as millimetres", name));
    return 1e-3;
  }
  const auto unit = words(it->second);
  static const std::map<std::string, double> known{
      {"\"mm\"", 1e-3}, {"\"m\"", 1.0}, {"\"um\"", 1e-6}, {"\"cm\"", 1e-2}};
  if (unit.size() != 3 || unit[0] != unit[1] || unit[0] != unit[2] || !known.contains(unit[0]))
    throw InputError(fmt::format("{}: space units {}; allowed the same of \"mm\", \"m\", \"cm\", \"um\" three times",
                                 name, it->second));
  return known.at(unit[0]);
}

/// The voxels: after the header, or in a file of their own beside it.
std::string voxels_of(std::string_view bytes, const TextHeader& h, const std::filesystem::path& folder,
                      std::size_t wanted, const std::string& name) {
  std::string separate, data;
  for (const char* key : {"data file", "datafile"})
    if (const auto it = h.fields.find(key); it != h.fields.end()) separate = it->second;
  for (const char* key : {"byte skip", "byteskip", "line skip", "lineskip"})
    if (const auto it = h.fields.find(key); it != h.fields.end() && it->second != "0")
      throw InputError(fmt::format("{}: {} {}; allowed 0: save it again as one .nrrd file", name, key, it->second));
  if (separate.empty())
    data = bytes.substr(h.end);
  else if (std::filesystem::path(separate).has_parent_path() || separate.find(' ') != std::string::npos)
    throw InputError(fmt::format("{}: data file {}; allowed one file beside the header", name, separate));
  else
    data = read_bytes(folder / separate);
  const auto encoding = lower(required(h, "encoding", name));
  if (encoding == "raw") return data;
  if (encoding == "gzip" || encoding == "gz") return inflate(data, wanted, name);
  throw InputError(fmt::format("{}: encoding {}; allowed raw, gzip", name, encoding));
}

}  // namespace

LabelFile read_nrrd(std::string_view bytes, const std::filesystem::path& folder, const std::string& name) {
  const auto h = header_of(bytes, name);
  if (const auto& d = required(h, "dimension", name); d != "3")
    throw InputError(
        fmt::format("{}: dimension {}; a label volume has 3: collapse the layers of overlapping segments", name, d));
  LabelFile f;
  const auto sizes = numbers(required(h, "sizes", name), 3, "sizes", name);
  std::array<std::int64_t, 3> size{};
  for (int k = 0; k < 3; ++k) size[k] = static_cast<std::int64_t>(std::clamp(sizes[k], -1.0, 1e9));
  const auto count = voxel_count(size, name);
  const auto type = scalar_of(required(h, "type", name), name);
  const auto directions = numbers(required(h, "space directions", name), 9, "space directions", name);
  const auto origin = numbers(required(h, "space origin", name), 3, "space origin", name);
  const Mat3 to_ras = space_to_ras(h, name);
  const double unit = unit_of(h, name, f.notes);
  auto& v = f.volume;
  for (int k = 0; k < 3; ++k) {
    v.size[k] = static_cast<int>(size[k]);
    v.axes.col(k) = unit * (to_ras * Vec3(directions[3 * k], directions[3 * k + 1], directions[3 * k + 2]));
  }
  v.origin = unit * (to_ras * Vec3(origin[0], origin[1], origin[2]));
  check_geometry(v, name);
  const auto data = voxels_of(bytes, h, folder, count * bytes_of(type), name);
  bool swap = false;
  if (bytes_of(type) > 1) {
    const auto endian = lower(required(h, "endian", name));
    if (endian != "little" && endian != "big")
      throw InputError(fmt::format("{}: endian {}; allowed little, big", name, endian));
    swap = (endian == "little") != little_endian;
  }
  v.labels = labels_from(data, type, swap, count, name);
  return f;
}

}  // namespace carus::imaging
