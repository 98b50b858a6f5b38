// SPDX-License-Identifier: Apache-2.0
// Files of triangles: every format gives the same organ at the same place; damaged ones are refused.
#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cstring>
#include <fstream>
#include <random>
#include <set>

#include "carus/core/error.hpp"
#include "carus/imaging/read_surface.hpp"
#include "carus/imaging/write_surface.hpp"
#include "support/closed_shapes.hpp"

namespace carus {
namespace {

namespace fs = std::filesystem;
using mesh::Surface;

fs::path temporary(const std::string& name) { return fs::path(testing::TempDir()) / name; }
fs::path file_with(const std::string& bytes, const std::string& name) {
  std::ofstream(temporary(name), std::ios::binary) << bytes;
  return temporary(name);
}
std::string bytes_of(const fs::path& file) {
  std::ifstream in(file, std::ios::binary);
  return {std::istreambuf_iterator<char>(in), {}};
}

/// No two axes alike.
Surface organ() { return test::box_surface({0.01, 0.02, 0.03}, {0.05, 0.05, 0.05}); }

std::string obj_bytes(const Surface& s, double unit) {
  std::string text = "# a test's\no organ\n";
  for (const auto& x : s.nodes)
    text += fmt::format("v {} {} {} 0.5 0.5 0.5\n", x.x() / unit, x.y() / unit, x.z() / unit);
  for (const auto& t : s.triangles)
    text += fmt::format("f {}//1 {}/2 {}\n", t[0] + 1, t[1] + 1, t[2] - int(s.nodes.size()));
  return text;
}
std::string ply_text(const Surface& s) {
  std::string text = fmt::format(
      "ply\nformat ascii 1.0\nelement vertex {}\nproperty float x\nproperty float y\nproperty float z\nelement face "
      "{}\nproperty list uchar int vertex_indices\nend_header\n",
      s.nodes.size(), s.triangles.size());
  for (const auto& x : s.nodes) text += fmt::format("{} {} {}\n", 1e3 * x.x(), 1e3 * x.y(), 1e3 * x.z());
  for (const auto& t : s.triangles) text += fmt::format("3 {} {} {}\n", t[0], t[1], t[2]);
  return text;
}
std::string glb_bytes(const Surface& s, const std::string& node) {
  std::string data;
  for (const auto& x : s.nodes)
    for (int k = 0; k < 3; ++k) {
      const auto v = static_cast<float>(x[k]);
      data.append(reinterpret_cast<const char*>(&v), 4);
    }
  const auto positions = data.size();
  for (const auto& t : s.triangles)
    for (const auto i : t) {
      const auto v = static_cast<std::uint16_t>(i);
      data.append(reinterpret_cast<const char*>(&v), 2);
    }
  auto json = fmt::format(
      R"({{"asset":{{"version":"2.0"}},"nodes":[{{"name":"root","children":[1]}},{{"name":"Sacrum","mesh":0,{}}}],)"
      R"("meshes":[{{"primitives":[{{"attributes":{{"POSITION":0}},"indices":1}}]}}],)"
      R"("accessors":[{{"bufferView":0,"componentType":5126,"count":{},"type":"VEC3"}},)"
      R"({{"bufferView":1,"componentType":5123,"count":{},"type":"SCALAR"}}],)"
      R"("bufferViews":[{{"buffer":0,"byteLength":{}}},{{"buffer":0,"byteOffset":{},"byteLength":{}}}],)"
      R"("buffers":[{{"byteLength":{}}}]}})",
      node, s.nodes.size(), 3 * s.triangles.size(), positions, positions, data.size() - positions, data.size());
  while (json.size() % 4 != 0) json += ' ';
  while (data.size() % 4 != 0) data += '\0';
  const auto word = [](std::size_t v) {
    const auto w = static_cast<std::uint32_t>(v);
    return std::string(reinterpret_cast<const char*>(&w), 4);
  };
  return "glTF" + word(2) + word(28 + json.size() + data.size()) + word(json.size()) + "JSON" + json +
         word(data.size()) + std::string("BIN\0", 4) + data;
}

void expect_organ(const mesh::Closed& c, const Surface& wanted) {
  EXPECT_NEAR(mesh::volume(c.surface), mesh::volume(wanted), 1e-6 * mesh::volume(wanted));  // single precision in files
  EXPECT_LT((mesh::box(c.surface).min() - mesh::box(wanted).min()).norm(), 1e-8);
  EXPECT_LT((mesh::box(c.surface).max() - mesh::box(wanted).max()).norm(), 1e-8);
  EXPECT_EQ(c.surface.triangles.size(), wanted.triangles.size());
}

TEST(SurfaceFile, EveryFormatGivesTheSameOrgan) {
  const auto s = organ();
  for (const char* kind : {"stl", "ply", "vtp"}) {
    const auto file = temporary(fmt::format("organ.{}", kind));
    imaging::write_surface(s, file);
    expect_organ(imaging::read_surface({file, "mm", "RAS", ""}), s);
  }
  expect_organ(imaging::read_surface({file_with(obj_bytes(s, 0.01), "organ.obj"), "cm", "RAS", ""}), s);
  expect_organ(imaging::read_surface({file_with(ply_text(s), "text.ply"), "mm", "RAS", ""}), s);
  expect_organ(
      imaging::read_surface({file_with(glb_bytes(s, R"("scale":[1,1,1])"), "organ.glb"), "m", "RAS", "Sacrum"}), s);
  std::string text = "solid organ\n";
  for (const auto& t : s.triangles) {
    text += "facet normal 0 0 0\nouter loop\n";
    for (const auto i : t)
      text += fmt::format("vertex {} {} {}\n", 1e3 * s.nodes[i].x(), 1e3 * s.nodes[i].y(), 1e3 * s.nodes[i].z());
    text += "endloop\nendfacet\n";
  }
  expect_organ(imaging::read_surface({file_with(text + "endsolid\n", "text.stl"), "mm", "RAS", ""}), s);
}

TEST(SurfaceFile, FramesAndUnitsAreTheFilesOwn) {
  // LPS: half a turn about z. LSA, as glTF: +x left, +y up, +z to the front. RSA is left-handed: outward stays outward.
  const auto file = file_with(obj_bytes(organ(), 0.001), "frames.obj");
  const auto low = [&](const char* frame) {
    return mesh::box(imaging::read_surface({file, "mm", frame, ""}).surface).min();
  };
  EXPECT_LT((low("LPS") - Vec3(-0.05, -0.05, 0.03)).norm(), 1e-9);
  EXPECT_LT((low("LSA") - Vec3(-0.05, 0.03, 0.02)).norm(), 1e-9);
  EXPECT_LT((low("RSA") - Vec3(0.01, 0.03, 0.02)).norm(), 1e-9);
  const auto left_handed = imaging::read_surface({file, "mm", "RSA", ""});
  EXPECT_TRUE(left_handed.repairs.empty()) << testing::PrintToString(left_handed.repairs);
  EXPECT_THROW(static_cast<void>(imaging::read_surface({file, "", "RAS", ""})), InputError);
  EXPECT_THROW(static_cast<void>(imaging::read_surface({file, "mm", "", ""})), InputError);
  EXPECT_THROW(static_cast<void>(imaging::read_surface({file, "mm", "RAL", ""})), InputError);
  const auto turned = file_with(
      glb_bytes(organ(),
                R"("translation":[1,0,0],"rotation":[0,0,0.7071067811865476,0.7071067811865476],"scale":[2,2,2])"),
      "turned.glb");
  // Turned a quarter about z: x to y, y to -x; then moved.
  const auto box = mesh::box(imaging::read_surface({turned, "m", "RAS", ""}).surface);
  EXPECT_LT((box.min() - Vec3(1 - 0.10, 0.02, 0.06)).norm(), 1e-6);
  EXPECT_LT((box.max() - Vec3(1 - 0.04, 0.10, 0.10)).norm(), 1e-6);
}

/// Writes the bytes, reads the file: fine or refused.
bool reads(const std::string& bytes, const fs::path& file) {
  std::ofstream(file, std::ios::binary | std::ios::trunc) << bytes;
  try {
    static_cast<void>(imaging::read_surface({file, "mm", "RAS", ""}));
    return true;
  } catch (const InputError&) {
    return false;
  }
}

TEST(SurfaceFile, DamagedFilesNeverCrashTheirReader) {
  const auto s = organ();
  std::vector<std::pair<std::string, std::string>> corpus{
      {"fuzz.obj", obj_bytes(s, 0.001)}, {"fuzz.ply", ply_text(s)}, {"fuzz.glb", glb_bytes(s, R"("scale":[1,1,1])")}};
  for (const char* kind : {"stl", "ply", "vtp"}) {
    imaging::write_surface(s, temporary(fmt::format("seed.{}", kind)));
    corpus.emplace_back(fmt::format("fuzz_binary.{}", kind), bytes_of(temporary(fmt::format("seed.{}", kind))));
  }
  // Kept: what once went wrong, here or in other readers of these formats.
  const std::vector<std::pair<std::string, std::string>> kept{
      {"kept.ply", "ply\nformat ascii 1.0\nelement vertex 999999999\nproperty float x\nend_header\n"},
      {"kept.ply",
       "ply\nformat binary_little_endian 1.0\nelement face 1\nproperty list uint int "
       "vertex_indices\nend_header\n\xff\xff\xff\xff"},
      {"kept.ply", "ply\nformat ascii 1.0\nelement vertex 5\nend_header\n"},
      {"kept.obj", "f 1 2 3\nv 0 0 0\n"},
      {"kept.obj", "v 0 0 0\nf -2147483648 9223372036854775807 -9223372036854775808\n"},
      {"kept.stl", std::string(80, ' ') + "\xff\xff\xff\xff"},
      {"kept.stl", "solid\nfacet normal\nvertex nan nan nan\nendsolid"},
      {"kept.glb", "glTF"},
      {"kept.gltf", R"({"nodes":[{"children":[1]},{"children":[0]},{"children":[0]}]})"},
      {"kept.gltf",
       R"({"nodes":[{"mesh":0}],"meshes":[{"primitives":[{"attributes":{"POSITION":0}}]}],"accessors":[{"bufferView":0,"componentType":5126,"count":18446744073709551615,"type":"VEC3"}],"bufferViews":[{"buffer":0,"byteLength":12}],"buffers":[{"uri":"data:;base64,AAAA"}]})"},
      {"kept.gltf", std::string(100000, '[')},
      {"kept.vtp", "<VTKFile type=\"PolyData\"><PolyData><Piece NumberOfPoints=\"99\"/></PolyData></VTKFile>"}};
  for (const auto& [name, bytes] : kept) EXPECT_FALSE(reads(bytes, temporary(name))) << bytes.substr(0, 80);
  std::mt19937 random(2);
  for (const auto& [name, bytes] : corpus) {
    int well = 0;
    EXPECT_TRUE(reads(bytes, temporary(name))) << name;
    for (int n = 0; n < 400; ++n) {
      auto bad = bytes;
      if (n % 4 == 0) bad.resize(random() % bad.size());
      for (auto k = random() % 5; k > 0 && !bad.empty(); --k) {
        static constexpr std::array<char, 6> nasty{'\0', '\xff', '\x7f', '9', '-', ' '};
        bad[random() % bad.size()] = n % 2 == 0 ? nasty[random() % nasty.size()] : char(random());
      }
      well += reads(bad, temporary(name));
    }
    EXPECT_LT(well, 400) << name;
  }
}

}  // namespace
}  // namespace carus
