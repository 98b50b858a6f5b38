// SPDX-License-Identifier: Apache-2.0
// PLY, text and binary. VTK's reader dies on two of three damaged files, hence this one.
#include <fmt/format.h>

#include <cmath>
#include <map>

#include "carus/core/error.hpp"
#include "carus/imaging/bytes.hpp"
#include "carus/imaging/read_surface.hpp"
#include "carus/imaging/text_header.hpp"
#include "carus/imaging/voxels.hpp"

namespace carus::imaging {
namespace {

struct Property {
  std::string name;
  Scalar type{};
  bool list = false;
  Scalar count_type{};
};
struct Element {
  std::string name;
  std::size_t count = 0;
  std::vector<Property> properties;
};
enum class Encoding { text, little, big };

Scalar scalar_of(const std::string& type, const std::string& name) {
  static const std::map<std::string, Scalar> types{
      {"char", Scalar::i8},   {"int8", Scalar::i8},     {"uchar", Scalar::u8},   {"uint8", Scalar::u8},
      {"short", Scalar::i16}, {"int16", Scalar::i16},   {"ushort", Scalar::u16}, {"uint16", Scalar::u16},
      {"int", Scalar::i32},   {"int32", Scalar::i32},   {"uint", Scalar::u32},   {"uint32", Scalar::u32},
      {"float", Scalar::f32}, {"float32", Scalar::f32}, {"double", Scalar::f64}, {"float64", Scalar::f64}};
  const auto it = types.find(type);
  if (it == types.end()) throw InputError(fmt::format("{}: property of unknown type \"{}\"", name, type.substr(0, 40)));
  return it->second;
}

class Reader {
 public:
  Reader(std::string_view bytes, const std::string& name) : b_(bytes), name_(name) { read_header(); }

  mesh::Surface run() {
    mesh::Surface s;
    for (const auto& e : elements_)
      for (std::size_t i = 0; i < e.count; ++i) {
        if (e.name == "vertex")
          s.nodes.push_back(read_vertex(e));
        else
          read_other(e, s);
      }
    return s;
  }

 private:
  [[noreturn]] void refuse(const std::string& why) const { throw InputError(fmt::format("{}: {}", name_, why)); }

  std::string line() {
    const auto end = b_.find('\n', at_);
    if (end == std::string_view::npos || end - at_ > 4096) refuse("is no PLY file: its header does not end");
    const auto text = trimmed(b_.substr(at_, end - at_));
    at_ = end + 1;
    return text;
  }

  void read_header() {
    if (line() != "ply") refuse("is no PLY file: it does not begin with \"ply\"");
    bool format = false;
    for (auto text = line(); text != "end_header"; text = line()) {
      const auto w = words(text);
      if (w.empty() || w[0] == "comment" || w[0] == "obj_info") continue;
      if (w[0] == "format" && w.size() == 3) {
        format = true;
        if (w[1] == "ascii")
          encoding_ = Encoding::text;
        else if (w[1] == "binary_little_endian")
          encoding_ = Encoding::little;
        else if (w[1] == "binary_big_endian")
          encoding_ = Encoding::big;
        else
          refuse(
              fmt::format("format \"{}\"; allowed ascii, binary_little_endian, binary_big_endian", w[1].substr(0, 40)));
      } else if (w[0] == "element" && w.size() == 3) {
        const double n = numbers(w[2], 1, "element " + w[1], name_)[0];
        // Not even a byte for each: refused before anything is set aside for them.
        if (!(n >= 0 && n <= static_cast<double>(b_.size())))
          refuse(fmt::format("promises {} of {}; the file has {} bytes", n, w[1], b_.size()));
        elements_.push_back({w[1], static_cast<std::size_t>(n), {}});
      } else if (w[0] == "property" && !elements_.empty() && w.size() == 3) {
        elements_.back().properties.push_back({w[2], scalar_of(w[1], name_), false, {}});
      } else if (w[0] == "property" && !elements_.empty() && w.size() == 5 && w[1] == "list") {
        elements_.back().properties.push_back({w[4], scalar_of(w[3], name_), true, scalar_of(w[2], name_)});
      } else {
        refuse(fmt::format("header line \"{}\" is not understood", text.substr(0, 60)));
      }
    }
    if (!format) refuse("its header has no format");
    for (const auto& e : elements_)
      if (e.properties.empty() && e.count > 0) refuse(fmt::format("element {} has no properties", e.name));
  }

  double number(Scalar type) {
    if (encoding_ == Encoding::text) return text_number();
    if (b_.size() - at_ < bytes_of(type)) refuse("is truncated");
    const bool swap = (encoding_ == Encoding::little) != little_endian;
    const auto from = at_;
    at_ += bytes_of(type);
    switch (type) {
      case Scalar::u8:
        return number_at<std::uint8_t>(b_, from);
      case Scalar::i8:
        return number_at<std::int8_t>(b_, from);
      case Scalar::u16:
        return number_at<std::uint16_t>(b_, from, swap);
      case Scalar::i16:
        return number_at<std::int16_t>(b_, from, swap);
      case Scalar::u32:
        return number_at<std::uint32_t>(b_, from, swap);
      case Scalar::i32:
        return number_at<std::int32_t>(b_, from, swap);
      case Scalar::f32:
        return static_cast<double>(number_at<float>(b_, from, swap));
      default:
        return number_at<double>(b_, from, swap);
    }
  }

  double text_number() {
    const auto first = b_.find_first_not_of(" \t\r\n", at_);
    if (first == std::string_view::npos) refuse("is truncated");
    auto end = b_.find_first_of(" \t\r\n", first);
    if (end == std::string_view::npos) end = b_.size();
    at_ = end;
    return numbers(std::string(b_.substr(first, end - first)), 1, "data", name_)[0];
  }

  std::size_t count_of(const Property& p) {
    const double n = number(p.count_type);
    if (!(n >= 0 && n <= 1e6 && n == std::floor(n))) refuse(fmt::format("a list of {} entries", n));
    return static_cast<std::size_t>(n);
  }

  Vec3 read_vertex(const Element& e) {
    Vec3 x = Vec3::Constant(std::nan(""));
    for (const auto& p : e.properties) {
      const auto n = p.list ? count_of(p) : 1;
      for (std::size_t k = 0; k < n; ++k) {
        const double v = number(p.type);
        if (!p.list && p.name.size() == 1 && p.name[0] >= 'x' && p.name[0] <= 'z') x[p.name[0] - 'x'] = v;
      }
    }
    return x;
  }

  void read_other(const Element& e, mesh::Surface& s) {
    for (const auto& p : e.properties) {
      const auto n = p.list ? count_of(p) : 1;
      std::vector<std::int32_t> polygon;
      for (std::size_t k = 0; k < n; ++k) {
        const double v = number(p.type);
        polygon.push_back(v >= 0 && v <= 2147483647 ? static_cast<std::int32_t>(v)
                                                    : -1);  // -1: mesh::closed refuses it
      }
      if (e.name != "face" || !p.list || (p.name != "vertex_indices" && p.name != "vertex_index")) continue;
      for (std::size_t k = 2; k < n; ++k) s.triangles.push_back({polygon[0], polygon[k - 1], polygon[k]});
    }
  }

  std::string_view b_;
  const std::string& name_;
  std::size_t at_ = 0;
  Encoding encoding_ = Encoding::text;
  std::vector<Element> elements_;
};

}  // namespace

mesh::Surface read_ply(std::string_view bytes, const std::string& name) { return Reader(bytes, name).run(); }

}  // namespace carus::imaging
