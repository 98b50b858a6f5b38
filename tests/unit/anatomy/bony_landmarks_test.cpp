// SPDX-License-Identifier: Apache-2.0
// Landmarks and pelvimetry from bones alone: what went into a generated pelvis must come out of its voxels, wherever it
// stands; and a real pelvis, if it is at hand, must give its measures.
#include "carus/anatomy/bony_landmarks.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <filesystem>

#include "carus/anatomy/pelvis.hpp"
#include "carus/core/error.hpp"
#include "carus/imaging/extract_surface.hpp"
#include "carus/imaging/read_labels.hpp"
#include "support/label_files.hpp"

namespace carus {
namespace {

/// The generated pelvis leant forward by 20 degrees. A real one leans by 55 to 70, but its sacrum goes back above the
/// promontory; the generated one goes on up, and so would be foremost at its upper edge.
constexpr double lean = -0.35;

anatomy::PelvicBones upright_bones(const anatomy::Pelvis& pelvis, const Eigen::Affine3d& stood) {
  constexpr double h = 0.002;
  const Eigen::Affine3d back = stood.inverse();
  const Vec3 low(-0.13, -0.15, -0.15);
  const auto v = test::voxelise({131, 128, 143}, h * Mat3::Identity(), stood.translation() + low,
                                [&](const Vec3& x) { return pelvis.label(back * x); });
  const auto bone = [&](std::int32_t label) { return imaging::extract_surface(v, label, {}, "pelvis").surface; };
  return {bone(anatomy::innominate_right), bone(anatomy::innominate_left), bone(anatomy::sacrum),
          bone(anatomy::coccyx)};
}

TEST(BonyLandmarks, OfAGeneratedPelvisAreWhereItWasGivenThem) {
  const anatomy::PelvisParameters p;
  const anatomy::Pelvis pelvis(p, {});
  Eigen::Affine3d stood = Eigen::Affine3d::Identity();
  stood.translate(Vec3(0.01, -0.05, 0.2)).rotate(Eigen::AngleAxisd(lean, Vec3::UnitX()));
  const auto found = anatomy::find_landmarks(upright_bones(pelvis, stood));
  const auto given = pelvis.landmarks();
  // Three voxels: the landmarks are nodes, and bones lose their sharp points in voxels of 2 mm. The coccyx ends in an
  // edge of 16 mm, either corner of which is its tip: half of that more, in x.
  for (const auto& [name, tolerance] :
       {std::pair{"promontory", 0.0065}, {"symphysis_top", 0.0065}, {"coccyx_tip", 0.0105}}) {
    const Vec3 off = found.points.at(name) - given.at(name);
    EXPECT_LT(off.norm(), tolerance) << name << " " << 1e3 * off.transpose();
  }
  const auto expect = [&](const char* name, double wanted, double tolerance) {
    EXPECT_NEAR(found.measures.at(name), wanted, tolerance) << name;
  };
  expect("obstetric_conjugate", p.obstetric_conjugate, 0.005);
  expect("transverse_inlet", p.transverse_inlet, 0.006);
  expect("interspinous", p.interspinous, 0.008);
  expect("sagittal_outlet", p.sagittal_outlet, 0.008);
  // The frame is the generated one: it takes the pelvis back to where it came from.
  EXPECT_LT((found.frame.to_ras(Vec3::Zero()) - stood.translation()).norm(), 0.005);
  // Both ends of the conjugate may be 6 mm off its 122 mm: 0.1 rad, times sqrt 2 in this norm.
  EXPECT_LT((found.frame.rotation * stood.linear() - Mat3::Identity()).norm(), 0.14);
}

TEST(BonyLandmarks, ThoseSeenTakeThePlaceOfThoseFound) {
  const anatomy::Pelvis pelvis({}, {});
  Eigen::Affine3d stood = Eigen::Affine3d::Identity();
  stood.translate(Vec3(0.01, -0.05, 0.2)).rotate(Eigen::AngleAxisd(lean, Vec3::UnitX()));
  const auto bones = upright_bones(pelvis, stood);
  const auto found = anatomy::find_landmarks(bones);
  const Vec3 right = found.frame.to_ras(found.points.at("spine_right") + Vec3(-0.004, 0, 0));
  const Vec3 promontory = found.frame.to_ras(found.points.at("promontory") + Vec3(0, -0.003, 0));
  const auto seen = anatomy::find_landmarks(bones, {{"spine_right", right}, {"promontory", promontory}});
  EXPECT_LT((seen.frame.to_ras(seen.points.at("spine_right")) - right).norm(), 1e-12);
  EXPECT_NEAR(seen.measures.at("interspinous"), found.measures.at("interspinous") - 0.004, 1e-4);
  // 3 mm further back along the conjugate: it and the frame follow.
  EXPECT_NEAR(seen.measures.at("obstetric_conjugate"), found.measures.at("obstetric_conjugate") + 0.003, 1e-6);
  EXPECT_NEAR((seen.frame.origin - found.frame.origin).norm(), 0.0015, 1e-6);
  // What was not given is where it was.
  EXPECT_LT(
      (seen.frame.to_ras(seen.points.at("coccyx_tip")) - found.frame.to_ras(found.points.at("coccyx_tip"))).norm(),
      1e-9);
}

TEST(BonyLandmarks, ExchangedSidesAreRefused) {
  const anatomy::Pelvis pelvis({}, {});
  Eigen::Affine3d stood = Eigen::Affine3d::Identity();
  stood.translate(Vec3(0.01, -0.05, 0.2)).rotate(Eigen::AngleAxisd(lean, Vec3::UnitX()));
  auto bones = upright_bones(pelvis, stood);
  std::swap(bones.left, bones.right);
  try {
    static_cast<void>(anatomy::find_landmarks(bones));
    ADD_FAILURE();
  } catch (const InputError& e) {
    EXPECT_THAT(e.what(), testing::HasSubstr("exchanged"));
  }
}

TEST(BonyLandmarks, OfARealPelvis) {
  const std::filesystem::path file = std::string(CARUS_SOURCE_DIR) + "/../shared/data/pelvis_labels_1mm.nii.gz";
  if (!std::filesystem::exists(file)) GTEST_SKIP() << file << " is not there: the real pelvis is not tested";
  const auto v = imaging::read_labels(file).volume;
  EXPECT_EQ(imaging::count_labels(v).at(1), 515046u);
  const auto bone = [&](std::int32_t label) {
    const auto e = imaging::extract_surface(v, label, {.spacing = 0.0015}, "real");
    EXPECT_NEAR(e.volume / e.labelled_volume, 1, 0.01) << "label " << label;
    return e.surface;
  };
  const auto l = anatomy::find_landmarks({bone(2), bone(1), bone(3), bone(4)});
  // Measured by hand on its surfaces by those who prepared it: 117, 142 to 150 and 106 mm, to where they put the ends.
  EXPECT_NEAR(l.measures.at("obstetric_conjugate"), 0.117, 0.006);
  EXPECT_NEAR(l.measures.at("transverse_inlet"), 0.146, 0.008);
  EXPECT_NEAR(l.measures.at("sagittal_outlet"), 0.106, 0.008);
  // Mirror images of each other, nearly.
  for (const char* name : {"spine_", "tuber_"}) {
    const Vec3 r = l.points.at(std::string(name) + "right"), m = l.points.at(std::string(name) + "left");
    EXPECT_LT((r - Vec3(-m.x(), m.y(), m.z())).norm(), 0.010) << name;
  }
}

}  // namespace
}  // namespace carus
