// SPDX-License-Identifier: Apache-2.0
// Label volumes: every format puts the same voxel at the same place in the body, whatever its axes; files that lie are
// refused.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <fstream>
#include <random>

#include "carus/core/error.hpp"
#include "carus/imaging/extract_surface.hpp"
#include "carus/imaging/read_labels.hpp"
#include "carus/imaging/smooth_labels.hpp"
#include "support/label_files.hpp"

namespace carus {
namespace {

using imaging::LabelVolume;
using test::Form;

/// Steps of 1, 2 and 3 mm along turned axes, left-handed if asked.
Mat3 oblique(bool left_handed) {
  const Mat3 turn = (Eigen::AngleAxisd(0.3, Vec3::UnitZ()) * Eigen::AngleAxisd(-0.5, Vec3::UnitX())).toRotationMatrix();
  return turn * Vec3(0.001, 0.002, left_handed ? -0.003 : 0.003).asDiagonal();
}

/// A few voxels, no two sides of it alike.
LabelVolume corner(bool left_handed = false) {
  auto v = test::voxelise({5, 4, 3}, oblique(left_handed), {0.010, -0.020, 0.030}, [](const Vec3&) { return 0; });
  v.labels[v.index(1, 0, 0)] = 1, v.labels[v.index(4, 3, 1)] = 2, v.labels[v.index(0, 3, 2)] = 7;
  return v;
}

void expect_same(const LabelVolume& a, const LabelVolume& b) {
  EXPECT_EQ(a.size, b.size);
  EXPECT_EQ(a.labels, b.labels);
  // NIfTI stores single precision: 1e-7 of 40 mm.
  EXPECT_LT((a.axes - b.axes).norm(), 1e-8);
  EXPECT_LT((a.origin - b.origin).norm(), 1e-8);
}

std::filesystem::path file_with(const std::string& bytes, const std::string& name) {
  const auto file = std::filesystem::path(testing::TempDir()) / name;
  std::ofstream(file, std::ios::binary) << bytes;
  return file;
}

TEST(LabelVolume, EveryFormatKeepsObliqueAnisotropicAxes) {
  for (const bool left_handed : {false, true}) {
    const auto v = corner(left_handed);
    for (const auto form : {Form::s, Form::q, Form::both})
      expect_same(imaging::read_labels(file_with(test::nifti_bytes(v, form), "a.nii")).volume, v);
    expect_same(imaging::read_labels(file_with(test::nrrd_bytes(v), "a.nrrd")).volume, v);
    expect_same(imaging::read_labels(file_with(test::metaimage_bytes(v), "a.mha")).volume, v);
  }
}

TEST(LabelVolume, APointHasItsVoxelsLabel) {
  const auto v = corner();
  EXPECT_EQ(v.label(v.position({4.4, 2.6, 0.6})), 2);
  EXPECT_EQ(v.label(v.position({4.6, 3, 1})), 0);  // beyond the last voxel
  EXPECT_EQ(v.label(v.position({0, 3, 2})), 7);
}

TEST(LabelVolume, WhatCannotBeTrustedIsRefused) {
  const auto refuses = [](const std::string& bytes, const char* name, const char* why) {
    try {
      static_cast<void>(imaging::read_labels(file_with(bytes, name)));
      ADD_FAILURE() << why;
    } catch (const InputError& e) {
      EXPECT_THAT(e.what(), testing::HasSubstr(why));
    }
  };
  const auto v = corner();
  auto bytes = test::nifti_bytes(v, Form::s);
  bytes[254] = 0;
  refuses(bytes, "b.nii", "states no orientation");
  bytes = test::nifti_bytes(v, Form::s);
  refuses(bytes.substr(0, bytes.size() - 1), "b.nii", "is truncated");
  bytes[70] = 16;  // real numbers: 4 bytes each
  refuses(bytes + std::string(3 * 60, '?'), "b.nii", "image, not its segmentation");
  bytes = test::nrrd_bytes(v);
  refuses(bytes.replace(bytes.find("left-posterior"), 14, "scanner-xyz-so"), "b.nrrd", "which side is right");
  bytes = test::metaimage_bytes(v);
  refuses(bytes.replace(bytes.find("DimSize = 5"), 11, "DimSize = 9"), "b.mha", "is truncated");
  EXPECT_THROW(static_cast<void>(imaging::read_labels("/nowhere/a.nii")), InputError);
}

/// Every file of the corpus, with bytes of it changed or its end cut off, is read or refused, and nothing else.
TEST(LabelVolume, DamagedFilesNeverCrashTheirReader) {
  std::mt19937 random(1);
  const auto v = corner();
  const auto read = [](int format, const std::string& bytes) {
    if (format == 0) return imaging::read_nifti(bytes, "fuzz");
    if (format == 1) return imaging::read_nrrd(bytes, testing::TempDir(), "fuzz");
    return imaging::read_metaimage(bytes, testing::TempDir(), "fuzz");
  };
  const std::array<std::string, 3> corpus{test::nifti_bytes(v, Form::both), test::nrrd_bytes(v),
                                          test::metaimage_bytes(v)};
  int read_well = 0, refused = 0;
  for (int format = 0; format < 3; ++format)
    for (int n = 0; n < 2000; ++n) {
      auto bytes = corpus[format];
      if (n % 4 == 0) bytes.resize(random() % bytes.size());
      for (auto k = random() % 6; k > 0 && !bytes.empty(); --k) {
        static constexpr std::array<char, 6> nasty{'\0', '\xff', '\x7f', '9', '-', '\n'};
        bytes[random() % bytes.size()] = n % 2 == 0 ? nasty[random() % nasty.size()] : char(random());
      }
      try {
        static_cast<void>(read(format, bytes));
        ++read_well;
      } catch (const InputError&) {
        ++refused;
      }
    }
  // A voxel's byte may be anything, a header's hardly: both must have come.
  EXPECT_GT(read_well, 500);
  EXPECT_GT(refused, 1500);
}

TEST(ExtractedSurface, KeepsTheVolumeAndPlaceOfAnEllipsoid) {
  const Vec3 centre(0.02, -0.01, 0.03), semi(0.015, 0.020, 0.025);
  const auto inside = [&](const Vec3& x) { return (x - centre).cwiseQuotient(semi).norm() < 1 ? 3 : 0; };
  const double exact = 4.0 / 3.0 * pi * semi.prod();
  for (const auto& axes : {Mat3(0.001 * Mat3::Identity()), oblique(false), oblique(true)}) {
    const Mat3 cell = axes;
    const std::array<int, 3> size{60, 60, 60};
    const auto v = test::voxelise(size, cell, centre - cell * Vec3(30, 30, 30), inside);
    const auto e = imaging::extract_surface(v, 3, {}, "ellipsoid");
    EXPECT_NEAR(e.volume / e.labelled_volume, 1, 0.002);
    EXPECT_NEAR(e.volume / exact, 1, 0.01);  // 10^4 voxels know a volume to less than that
    double most = 0;
    for (const auto& x : e.surface.nodes) {
      const Vec3 q = x - centre;
      const double k = q.cwiseQuotient(semi).norm();
      most = std::max(most, std::abs(k - 1) * q.norm());
    }
    // Half a voxel of 1 x 1 x 1 or 1 x 2 x 3 mm: what a segmentation knows.
    EXPECT_LT(most, 0.5 * v.spacing().maxCoeff());
  }
}

TEST(ExtractedSurface, AThinPlateKeepsItsVolume) {
  // Two voxels thick: half of its smoothed indicator function would take a tenth of it away.
  const auto v = test::voxelise({40, 40, 12}, 0.001 * Mat3::Identity(), Vec3::Zero(), [](const Vec3& x) {
    return x.z() > 0.0045 && x.z() < 0.0065 && x.x() > 0.0045 && x.x() < 0.0345 && x.y() > 0.0045 && x.y() < 0.0345;
  });
  const auto e = imaging::extract_surface(v, 1, {}, "plate");
  EXPECT_NEAR(e.volume / (2 * 30 * 30 * 1e-9), 1, 0.01);
}

TEST(ExtractedSurface, AMissingLabelIsNamedWithThoseThatThereAre) {
  try {
    static_cast<void>(imaging::extract_surface(corner(), 5, {}, "file"));
    ADD_FAILURE();
  } catch (const InputError& e) {
    EXPECT_THAT(e.what(), testing::HasSubstr("label 5 does not occur; there are 1, 2, 7"));
  }
}

TEST(SmoothLabels, TouchingBlocksShareTheirInterfaceAndKeepTheirVolume) {
  const auto v = test::voxelise({40, 30, 30}, 0.001 * Mat3::Identity(), Vec3::Zero(), [](const Vec3& x) {
    if ((x - Vec3(0.02, 0.015, 0.015)).cwiseQuotient(Vec3(0.015, 0.01, 0.01)).cwiseAbs().maxCoeff() > 1) return 0;
    return x.x() < 0.0185 ? 1 : 2;
  });
  const imaging::SmoothLabels s(v, {1, 2}, 0.8, "blocks");
  std::array<double, 3> volume{};
  constexpr double h = 0.00025;
  for (double x = h / 2; x < 0.04; x += h)
    for (double y = h / 2; y < 0.03; y += h)
      for (double z = h / 2; z < 0.03; z += h) volume[s.label({x, y, z})] += h * h * h;
  const auto count = imaging::count_labels(v);
  EXPECT_NEAR(volume[1] / (1e-9 * double(count.at(1))), 1, 0.02);
  EXPECT_NEAR(volume[2] / (1e-9 * double(count.at(2))), 1, 0.02);
  // No groove along the seam: just below both faces there, something is inside.
  EXPECT_NE(s.label({0.0185, 0.0056, 0.015}), 0);
  EXPECT_EQ(s.label({0.0180, 0.015, 0.015}), 1);
  EXPECT_EQ(s.label({0.0190, 0.015, 0.015}), 2);
}

}  // namespace
}  // namespace carus
