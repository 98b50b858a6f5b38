// SPDX-License-Identifier: Apache-2.0
// MetaImage: "Key = value" lines up to ElementDataFile, then voxels. World coordinates are LPS in millimetres, as ITK
// writes and reads them.
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
  while (!h.fields.contains("elementdatafile")) {
    auto end = bytes.find('\n', at);
    if (end == std::string_view::npos) end = bytes.size();
    if (at >= bytes.size() || end - at > 10000)
      throw InputError(fmt::format("{}: is no MetaImage: its header has no ElementDataFile", name));
    const auto line = bytes.substr(at, end - at);
    if (const auto sign = line.find('='); sign != std::string_view::npos)
      h.fields[lower(trimmed(line.substr(0, sign)))] = trimmed(line.substr(sign + 1));
    at = std::min(end + 1, bytes.size());
  }
  h.end = at;
  return h;
}

Scalar scalar_of(const std::string& type, const std::string& name) {
  static const std::map<std::string, Scalar> types{{"MET_UCHAR", Scalar::u8},       {"MET_CHAR", Scalar::i8},
                                                   {"MET_USHORT", Scalar::u16},     {"MET_SHORT", Scalar::i16},
                                                   {"MET_UINT", Scalar::u32},       {"MET_INT", Scalar::i32},
                                                   {"MET_ULONG_LONG", Scalar::u64}, {"MET_LONG_LONG", Scalar::i64},
                                                   {"MET_FLOAT", Scalar::f32},      {"MET_DOUBLE", Scalar::f64}};
  const auto it = types.find(type);
  if (it == types.end())
    throw InputError(
        fmt::format("{}: ElementType {}; allowed MET_UCHAR to MET_LONG_LONG, MET_FLOAT, MET_DOUBLE", name, type));
  return it->second;
}

std::string field(const TextHeader& h, const std::string& key, const std::string& fallback) {
  const auto it = h.fields.find(key);
  return it == h.fields.end() ? fallback : it->second;
}

bool yes(const TextHeader& h, const std::string& key) {
  const auto v = lower(field(h, key, "false"));
  return v == "true" || v == "1" || v == "t";
}

void set_geometry(const TextHeader& h, LabelFile& f, const std::string& name) {
  constexpr double mm = 1e-3;
  const Vec3 lps_to_ras(-1, -1, 1);
  if (!h.fields.contains("transformmatrix"))
    f.notes.push_back(fmt::format("{}: has no TransformMatrix; its axes are taken as left, posterior, superior", name));
  const auto m = numbers(field(h, "transformmatrix", "1 0 0 0 1 0 0 0 1"), 9, "TransformMatrix", name);
  const auto spacing = numbers(required(h, "elementspacing", name), 3, "ElementSpacing", name);
  std::string from = "0 0 0";
  for (const char* key : {"position", "origin", "offset"}) from = field(h, key, from);
  const auto origin = numbers(from, 3, "Offset", name);
  auto& v = f.volume;
  for (int k = 0; k < 3; ++k)  // row k of the matrix is the direction of index k
    v.axes.col(k) = mm * spacing[k] * lps_to_ras.cwiseProduct(Vec3(m[3 * k], m[3 * k + 1], m[3 * k + 2]));
  v.origin = mm * lps_to_ras.cwiseProduct(Vec3(origin[0], origin[1], origin[2]));
  check_geometry(v, name);
}

}  // namespace

LabelFile read_metaimage(std::string_view bytes, const std::filesystem::path& folder, const std::string& name) {
  const auto h = header_of(bytes, name);
  if (const auto d = required(h, "ndims", name); d != "3")
    throw InputError(fmt::format("{}: NDims = {}; a label volume has 3", name, d));
  if (const auto c = field(h, "elementnumberofchannels", "1"); c != "1")
    throw InputError(fmt::format("{}: ElementNumberOfChannels = {}; a label is one number", name, c));
  LabelFile f;
  const auto sizes = numbers(required(h, "dimsize", name), 3, "DimSize", name);
  std::array<std::int64_t, 3> size{};
  for (int k = 0; k < 3; ++k) {
    size[k] = static_cast<std::int64_t>(std::clamp(sizes[k], -1.0, 1e9));
    f.volume.size[k] = static_cast<int>(size[k]);
  }
  const auto count = voxel_count(size, name);
  set_geometry(h, f, name);
  const auto type = scalar_of(required(h, "elementtype", name), name);
  const auto where = required(h, "elementdatafile", name);
  std::string data;
  if (where == "LOCAL")
    data = bytes.substr(h.end);
  else if (std::filesystem::path(where).has_parent_path() || where.empty() || where == "LIST")
    throw InputError(fmt::format("{}: ElementDataFile = {}; allowed LOCAL or one file beside the header", name, where));
  else
    data = read_bytes(folder / where);
  if (yes(h, "compresseddata")) data = inflate(data, count * bytes_of(type), name);
  const bool big = yes(h, "binarydatabyteordermsb") || yes(h, "elementbyteordermsb");
  f.volume.labels = labels_from(data, type, big == little_endian, count, name);
  return f;
}

}  // namespace carus::imaging
