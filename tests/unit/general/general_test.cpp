// SPDX-License-Identifier: Apache-2.0
// A general model from its file to its results folder, and what is refused on the way.
#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <unistd.h>

#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>

#include "carus/core/error.hpp"
#include "carus/general/run.hpp"
#include "carus/mesh/tet_mesh.hpp"
#include "carus/results/birth_run.hpp"
#include "carus/results/curves.hpp"
#include "carus/results/files.hpp"
#include "carus/results/read_mesh.hpp"
#include "carus/scenario/schema.hpp"

namespace carus::general {
namespace {

namespace fs = std::filesystem;
using testing::HasSubstr;

const fs::path models = fs::path(CARUS_SOURCE_DIR) / "scenarios/models";

const std::string block = R"(
kind: model
meshes: [{shape: box, region: block, size: [20 mm, 20 mm, 20 mm], cells: [2, 2, 2]}]
regions: [{name: block, material: {c10: 10 kPa, poisson: 0.3}}]
node_sets:
  - {name: low, low: [0 mm, 0 mm, 0 mm], high: [20 mm, 20 mm, 0 mm]}
  - {name: high, low: [0 mm, 0 mm, 20 mm], high: [20 mm, 20 mm, 20 mm]}
fixed: [{nodes: low}]
motions: [{nodes: high, displacement: [0 mm, 0 mm, 2 mm]}]
solver: {analysis: quasi_static}
numerics: {duration: 0.2 s, drag: 200 1/s}
output: {frames: 2, rows: 4}
)";

fs::path fresh(const std::string& name) {
  const fs::path dir = fs::temp_directory_path() / ("carus_general_" + std::to_string(getpid())) / name;
  fs::remove_all(dir);
  fs::create_directories(dir);
  return dir;
}

Outcome run_into(const scenario::ModelScenario& s, const fs::path& out, bool resume = false,
                 const std::atomic<bool>* stop = nullptr) {
  const auto model = build(s, gather_meshes(s));
  const auto engine = make_engine(s, model.model);
  RunOptions o;
  o.out = out, o.resume = resume, o.version = "test", o.stop = stop;
  results::prepare_folder(out, resume);
  return run(s, model, *engine, o);
}

std::string refusal(const std::string& more) {
  try {
    const auto s = scenario::parse_model(block + more, "s.yaml");
    const auto model = build(s, gather_meshes(s));
    static_cast<void>(make_engine(s, model.model));
  } catch (const InputError& error) {
    return error.what();
  }
  return "taken";
}

/// A key given again in block's text would be refused as given twice: replace it.
std::string with(const std::string& from, const std::string& to) {
  std::string text = block;
  const auto at = text.find(from);
  EXPECT_NE(at, std::string::npos) << from;
  text.replace(at, from.size(), to);
  try {
    const auto s = scenario::parse_model(text, "s.yaml");
    const auto model = build(s, gather_meshes(s));
    static_cast<void>(make_engine(s, model.model));
  } catch (const InputError& error) {
    return error.what();
  }
  return "taken";
}

TEST(General, WritesAWholeResultsFolder) {
  const auto s = scenario::parse_model(block, "s.yaml");
  const fs::path out = fresh("whole");
  ASSERT_EQ(run_into(s, out), Outcome::done);
  const auto j = nlohmann::json::parse(results::read_text(out / "summary.json"));
  EXPECT_EQ(j.at("outcome"), "done");
  EXPECT_NEAR(j.at("end").at("high_uz_mm").get<double>(), 2, 1e-6);
  // Held at both ends: what pulls at one pulls at the other.
  const double up = j.at("end").at("high_rz_n"), down = j.at("end").at("low_rz_n");
  EXPECT_GT(up, 0);
  EXPECT_NEAR(up, -down, 0.01 * up);
  EXPECT_EQ(results::read_curves(out / "curves.csv").rows.size(), 5u);
  // A frame is a mesh with the same names.
  const auto frame = results::read_vtu(out / "frames/frame_0002.vtu");
  EXPECT_EQ(frame.regions, std::vector<std::string>{"block"});
  EXPECT_EQ(frame.mesh.tets.size(), 48u);
  EXPECT_NEAR(frame.mesh.nodes.back().z(), 0.022, 1e-6);
  // The resolved scenario is the same scenario.
  const auto resolved = scenario::load_model(out / "scenario.resolved.yaml");
  EXPECT_EQ(resolved.resolved, s.resolved);
}

TEST(General, GoesOnAfterAnInterruptionToTheSameBits) {
  const auto s = scenario::parse_model(block, "s.yaml");
  const fs::path whole = fresh("uninterrupted"), broken = fresh("interrupted");
  ASSERT_EQ(run_into(s, whole), Outcome::done);
  const std::atomic<bool> stop{true};
  ASSERT_EQ(run_into(s, broken, false, &stop), Outcome::interrupted);
  ASSERT_EQ(run_into(s, broken, true), Outcome::done);
  EXPECT_EQ(results::read_text(whole / "curves.csv"), results::read_text(broken / "curves.csv"));
}

TEST(General, ExamplesAreSound) {
  for (const char* file : {"cantilever.yaml", "pressed_blocks.yaml"}) {
    const auto s = scenario::load_model(models / file);
    const auto model = build(s, gather_meshes(s));
    EXPECT_GT(model.model.mesh.tets.size(), 100u);
    EXPECT_EQ(scenario::kind_of(models / file), scenario::Kind::model);
  }
  EXPECT_EQ(scenario::kind_of(fs::path(CARUS_SOURCE_DIR) / "scenarios/reference.yaml"), scenario::Kind::birth);
}

TEST(General, AMeshFileKeepsItsNames) {
  const auto mesh = results::read_vtu(models / "two_blocks.vtu");
  EXPECT_EQ(mesh.regions, (std::vector<std::string>{"hard", "soft"}));
  ASSERT_EQ(mesh.surfaces.size(), 2u);
  EXPECT_EQ(mesh.surfaces[0].name, "top");
  EXPECT_EQ(mesh.surfaces[0].triangles.size(), 18u);
  ASSERT_EQ(mesh.nodes.size(), 1u);
  EXPECT_EQ(mesh.nodes[0].name, "corner");
  EXPECT_EQ(mesh.nodes[0].nodes, std::vector<std::int32_t>{0});
  for (std::size_t e = 0; e < mesh.mesh.tets.size(); ++e) EXPECT_GT(mesh::volume(mesh.mesh, e), 0) << e;
}

#ifdef CARUS_WITH_MESHING
/// Two tets of two volumes that share a facet, in MSH 2 and 4.
TEST(General, ReadsGmshFiles) {
  const fs::path dir = fresh("msh");
  std::ofstream(dir / "two.msh") << R"($MeshFormat
2.2 0 8
$EndMeshFormat
$PhysicalNames
4
0 4 "tip"
2 3 "base"
3 1 "left"
3 2 "right"
$EndPhysicalNames
$Nodes
5
1 0 0 0
2 10 0 0
3 0 10 0
4 0 0 10
5 10 10 10
$EndNodes
$Elements
4
1 4 2 1 1 1 2 3 4
2 4 2 2 2 2 3 4 5
3 2 2 3 1 1 2 3
4 15 2 4 1 5
$EndElements
)";
  const std::string text = fmt::format(R"(
kind: model
meshes: [{{file: two.msh, unit: mm}}]
regions: [{{name: left, material: {{c10: 1 kPa}}}}, {{name: right, material: {{c10: 2 kPa}}}}]
fixed: [{{nodes: base}}]
motions: [{{nodes: tip, displacement: [1 mm, 0 mm, 0 mm]}}]
)");
  const auto s = scenario::parse_model(text, dir / "s.yaml");
  const auto model = build(s, gather_meshes(s));
  EXPECT_EQ(model.model.mesh.nodes.size(), 5u);
  ASSERT_EQ(model.model.regions.size(), 2u);
  EXPECT_EQ(model.model.regions[1].name, "right");
  EXPECT_DOUBLE_EQ(model.model.regions[1].material.c10, 2000);
  EXPECT_NEAR(mesh::volume(model.model.mesh, 0), 1e-6 / 6, 1e-15);
  ASSERT_EQ(model.model.motions[0].nodes.size(), 1u);  // gmsh numbers by geometry, not by tag
  EXPECT_LT((model.model.mesh.nodes[model.model.motions[0].nodes[0]] - Vec3::Constant(0.01)).norm(), 1e-12);
  std::ofstream(dir / "broken.msh") << "$MeshFormat\n4.1 0 8\n";
  try {
    const auto broken = scenario::parse_model("kind: model\nmeshes: [{file: broken.msh}]\n", dir / "s.yaml");
    static_cast<void>(gather_meshes(broken));
    ADD_FAILURE() << "took half a file";
  } catch (const InputError& error) {
    EXPECT_THAT(error.what(), HasSubstr("broken.msh"));
  }
}
#endif

TEST(General, RefusesWithPlaceAndHint) {
  EXPECT_EQ(refusal(""), "taken");
  EXPECT_THAT(with("nodes: low}", "nodes: lo}"),
              HasSubstr("fixed.nodes: no node set, surface or region \"lo\"; did you mean \"low\"?"));
  EXPECT_THAT(with("name: block, material", "name: blok, material"), HasSubstr("silent about \"block\""));
  EXPECT_THAT(with("cells: [2, 2, 2]", "cells: [2, 2]"), HasSubstr("has 2 numbers; allowed 3 for a box"));
  EXPECT_THAT(with("displacement: [0 mm, 0 mm, 2 mm]", "displacement: [0 mm, 2 mm]"),
              HasSubstr("2 components; allowed 3"));
  EXPECT_THAT(with("high: [20 mm, 20 mm, 0 mm]", "high: [-20 mm, 20 mm, 0 mm]"), HasSubstr("low is above high"));
  EXPECT_THAT(with("low: [0 mm, 0 mm, 20 mm]", "low: [0 mm, 0 mm, 20.5 mm]"), HasSubstr("low is above high"));
  EXPECT_THAT(with("low: [0 mm, 0 mm, 20 mm], high: [20 mm, 20 mm, 20 mm]", "low: [0 mm, 0 mm, 21 mm]"),
              HasSubstr("\"high\" has no nodes"));
  EXPECT_THAT(refusal("pressures: [{surface: top, pressure: 1 kPa}]\n"),
              HasSubstr("no surface \"top\"; there is none"));
  EXPECT_THAT(refusal("curves: [{name: c, points: [{time: 1 s}, {time: 0 s}]}]\n"), HasSubstr("rising times"));
  EXPECT_THAT(with("nodes: high,", "nodes: low,"), HasSubstr("are fixed, or moved by another motion"));
  EXPECT_THAT(with("analysis: quasi_static", "analysis: static"), HasSubstr("static needs solver.kind implicit"));
  EXPECT_EQ(with("{analysis: quasi_static}", "{kind: implicit, analysis: static}"), "taken");
  EXPECT_THAT(with("poisson: 0.3}", "poisson: 0.3, prony: [{g: 0.6}, {g: 0.6}]}"), HasSubstr("the sum of prony g"));
  EXPECT_THAT(with("{shape: box, region: block, size: [20 mm, 20 mm, 20 mm], cells: [2, 2, 2]}", "{file: none.vtu}"),
              HasSubstr("none.vtu\" is not there"));
}

/// A birth is no special case, but for this.
TEST(General, ABirthMayNotGuideTheFetus) {
  const std::string birth = R"(
kind: model
meshes:
  - {shape: ball, region: skull, radius: 10 mm, cells: [4]}
  - {shape: tube, region: vaginal_canal, radius: 20 mm, inner_radius: 15 mm, height: 20 mm, cells: [1, 8, 2]}
regions: [{name: skull, material: {c10: 10 kPa}}, {name: vaginal_canal, material: {c10: 10 kPa}}]
)";
  const auto built = [&](const std::string& more) -> std::string {
    const auto s = scenario::parse_model(birth + more, "s.yaml");
    try {
      static_cast<void>(build(s, gather_meshes(s)));
    } catch (const InputError& error) {
      return error.what();
    }
    return "taken";
  };
  EXPECT_EQ(built("motions: [{nodes: vaginal_canal, displacement: [0 mm, 0 mm, 1 mm]}]\n"), "taken");
  EXPECT_THAT(built("motions: [{nodes: skull, displacement: [0 mm, 0 mm, 1 mm]}]\n"),
              HasSubstr("the motion of \"skull\" is prescribed in a birth"));
  EXPECT_THAT(built("fixed: [{nodes: skull, axes: x}]\n"), HasSubstr("prescribed in a birth"));
}

/// The same key, its name misspelt, is proposed from the general model's own keys.
TEST(General, UnknownKeysFindTheirNeighbours) {
  EXPECT_THAT(refusal("mottions: []\n"), HasSubstr("mottions: unknown key; did you mean motions?"));
}

TEST(General, ReferencePageIsUpToDate) {
  const fs::path page = fs::path(CARUS_SOURCE_DIR) / "docs/reference/model.md";
  if (std::getenv("CARUS_WRITE_DOCS") != nullptr) std::ofstream(page) << scenario::model_schema_markdown();
  std::ifstream in(page);
  EXPECT_EQ(std::string(std::istreambuf_iterator<char>(in), {}), scenario::model_schema_markdown())
      << "CARUS_WRITE_DOCS=1 carus_unit_tests --gtest_filter=General.ReferencePageIsUpToDate writes it";
}

}  // namespace
}  // namespace carus::general
