// SPDX-License-Identifier: Apache-2.0
// The real pelvis of ../shared/data by its labels and by its surfaces; skipped where it is absent.
#include "carus/scenario/real_pelvis.hpp"

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <filesystem>

#include "carus/core/error.hpp"
#include "carus/core/units.hpp"

namespace carus::scenario {
namespace {

const std::filesystem::path data = std::filesystem::path(CARUS_SOURCE_DIR) / "../shared/data";

anatomy::BoneSource surfaces(const std::string& unit = "mm") {
  anatomy::BoneSource s;
  const auto file = [](const char* bone) { return (data / (std::string(bone) + "_mm.stl")).string(); };
  s.surfaces = {file("innominate_R"), file("innominate_L"), file("sacrum"), file("coccyx"), unit, "LSA"};
  return s;
}

std::string refusal(const anatomy::BoneSource& source) {
  try {
    static_cast<void>(read_real_pelvis(source));
  } catch (const InputError& e) {
    return e.what();
  }
  return "accepted";
}

TEST(RealPelvis, SurfacesAndLabelsOfTheSameBonesGiveTheSameLandmarks) {
  if (!std::filesystem::exists(data)) GTEST_SKIP() << data << " is not there";
  anatomy::BoneSource labels;
  labels.file = (data / "pelvis_labels_1mm.nii.gz").string();
  const auto a = read_real_pelvis(labels), b = read_real_pelvis(surfaces());
  // The surfaces are the labels' smoothed and decimated; what a landmark is the extreme of is blunt by a few mm.
  for (const auto& [name, x] : a.landmarks.points) EXPECT_LT((x - b.landmarks.points.at(name)).norm(), 0.004) << name;
  for (const auto& [name, value] : a.landmarks.measures) {
    const bool angle = name.find("angle") != std::string::npos;
    EXPECT_NEAR(value, b.landmarks.measures.at(name), angle ? 5 * units::deg : 0.003) << name;
  }
  int same = 0, all = 0;
  for (double x = -0.1; x < 0.1; x += 0.004)
    for (double y = -0.1; y < 0.1; y += 0.004)
      for (double z = -0.1; z < 0.1; z += 0.004) {
        const auto p = a.bones->label({x, y, z}), q = b.bones->label({x, y, z});
        all += p != 0 || q != 0, same += p != 0 && p == q;
      }
  EXPECT_GT(double(same) / all, 0.85);
}

TEST(RealPelvis, SurfacesAreAllFourAndNoVolumeBeside) {
  anatomy::BoneSource s;
  s.surfaces.right = std::string("/nowhere/right.stl");
  EXPECT_EQ(refusal(s),
            "pelvis.surfaces.innominate_right: /nowhere/right.stl is not there\n"
            "pelvis.surfaces.innominate_left: silent; allowed a file: all four bones or none\n"
            "pelvis.surfaces.sacrum: silent; allowed a file: all four bones or none\n"
            "pelvis.surfaces.coccyx: silent; allowed a file: all four bones or none");
  s.file = std::string("volume.nii");
  EXPECT_EQ(refusal(s), "pelvis.from and pelvis.surfaces: both are given; leave one out");
}

TEST(RealPelvis, SurfacesNeedUnitAndFrame) {
  if (!std::filesystem::exists(data)) GTEST_SKIP() << data << " is not there";
  EXPECT_THAT(refusal(surfaces("inch")), testing::HasSubstr("sacrum_mm.stl: unit \"inch\"; allowed m, cm, mm, um"));
  EXPECT_THAT(refusal(surfaces("m")), testing::HasSubstr("are the surfaces in the unit that is said?"));
}

}  // namespace
}  // namespace carus::scenario
