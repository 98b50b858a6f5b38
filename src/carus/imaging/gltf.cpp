// SPDX-License-Identifier: Apache-2.0
// glTF 2.0 and GLB: a tree of nodes with transformations, meshes of triangles on them, numbers in buffers (Khronos).
#include <fmt/format.h>

#include <Eigen/Geometry>
#include <nlohmann/json.hpp>

#include "carus/core/error.hpp"
#include "carus/imaging/bytes.hpp"
#include "carus/imaging/read_surface.hpp"

namespace carus::imaging {
namespace {

using Json = nlohmann::json;

std::string decode_base64(std::string_view text, const std::string& name) {
  std::string out;
  std::uint32_t bits = 0;
  int have = 0;
  for (const char c : text) {
    if (c == '=') break;
    static constexpr std::string_view alphabet = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
    const auto v = alphabet.find(c);
    if (v == std::string_view::npos) throw InputError(fmt::format("{}: a buffer is no base64", name));
    bits = bits << 6 | static_cast<std::uint32_t>(v);
    if ((have += 6) >= 8) out.push_back(static_cast<char>(bits >> (have -= 8) & 0xff));
  }
  return out;
}

class Reader {
 public:
  Reader(std::string_view bytes, std::filesystem::path folder, std::string part, const std::string& name)
      : folder_(std::move(folder)), part_(std::move(part)), name_(name) {
    parse(bytes);
  }

  mesh::Surface run() {
    if (j_.contains("extensionsRequired"))
      for (const auto& e : j_.at("extensionsRequired"))
        refuse(fmt::format("needs the extension {}; export it again uncompressed", e.get<std::string>()));
    const auto& nodes = j_.at("nodes");
    std::vector<char> child(nodes.size(), 0);
    for (const auto& n : nodes)
      if (n.contains("children"))
        for (const auto& c : n.at("children")) child.at(c.get<std::size_t>()) = 1;
    for (std::size_t i = 0; i < nodes.size(); ++i)
      if (child[i] == 0) walk(i, Eigen::Affine3d::Identity(), part_.empty(), 0);
    if (s_.triangles.empty())
      refuse(part_.empty() ? "has no triangles"
                           : fmt::format("has no triangles in a node or mesh named \"{}\"", part_));
    return std::move(s_);
  }

 private:
  [[noreturn]] void refuse(const std::string& why) const { throw InputError(fmt::format("{}: {}", name_, why)); }

  void parse(std::string_view bytes) {
    std::string_view text = bytes;
    if (bytes.starts_with("glTF")) {
      if (bytes.size() < 20 || number_at<std::uint32_t>(bytes, 8) != bytes.size())
        refuse(fmt::format("is truncated: {} bytes are not what its header promises", bytes.size()));
      const std::size_t length = number_at<std::uint32_t>(bytes, 12);
      if (bytes.substr(16, 4) != "JSON" || length > bytes.size() - 20)
        refuse("its first chunk is no JSON, or truncated");
      text = bytes.substr(20, length);
      if (const auto rest = bytes.substr(20 + length); rest.size() >= 8) {
        const std::size_t size = number_at<std::uint32_t>(rest, 0);
        if (size > rest.size() - 8) refuse("its binary chunk is truncated");
        binary_ = rest.substr(8, size);
      }
    }
    j_ = Json::parse(text);
  }

  void walk(std::size_t index, const Eigen::Affine3d& above, bool wanted, int depth) {
    if (depth > 100 || ++visited_ > 100000) refuse("its nodes run in a circle");
    const auto& n = j_.at("nodes").at(index);
    const Eigen::Affine3d here = above * transformation(n);
    wanted = wanted || n.value("name", "") == part_;
    if (n.contains("mesh")) {
      const auto& m = j_.at("meshes").at(n.at("mesh").get<std::size_t>());
      if (wanted || m.value("name", "") == part_)
        for (const auto& p : m.at("primitives")) add(p, here);
    }
    if (n.contains("children"))
      for (const auto& c : n.at("children")) walk(c.get<std::size_t>(), here, wanted, depth + 1);
  }

  static Eigen::Affine3d transformation(const Json& n) {
    Eigen::Affine3d t = Eigen::Affine3d::Identity();
    const auto vector = [&](const char* key, Vec3 fallback) {
      if (n.contains(key))
        for (int k = 0; k < 3; ++k) fallback[k] = n.at(key).at(k).get<double>();
      return fallback;
    };
    if (n.contains("matrix")) {
      for (int k = 0; k < 16; ++k) t.matrix()(k % 4, k / 4) = n.at("matrix").at(k).get<double>();
      return t;
    }
    t.translate(vector("translation", Vec3::Zero()));
    if (n.contains("rotation")) {
      const auto& q = n.at("rotation");
      t.rotate(
          Eigen::Quaterniond(q.at(3).get<double>(), q.at(0).get<double>(), q.at(1).get<double>(), q.at(2).get<double>())
              .normalized());
    }
    t.scale(vector("scale", Vec3::Ones()));
    return t;
  }

  void add(const Json& primitive, const Eigen::Affine3d& to) {
    if (primitive.value("mode", 4) != 4) return;  // points and lines are no surface
    if (s_.nodes.size() > 50000000) refuse("has more than 50 million nodes, repeated ones counted");
    const auto first = static_cast<std::int32_t>(s_.nodes.size());
    const auto x = numbers_of(primitive.at("attributes").at("POSITION").get<std::size_t>(), "VEC3");
    for (std::size_t i = 0; i + 2 < x.size(); i += 3) s_.nodes.push_back(to * Vec3(x[i], x[i + 1], x[i + 2]));
    std::vector<double> corners;
    if (primitive.contains("indices"))
      corners = numbers_of(primitive.at("indices").get<std::size_t>(), "SCALAR");
    else
      for (std::size_t i = 0; i < x.size() / 3; ++i) corners.push_back(static_cast<double>(i));
    const bool mirrored = to.linear().determinant() < 0;
    for (std::size_t i = 0; i + 2 < corners.size(); i += 3) {
      mesh::Triangle t{};
      for (int k = 0; k < 3; ++k) {
        if (!(corners[i + k] < static_cast<double>(x.size() / 3)))
          refuse(fmt::format("triangle {} names node {}; there are {}", i / 3, corners[i + k], x.size() / 3));
        t[k] = first + static_cast<std::int32_t>(corners[i + k]);
      }
      if (mirrored) std::swap(t[1], t[2]);
      s_.triangles.push_back(t);
    }
  }

  std::vector<double> numbers_of(std::size_t accessor, const std::string& type) {
    const auto& a = j_.at("accessors").at(accessor);
    if (a.at("type") != type || a.contains("sparse")) refuse("an accessor is sparse, or of the wrong type");
    const int component = a.at("componentType").get<int>();
    const std::size_t bytes = component == 5121                        ? 1
                              : component == 5123                      ? 2
                              : component == 5125 || component == 5126 ? 4
                                                                       : 0;
    if (bytes == 0 || (type == "VEC3") != (component == 5126))
      refuse(fmt::format("component type {} in an accessor", component));
    const std::size_t per = type == "VEC3" ? 3 : 1, count = a.at("count").get<std::size_t>();
    const auto& view = j_.at("bufferViews").at(a.at("bufferView").get<std::size_t>());
    const auto& data = buffer(view.at("buffer").get<std::size_t>());
    const std::size_t begin = view.value("byteOffset", std::size_t(0)),
                      length = view.at("byteLength").get<std::size_t>(), offset = a.value("byteOffset", std::size_t(0)),
                      stride = view.value("byteStride", per * bytes);
    if (begin > data.size() || length > data.size() - begin || offset > length || stride < per * bytes ||
        stride > 65536 || count > length || (count > 0 && ((count - 1) * stride + per * bytes > length - offset)))
      refuse("an accessor reaches beyond its buffer");
    std::vector<double> values;
    values.reserve(count * per);
    for (std::size_t i = 0; i < count; ++i)
      for (std::size_t k = 0; k < per; ++k)
        values.push_back(number(data, begin + offset + i * stride + k * bytes, component));
    return values;
  }

  static double number(std::string_view data, std::size_t at, int component) {
    switch (component) {
      case 5121:
        return number_at<std::uint8_t>(data, at, false);
      case 5123:
        return number_at<std::uint16_t>(data, at, !little_endian);
      case 5125:
        return number_at<std::uint32_t>(data, at, !little_endian);
      default:
        return static_cast<double>(number_at<float>(data, at, !little_endian));
    }
  }

  const std::string& buffer(std::size_t index) {
    if (const auto it = buffers_.find(index); it != buffers_.end()) return it->second;
    const auto& b = j_.at("buffers").at(index);
    const auto uri = b.value("uri", std::string());
    std::string data;
    if (uri.empty())
      data = binary_;
    else if (uri.starts_with("data:"))
      data = decode_base64(std::string_view(uri).substr(std::min(uri.find(',') + 1, uri.size())), name_);
    else if (std::filesystem::path(uri).has_parent_path())
      refuse(fmt::format("buffer {}; allowed a file beside it", uri.substr(0, 80)));
    else
      data = read_bytes(folder_ / uri);
    return buffers_.emplace(index, std::move(data)).first->second;
  }

  Json j_;
  std::string binary_;
  std::filesystem::path folder_;
  std::string part_;
  const std::string& name_;
  std::map<std::size_t, std::string> buffers_;
  mesh::Surface s_;
  std::size_t visited_ = 0;
};

}  // namespace

mesh::Surface read_gltf(std::string_view bytes, const std::filesystem::path& folder, const std::string& part,
                        const std::string& name) {
  try {
    return Reader(bytes, folder, part, name).run();
  } catch (const Json::exception& e) {
    throw InputError(fmt::format("{}: is no glTF 2.0: {}", name, e.what()));
  } catch (const std::out_of_range& e) {
    throw InputError(fmt::format("{}: is no glTF 2.0: {}", name, e.what()));
  }
}

}  // namespace carus::imaging
