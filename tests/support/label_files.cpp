// SPDX-License-Identifier: Apache-2.0
#include "support/label_files.hpp"

#include <fmt/format.h>

#include <Eigen/Geometry>
#include <cstring>

namespace carus::test {
namespace {

template <class T>
void put(std::string& bytes, std::size_t at, T value) {
  std::memcpy(bytes.data() + at, &value, sizeof(T));
}
std::string voxels(const imaging::LabelVolume& v) { return {v.labels.begin(), v.labels.end()}; }
const Vec3 lps(-1, -1, 1);

}  // namespace

imaging::LabelVolume voxelise(const std::array<int, 3>& size, const Mat3& axes, const Vec3& origin,
                              const std::function<std::int32_t(const Vec3&)>& label) {
  imaging::LabelVolume v;
  v.size = size, v.axes = axes, v.origin = origin;
  v.labels.resize(v.index(0, 0, size[2]));
  for (int k = 0; k < size[2]; ++k)
    for (int j = 0; j < size[1]; ++j)
      for (int i = 0; i < size[0]; ++i)
        v.labels[v.index(i, j, k)] = label(v.position({double(i), double(j), double(k)}));
  return v;
}

std::string nifti_bytes(const imaging::LabelVolume& v, Form form) {
  std::string b(352, '\0');
  put<std::int32_t>(b, 0, 348);
  const std::array<std::int16_t, 8> dim{
      3, std::int16_t(v.size[0]), std::int16_t(v.size[1]), std::int16_t(v.size[2]), 1, 1, 1, 1};
  std::memcpy(b.data() + 40, dim.data(), sizeof(dim));
  put<std::int16_t>(b, 70, 2);
  put<std::int16_t>(b, 72, 8);
  const Vec3 h = 1e3 * v.spacing();
  Mat3 rotation = v.axes * v.spacing().cwiseInverse().asDiagonal();
  const bool left_handed = rotation.determinant() < 0;
  if (left_handed) rotation.col(2) *= -1;
  const Eigen::Quaterniond q(rotation);
  const double sign = q.w() < 0 ? -1 : 1;
  put<float>(b, 76, left_handed ? -1.F : 1.F);
  for (int k = 0; k < 3; ++k) put<float>(b, 80 + 4 * k, float(h[k]));
  put<float>(b, 108, 352.F);
  b[123] = 2;
  put<std::int16_t>(b, 252, form == Form::s ? 0 : 1);
  put<std::int16_t>(b, 254, form == Form::q ? 0 : 1);
  put<float>(b, 256, float(sign * q.x()));
  put<float>(b, 260, float(sign * q.y()));
  put<float>(b, 264, float(sign * q.z()));
  for (int k = 0; k < 3; ++k) {
    put<float>(b, 268 + 4 * k, float(1e3 * v.origin[k]));
    for (int c = 0; c < 3; ++c) put<float>(b, 280 + 16 * k + 4 * c, float(1e3 * v.axes(k, c)));
    put<float>(b, 280 + 16 * k + 12, float(1e3 * v.origin[k]));
  }
  std::memcpy(b.data() + 344, "n+1", 4);
  return b + voxels(v);
}

std::string nrrd_bytes(const imaging::LabelVolume& v) {
  std::string directions;
  for (int k = 0; k < 3; ++k) {
    const Vec3 a = 1e3 * lps.cwiseProduct(v.axes.col(k));
    directions += fmt::format("({},{},{}) ", a.x(), a.y(), a.z());
  }
  const Vec3 o = 1e3 * lps.cwiseProduct(v.origin);
  return fmt::format(
             "NRRD0004\n# made by a test\ntype: unsigned char\ndimension: 3\nspace: left-posterior-superior\nsizes: {} "
             "{} "
             "{}\nspace directions: {}\nkinds: domain domain domain\nspace units: \"mm\" \"mm\" \"mm\"\nencoding: "
             "raw\nspace "
             "origin: ({},{},{})\n\n",
             v.size[0], v.size[1], v.size[2], directions, o.x(), o.y(), o.z()) +
         voxels(v);
}

std::string metaimage_bytes(const imaging::LabelVolume& v) {
  std::string matrix;
  for (int k = 0; k < 3; ++k) {
    const Vec3 a = lps.cwiseProduct(v.axes.col(k)).normalized();
    matrix += fmt::format("{} {} {} ", a.x(), a.y(), a.z());
  }
  const Vec3 o = 1e3 * lps.cwiseProduct(v.origin), h = 1e3 * v.spacing();
  return fmt::format(
             "ObjectType = Image\nNDims = 3\nBinaryData = True\nBinaryDataByteOrderMSB = False\nCompressedData = "
             "False\nTransformMatrix = {}\nOffset = {} {} {}\nCenterOfRotation = 0 0 0\nAnatomicalOrientation = "
             "RAI\nElementSpacing = {} {} {}\nDimSize = {} {} {}\nElementType = MET_UCHAR\nElementDataFile = LOCAL\n",
             matrix, o.x(), o.y(), o.z(), h.x(), h.y(), h.z(), v.size[0], v.size[1], v.size[2]) +
         voxels(v);
}

}  // namespace carus::test
