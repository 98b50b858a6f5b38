// SPDX-License-Identifier: Apache-2.0
#include "carus/results/import.hpp"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <fstream>

#include "carus/core/error.hpp"
#include "carus/results/export.hpp"
#include "carus/results/files.hpp"
#include "mover.hpp"
#include "support/shapes.hpp"

namespace carus::results {
namespace {

namespace fs = std::filesystem;
using test::Folder;

/// Three boxes with numbers that no decimal or single-precision number holds exactly.
anatomy::Anatomy boxes(const scenario::Scenario& s) {
  anatomy::Anatomy a;
  a.parameters = s.anatomy;
  const auto body = [](const char* name, double z, std::int32_t label) {
    anatomy::Body b{name, shapes::box({0.1 / 3, 0, z}, {0.1, 0.1 / 7, 0.1}, 2, 3, 4, label), {}, {}};
    b.mesh.labels[3] = label + 1;
    b.nodes = {{"back", {4, 1, 7}}, {"vulva", {0}}};
    b.surfaces = {{"inner", mesh::boundary(b.mesh)}, {"outer", {{3, 1, 2}, {2, 1, 0}}}};
    return b;
  };
  a.fetus = body("fetus", 0, anatomy::skull);
  a.uterus = body("uterus", 1, anatomy::lower_segment);
  a.abdomen = body("abdomen", 2, anatomy::levator_ani);
  for (std::size_t e = 0; e < a.uterus.mesh.tets.size(); ++e) {
    const double t = std::sqrt(double(e) + 0.1);
    a.uterine_wall.push_back({Vec3(std::cos(t), std::sin(t), 0), Vec3(0, -1, t), t / 3, 1 / (1 + t)});
  }
  a.landmarks = {{"head_centre", {1. / 3, 0, -0.04}}, {"vulva_normal", {0, 0.6, -0.8}}};
  a.requested = {{"interspinous", 0.1123}};
  a.measured = {{"interspinous", 0.1123 / 3}, {"nowhere", NAN}};
  a.warnings = {"a \"quoted\" warning"};
  return a;
}

void write(const Folder& folder, const scenario::Scenario& s) {
  export_anatomy(boxes(s), scenario::anatomy_settings(s), folder.path());
}

std::vector<std::string> problems(const fs::path& folder, const scenario::Scenario& s) {
  try {
    read_anatomy(folder, s);
    return {};
  } catch (const InputError& error) {
    return error.problems();
  }
}

TEST(ReadyMeshes, ReadBackBitForBit) {
  const Folder folder("ready");
  const auto s = scenario::parse("", "s.yaml");
  write(folder, s);
  const auto a = boxes(s), b = read_anatomy(folder.path(), s);
  for (const auto& [was, is] : {std::pair(&a.fetus, &b.fetus), {&a.uterus, &b.uterus}, {&a.abdomen, &b.abdomen}}) {
    EXPECT_EQ(is->name, was->name);
    EXPECT_EQ(is->mesh.nodes, was->mesh.nodes);
    EXPECT_EQ(is->mesh.tets, was->mesh.tets);
    EXPECT_EQ(is->mesh.labels, was->mesh.labels);
    ASSERT_EQ(is->nodes.size(), was->nodes.size());
    for (std::size_t i = 0; i < was->nodes.size(); ++i) {
      EXPECT_EQ(is->nodes[i].name, was->nodes[i].name);
      EXPECT_EQ(is->nodes[i].nodes, was->nodes[i].nodes);
    }
    ASSERT_EQ(is->surfaces.size(), was->surfaces.size());
    for (std::size_t i = 0; i < was->surfaces.size(); ++i) {
      EXPECT_EQ(is->surfaces[i].name, was->surfaces[i].name);
      EXPECT_EQ(is->surfaces[i].triangles, was->surfaces[i].triangles);
    }
  }
  ASSERT_EQ(b.uterine_wall.size(), a.uterine_wall.size());
  for (std::size_t e = 0; e < a.uterine_wall.size(); ++e) {
    EXPECT_EQ(b.uterine_wall[e].meridian, a.uterine_wall[e].meridian);
    EXPECT_EQ(b.uterine_wall[e].normal, a.uterine_wall[e].normal);
    EXPECT_EQ(b.uterine_wall[e].s, a.uterine_wall[e].s);
    EXPECT_EQ(b.uterine_wall[e].dome, a.uterine_wall[e].dome);
  }
  EXPECT_EQ(b.landmarks, a.landmarks);
  EXPECT_EQ(b.requested, a.requested);
  EXPECT_EQ(b.measured.at("interspinous"), a.measured.at("interspinous"));
  EXPECT_TRUE(std::isnan(b.measured.at("nowhere")));
  EXPECT_EQ(b.warnings, a.warnings);
  EXPECT_EQ(b.parameters.canal.radius, s.anatomy.canal.radius);
}

TEST(ReadyMeshes, AreNotForOtherDimensions) {
  const Folder folder("ready_other");
  write(folder, scenario::parse("", "s.yaml", {"canal.radius=46 mm", "fetus.position=LOT"}));
  const auto other = scenario::parse("", "s.yaml",
                                     {"canal.radius=50 mm", "resolution=fine", "numerics.mesh_factor=1.5",
                                      "fetus.position=OA", "numerics.drag=1 1/s"});
  const std::string f = folder.path().string(), hint = "; make them equal, or mesh again with carus anatomy";
  EXPECT_EQ(problems(folder.path(), other),
            (std::vector<std::string>{
                "s.yaml: anatomy.from: " + f + " was meshed with canal.radius 46 mm, the scenario says 50 mm" + hint,
                "s.yaml: anatomy.from: " + f + " was meshed with fetus.position LOT, the scenario says OA" + hint,
                "s.yaml: anatomy.from: " + f + " was meshed with numerics.mesh_factor 1, the scenario says 1.5" + hint,
                "s.yaml: anatomy.from: " + f + " was meshed with resolution paper, the scenario says fine" + hint}));
}

TEST(ReadyMeshes, MissingAndWrongFilesAreNamed) {
  const Folder folder("ready_bad");
  const auto s = scenario::parse("", "s.yaml");
  const std::string f = folder.path().string(), hint = "; write the folder again with carus anatomy";
  using Messages = std::vector<std::string>;
  EXPECT_EQ(problems("nowhere", s), Messages{"s.yaml: anatomy.from: \"nowhere\" is no folder; allowed one that carus "
                                             "anatomy SCENARIO --out DIR wrote"});
  EXPECT_EQ(problems(folder.path(), s), Messages{f + "/anatomy.json: no such file" + hint});
  write(folder, s);
  fs::remove(folder / "uterus.vtu");
  std::ofstream(folder / "fetus.vtu") << "not a mesh";
  EXPECT_EQ(problems(folder.path(), s), (Messages{f + "/fetus.vtu: is not a VTU file, or is truncated" + hint,
                                                  f + "/uterus.vtu: no such file" + hint}));
  write(folder, s);
  fs::copy_file(folder / "abdomen.vtu", folder / "fetus.vtu", fs::copy_options::overwrite_existing);
  fs::copy_file(folder / "fetus.vtu", folder / "uterus.vtu", fs::copy_options::overwrite_existing);
  EXPECT_EQ(problems(folder.path(), s),
            (Messages{f + "/fetus.vtu: is not the mesh that anatomy.json describes" + hint,
                      f + "/uterus.vtu: is not the mesh that anatomy.json describes" + hint}));
  write(folder, s);
  std::string text = read_text(folder / "anatomy.json");
  text.replace(text.find("carus anatomy 1"), 15, "carus anatomy 9");
  std::ofstream(folder / "anatomy.json") << text;
  EXPECT_EQ(problems(folder.path(), s),
            Messages{f + "/anatomy.json: format \"carus anatomy 9\"; allowed \"carus anatomy 1\"" + hint});
}

/// Wherever a file is cut, it is refused by name; the reader neither crashes nor returns a part.
TEST(ReadyMeshes, TruncatedFilesAreRefused) {
  const Folder folder("ready_cut");
  const auto s = scenario::parse("", "s.yaml");
  for (const char* name : {"fetus.vtu", "uterus.vtu", "anatomy.json"}) {
    write(folder, s);
    const auto size = fs::file_size(folder / name);
    for (int part = 9; part >= 0; --part) {
      fs::resize_file(folder / name, part == 9 ? size - 20 : size * std::uintmax_t(part) / 10);
      const auto found = problems(folder.path(), s);
      ASSERT_EQ(found.size(), 1u) << name << " at " << part;
      EXPECT_EQ(found[0].find((folder / name).string() + ": "), 0u) << found[0];
    }
  }
}

}  // namespace
}  // namespace carus::results
