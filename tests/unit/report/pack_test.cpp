// SPDX-License-Identifier: Apache-2.0
#include "carus/report/pack.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "carus/report/manifest.hpp"
#include "carus/report/wrench.hpp"
#include "carus/results/frames.hpp"
#include "small_run.hpp"

namespace carus::report {
namespace {

namespace fs = std::filesystem;
using testing::HasSubstr;

/// Positions of all frames as a viewer decodes them [m].
std::vector<std::vector<double>> decoded(const FramePacker& p) {
  const auto n = p.mesh().nodes.size();
  auto rest = from_planes(inflate(p.rest().bytes, p.rest().raw), p.rest().planes, 3 * n);
  for (std::size_t i = 1; i < rest.size(); ++i) rest[i] += rest[i - 1];
  std::vector<std::vector<double>> all;
  for (const auto& c : p.chunks()) {
    for (const auto& frame : unpack_frames(c.position, c.times.size(), rest, 3 * n)) {
      all.emplace_back();
      for (const auto q : frame) all.back().push_back(p.options().quantum * q);
    }
  }
  return all;
}

class PackedFrames : public testing::Test {
 protected:
  PackedFrames() { test::write_small_run(dir, 0.4, 20); }
  FramePacker packer() const {
    PackOptions o;
    o.frames_per_chunk = 6;
    return FramePacker(dir / "frames.pvd", test::quick_scenario().materials, o);
  }
  test::Folder folder{std::string("report_pack_") + testing::UnitTest::GetInstance()->current_test_info()->name()};
  fs::path dir = folder / "run";
};

TEST_F(PackedFrames, AreThoseOfTheFilesWithinHalfAStep) {
  auto p = packer();
  p.update();
  const auto entries = read_frame_index(dir / "frames.pvd");
  const auto positions = decoded(p);
  ASSERT_EQ(positions.size(), entries.size());
  ASSERT_GT(positions.size(), 12u);
  EXPECT_THAT(p.notes(), testing::IsEmpty());
  const auto n = p.mesh().nodes.size();
  double worst = 0, moved = 0;
  for (std::size_t f = 0; f < entries.size(); ++f) {
    const auto state = read_frame_state(entries[f].file, n, p.mesh().tets.size());
    for (std::size_t i = 0; i < n; ++i) {
      for (std::size_t k = 0; k < 3; ++k) {
        worst = std::max(worst, std::abs(positions[f][k * n + i] - double(state.x[i][k])));
        moved = std::max(moved, std::abs(double(state.x[i][k]) - p.mesh().nodes[i][int(k)]));
      }
    }
  }
  EXPECT_LE(worst, p.options().quantum / 2 * (1 + 1e-6));
  EXPECT_GT(moved, 0.05);
  EXPECT_EQ(p.kinds().size(), 3u);
}

TEST_F(PackedFrames, MeshReadsBack) {
  auto p = packer();
  p.update();
  const auto t = p.mesh().tets.size();
  const auto corners = from_planes(inflate(p.corners().bytes, p.corners().raw), p.corners().planes, 4 * t);
  std::array<std::int32_t, 4> tet{};
  for (std::size_t e = 0; e < t; ++e) {
    for (std::size_t k = 0; k < 4; ++k) tet[k] += corners[4 * e + k];
    ASSERT_EQ(tet, p.mesh().tets[e]) << e;
  }
  auto region = from_planes(inflate(p.region().bytes, p.region().raw), p.region().planes, t);
  for (std::size_t e = 1; e < t; ++e) region[e] += region[e - 1];
  EXPECT_EQ(region, p.mesh().labels);
  EXPECT_EQ(p.mesh().regions, (std::vector<std::string>{"skull", "fetal_body"}));
}

TEST_F(PackedFrames, ADamagedOneIsLeftOutAndNamed) {
  const auto file = dir / "frames/frame_0007.vtu";
  const auto whole = test::text_of(file);
  const auto count = read_frame_index(dir / "frames.pvd").size();
  const auto spoilt = {std::string(),
                       std::string("<VTKFile>"),
                       whole.substr(0, whole.size() / 2),
                       whole.substr(0, whole.size() / 2) + "</VTKFile>\n",
                       std::string("</VTKFile>"),
                       std::string(whole).replace(whole.size() / 2, 400, std::string(400, '\xff')),
                       std::string(whole).replace(whole.find("NumberOfPoints=\""), 17, "NumberOfPoints=\"9")};
  int refused = 0;
  for (const auto& text : spoilt) {
    test::set_text(file, text);
    auto p = packer();
    p.update();
    const auto positions = decoded(p);
    refused += !p.notes().empty();
    EXPECT_EQ(positions.size(), count - p.notes().size());
    for (const auto& note : p.notes()) EXPECT_THAT(note, HasSubstr("frame_0007.vtu"));
  }
  EXPECT_EQ(refused, int(spoilt.size()));
  fs::remove(file);
  auto p = packer();
  p.update();
  ASSERT_EQ(p.notes().size(), 1u);
  EXPECT_THAT(p.notes()[0], HasSubstr("no such file"));
}

TEST_F(PackedFrames, OfAnotherMeshAreLeftOut) {
  auto model = test::fetus_of_boxes();
  test::add_box(model, "other", "other", {1, 1, 1}, {2, 2, 2}, 1);
  const observe::Strain strain(model.mesh);
  results::Frames other(folder / "other", model, strain);
  fem::State state;
  state.x = model.mesh.nodes, state.v.assign(state.x.size(), Vec3::Zero());
  other.write(state, {});
  fs::copy_file(folder / "other/frames/frame_0000.vtu", dir / "frames/frame_0003.vtu",
                fs::copy_options::overwrite_existing);
  auto p = packer();
  p.update();
  ASSERT_EQ(p.notes().size(), 1u);
  EXPECT_THAT(p.notes()[0], HasSubstr("two runs"));
}

TEST_F(PackedFrames, NoneReadableLeavesNothingToShowButAReport) {
  for (const auto& e : read_frame_index(dir / "frames.pvd")) test::set_text(e.file, "x");
  auto p = packer();
  p.update();
  EXPECT_TRUE(p.empty());
  EXPECT_THAT(p.notes().back(), HasSubstr("nothing to show in 3-D"));
  EXPECT_THAT(manifest_of({read_run(dir)}, {}).json, HasSubstr("\"mesh\":null"));
}

TEST_F(PackedFrames, AnIndexThatLeadsOutOfTheFolderOrIsTornIsRefused) {
  const auto index = [&](const std::string& element) {
    test::set_text(dir / "frames.pvd", "<VTKFile><Collection>" + element + "</Collection></VTKFile>");
    return test::error_of([&] { read_frame_index(dir / "frames.pvd"); });
  };
  EXPECT_EQ(index("<DataSet timestep=\"0\" file=\"frames/a.vtu\"/>"), "");
  EXPECT_THAT(index("<DataSet timestep=\"0\" file=\"../../etc/passwd\"/>"), HasSubstr("inside the folder"));
  EXPECT_THAT(index("<DataSet timestep=\"0\" file=\"/etc/passwd\"/>"), HasSubstr("inside the folder"));
  EXPECT_THAT(index("<DataSet timestep=\"x\" file=\"a.vtu\"/>"), HasSubstr("timestep \"x\""));
  EXPECT_THAT(index("<DataSet timestep=\"1\" file=\"a.vtu\"/><DataSet timestep=\"1\" file=\"b.vtu\"/>"),
              HasSubstr("frame 1"));
  EXPECT_THAT(index("<DataSet timestep=\"1\""), HasSubstr("does not end"));
  EXPECT_THAT(index("<DataSet/>"), HasSubstr("no timestep"));
  test::set_text(dir / "frames.pvd", "");
  EXPECT_NE(test::error_of([&] { read_frame_index(dir / "frames.pvd"); }), "");
}

TEST_F(PackedFrames, OfARunInProgressAreAddedWithoutReadingTheOldOnes) {
  const auto whole = test::text_of(dir / "frames.pvd");
  auto cut = whole;
  cut.erase(cut.find("    <DataSet timestep", cut.find("frame_0008")),
            cut.find("  </Collection>") - cut.find("    <DataSet timestep", cut.find("frame_0008")));
  test::set_text(dir / "frames.pvd", cut);
  auto p = packer();
  p.update();
  EXPECT_EQ(decoded(p).size(), 9u);
  fs::remove(dir / "frames/frame_0002.vtu");  // of a chunk that is full: not read again
  test::set_text(dir / "frames.pvd", whole);
  p.update();
  EXPECT_EQ(decoded(p).size(), read_frame_index(dir / "frames.pvd").size());
  EXPECT_THAT(p.notes(), testing::IsEmpty());
  // The folder is run anew: everything is.
  test::set_text(dir / "frames.pvd", cut);
  p.update();
  EXPECT_EQ(decoded(p).size(), 8u);
  EXPECT_EQ(p.notes().size(), 1u);
}

TEST(Fields, AreTheirClosedForms) {
  const auto model = test::fetus_of_boxes();
  FrameMesh m;
  m.nodes = model.mesh.nodes, m.tets = model.mesh.tets;
  m.labels = m.organ = model.mesh.labels;
  m.regions = m.organs = {"skull", "fetal_body"};
  material::Material material;
  material.c10 = 75e3, material.poisson = 0.45;
  std::map<std::string, material::Material> materials{{"skull", material}, {"fetal_body", material}};
  const Fields fields(m, materials);
  ASSERT_EQ(fields.kinds()[0].name, "stretch");
  ASSERT_EQ(fields.kinds()[1].name, "contact_pressure");
  ASSERT_EQ(fields.kinds()[2].name, "pressure");

  FrameState s;
  for (const auto& x : m.nodes) s.x.push_back({float(x[0]), float(x[1]), float(x[2])});
  s.stretch.assign(m.tets.size(), 1.5F), s.volume_ratio.assign(m.tets.size(), 0.98F);
  s.contact_force.assign(m.nodes.size(), {0, 0, 0});
  // 7 kPa on the head's lower face: each node takes a third of the facets round it, pushed up.
  double force = 0;
  for (const auto& f : mesh::boundary(m)) {
    const auto low = [&](std::int32_t i) { return m.nodes[i][2] == 0; };
    if (!low(f[0]) || !low(f[1]) || !low(f[2])) continue;
    const double area = 0.08 * 0.10 / 8;  // 2 x 2 squares of two facets
    for (const auto i : f) s.contact_force[i][2] += float(7e3 * area / 3);
    force += 7e3 * area;
  }
  EXPECT_NEAR(force, 7e3 * 0.008, 1e-6);
  const auto stretch = fields.values(0, s), contact = fields.values(1, s), pressure = fields.values(2, s);
  const double expected = -0.5 * material.bulk_modulus() * (0.98 - 1 / 0.98) / 1e3;
  int centres = 0;
  for (std::size_t i = 0; i < m.nodes.size(); ++i) {
    EXPECT_NEAR(stretch[i], 1.5, 1e-5);
    EXPECT_NEAR(pressure[i], expected, 1e-3 * expected);
    const bool centre = m.nodes[i][2] == 0 && std::abs(m.nodes[i][0]) < 0.03 && std::abs(m.nodes[i][1]) < 0.04;
    if (centre) {
      EXPECT_NEAR(contact[i], 7, 1e-4);
      ++centres;
    }
    if (m.nodes[i][2] > 0.01) {
      EXPECT_EQ(contact[i], 0);
    }
  }
  EXPECT_EQ(centres, 1);
  EXPECT_EQ(Fields(m, {}).kinds().size(), 2u) << "no materials, no pressure";

  // The head's wrench: that force, at the face's middle, 40 mm below the centre: no moment. Shifted forces have one.
  m.organ.assign(m.tets.size(), 0);
  const Head head(m, "test");
  EXPECT_NEAR((head.rest_centre() - Vec3(0, 0, 0.04)).norm(), 0, 1e-7);
  auto w = head.contact(s);
  EXPECT_NEAR(w.force.z(), force, 1e-3);
  EXPECT_NEAR(w.moment.norm(), 0, 1e-3);
  for (std::size_t i = 0; i < m.nodes.size(); ++i) {
    if (m.nodes[i][0] < 0.01) s.contact_force[i] = {0, 0, 0};
  }
  w = head.contact(s);
  EXPECT_NEAR(w.moment.y(), -0.04 * w.force.z(), 1e-6) << "all that is left acts at x = 40 mm";
  m.regions[0] = "cube";
  EXPECT_THAT(test::error_of([&] { Head(m, "test"); }), HasSubstr("skull"));
}

}  // namespace
}  // namespace carus::report
