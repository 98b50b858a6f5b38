// SPDX-License-Identifier: Apache-2.0
// carus mesh as its users run it, on a phantom of two touching balls and, where it is at hand, on the real pelvis.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <sstream>

#include "program.hpp"
#include "support/label_files.hpp"

namespace {

using namespace carus::test;
using carus::Mat3;
using carus::Vec3;

/// Two balls of 20 and 10 mm that touch, on 1 x 1 x 1.5 mm voxels.
fs::path phantom() {
  static const fs::path file = [] {
    const fs::path f = fresh("phantom.nii");
    const auto v = voxelise({70, 50, 34}, Vec3(0.001, 0.001, 0.0015).asDiagonal(), Vec3(-0.025, -0.025, -0.025),
                            [](const Vec3& x) {
                              return x.norm() < 0.02 ? 1 : (x - Vec3(0.028, 0, 0)).norm() < 0.01 ? 2 : 0;
                            });
    std::ofstream(f, std::ios::binary) << nifti_bytes(v, Form::both);
    return f;
  }();
  return file;
}

std::vector<std::vector<std::string>> csv(const fs::path& file) {
  std::vector<std::vector<std::string>> rows;
  std::istringstream lines(text(file));
  for (std::string line; std::getline(lines, line);) {
    rows.emplace_back();
    std::istringstream cells(line);
    for (std::string cell; std::getline(cells, cell, ',');) rows.back().push_back(cell);
  }
  return rows;
}

TEST(MeshCommand, PrecisionWritesItsContract) {
  const fs::path out = fresh("precision.csv"), log = out.string() + ".log";
  ASSERT_EQ(wait_for(start({"mesh", "precision", "--labels", phantom().string(), "--label", "1", "--out", out.string(),
                            "--samples", "20000"},
                           log)),
            0)
      << text(log);
  const auto rows = csv(out);
  ASSERT_EQ(rows.size(), 13u);
  EXPECT_THAT(std::vector<std::string>(rows[0].begin(), rows[0].begin() + 5),
              testing::ElementsAre("reduction_percent", "nodes", "d_mean_mm", "d_max_mm", "alpha_percent"));
  EXPECT_EQ(rows[1][0], "10");
  EXPECT_EQ(rows[12][0], "98");
  for (std::size_t i = 2; i < rows.size(); ++i) {
    EXPECT_LT(std::stod(rows[i][1]), std::stod(rows[i - 1][1]));
    EXPECT_GT(std::stod(rows[i][2]), std::stod(rows[i - 1][2]));
    EXPECT_GE(std::stod(rows[i][3]), std::stod(rows[i][2]));
  }
  EXPECT_TRUE(fs::exists(fs::path(out).replace_extension(".vtp")));
}

TEST(MeshCommand, VolumeMakesTouchingOrgansShareNodes) {
  const fs::path out = fresh("balls.msh"), log = out.string() + ".log";
  ASSERT_EQ(wait_for(start(
                {"mesh", "volume", "--labels", phantom().string(), "--size", "5 mm", "--size-of", "2=3 mm", "--out",
                 out.string(), fs::path(out).replace_extension(".inp").string(),
                 fs::path(out).replace_extension(".vtu").string(), fs::path(out).replace_extension(".stl").string()},
                log)),
            0)
      << text(log);
  const auto msh = text(out);
  EXPECT_THAT(msh, testing::HasSubstr("\"label_2_to_label_1\""));  // where they touch, facets of both
  EXPECT_THAT(msh, testing::HasSubstr("$EndElements"));
  EXPECT_THAT(text(fs::path(out).replace_extension(".inp")), testing::HasSubstr("TYPE=C3D4, ELSET=label_2"));
  EXPECT_TRUE(fs::exists(fs::path(out).replace_extension(".vtu")));
  EXPECT_TRUE(fs::exists(fs::path(out).replace_extension(".stl")));
}

TEST(MeshCommand, FeatureAnglesThatCannotBeAreRefused) {
  const fs::path out = fresh("features.vtu"), log = out.string() + ".log";
  EXPECT_EQ(
      wait_for(start(
          {"mesh", "volume", "--labels", phantom().string(), "--feature-angle", "45 deg", "--out", out.string()}, log)),
      2);
  EXPECT_THAT(text(log),
              testing::HasSubstr("--feature-angle is of --surface: the surfaces of labels are smooth; leave it out"));
  const fs::path ball = fresh("smooth_ball.stl");
  ASSERT_EQ(wait_for(start({"mesh", "surface", "--labels", phantom().string(), "--label", "1", "--nodes", "500",
                            "--out", ball.string()},
                           log)),
            0)
      << text(log);
  for (const std::string angle : {"10 deg", "45", "45 mm", "nan deg"}) {
    EXPECT_EQ(wait_for(start({"mesh", "volume", "--surface", ball.string(), "--unit", "mm", "--frame", "RAS",
                              "--feature-angle", angle, "--out", out.string()},
                             log)),
              2);
    EXPECT_THAT(text(log),
                testing::HasSubstr("--feature-angle \"" + angle +
                                   "\"; allowed an angle with its unit from 30 deg to 150 deg, as \"45 deg\""));
  }
  EXPECT_FALSE(fs::exists(out));
}

TEST(MeshCommand, SurfaceIsSimplifiedAsAskedAndBadInputRefused) {
  const fs::path out = fresh("ball.stl"), log = out.string() + ".log";
  ASSERT_EQ(wait_for(start({"mesh", "surface", "--labels", phantom().string(), "--label", "1", "--nodes", "500",
                            "--out", out.string()},
                           log)),
            0)
      << text(log);
  EXPECT_EQ(fs::file_size(out), 84u + 50u * (2 * 500 - 4));  // Euler: a closed surface of 500 nodes has 996 triangles
  EXPECT_EQ(wait_for(start({"mesh", "surface", "--surface", out.string(), "--out", out.string() + "2.stl"}, log)), 2);
  EXPECT_THAT(text(log), testing::HasSubstr("unit"));
  EXPECT_EQ(
      wait_for(start({"mesh", "surface", "--labels", phantom().string(), "--label", "9", "--out", out.string()}, log)),
      2);
  EXPECT_THAT(text(log), testing::HasSubstr("label 9 does not occur; there are 1, 2"));
}

TEST(RealPelvis, AFloorThatLiesInBoneIsRefused) {
  const std::string source = CARUS_SOURCE_DIR;
  if (!fs::exists(source + "/../shared/data/pelvis_labels_1mm.nii.gz")) GTEST_SKIP() << "the real pelvis is not there";
  const fs::path log = fresh("floor.log");
  EXPECT_EQ(wait_for(start({"check", source + "/scenarios/real_pelvis.yaml", "--set", "resolution=coarse", "--set",
                            "abdomen.perineal_body_thickness=24 mm"},
                           log)),
            2);
  EXPECT_THAT(text(log), testing::HasSubstr("abdomen: pelvic floor and bone at rest lie 10.3 mm deep in each other at "
                                            "(5, 3, -93) mm; at most 6 mm can give way; lower "
                                            "abdomen.perineal_body_thickness or abdomen.levator_thickness"));
}

TEST(RealPelvis, LandmarksBesideTheVolumeAreRefused) {
  const std::string scenario = std::string(CARUS_SOURCE_DIR) + "/scenarios/real_pelvis.yaml";
  const fs::path log = fresh("landmarks.log");
  EXPECT_EQ(wait_for(start({"check", scenario, "--set", "pelvis.from=" + phantom().string(), "--set",
                            "pelvis.landmarks=[{name: coccyx_tip, right: 2 mm, anterior: -31 mm, superior: 314 mm}]"},
                           log)),
            2);
  EXPECT_THAT(text(log), testing::HasSubstr("pelvis.landmarks[0]: coccyx_tip at R 2, A -31, S 314 mm lies outside " +
                                            phantom().string() +
                                            ", which reaches from -25, -25, -25 to 45, 25, 26 mm; are its coordinates "
                                            "RAS, not LPS?"));
}

TEST(RealPelvis, IsRefusedWithoutItsFileAndCheckedWithIt) {
  const std::string scenario = std::string(CARUS_SOURCE_DIR) + "/scenarios/real_pelvis.yaml";
  const fs::path log = fresh("real.log");
  EXPECT_EQ(wait_for(start({"check", scenario, "--set", "pelvis.from=/nowhere.nii"}, log)), 2);
  EXPECT_THAT(text(log), testing::HasSubstr("does not come with Carus"));
  if (!fs::exists(std::string(CARUS_SOURCE_DIR) + "/../shared/data/pelvis_labels_1mm.nii.gz"))
    GTEST_SKIP() << "../shared/data is not there: the real pelvis is not tested";
  EXPECT_EQ(wait_for(start({"check", scenario, "--set", "resolution=coarse"}, log)), 0) << text(log);
}

}  // namespace
