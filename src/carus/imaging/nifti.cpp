// SPDX-License-Identifier: Apache-2.0
// NIfTI-1: a header of 348 bytes, then voxels (nifti1.h, NIMH 2005). World coordinates are RAS.
#include <fmt/format.h>

#include <cmath>
#include <map>

#include "carus/core/error.hpp"
#include "carus/imaging/bytes.hpp"
#include "carus/imaging/read_labels.hpp"
#include "carus/imaging/voxels.hpp"

namespace carus::imaging {
namespace {

class Header {
 public:
  Header(std::string_view bytes, const std::string& name) : b_(bytes), name_(name) {
    if (bytes.size() < 352)
      throw InputError(fmt::format("{}: is truncated: {} bytes, a NIfTI header has 352", name, bytes.size()));
    const auto size = number_at<std::int32_t>(b_, 0);
    swap_ = size != 348;
    if (number_at<std::int32_t>(b_, 0, swap_) != 348)
      throw InputError(fmt::format("{}: is no NIfTI-1 file (its header's size is {}, not 348)", name, size));
    if (b_.substr(344, 3) != "n+1")
      throw InputError(fmt::format(
          "{}: is no single-file NIfTI-1 (magic \"n+1\"); convert pairs of .hdr and .img, and NIfTI-2, to .nii", name));
  }
  [[nodiscard]] bool swapped() const { return swap_; }
  [[nodiscard]] int i16(std::size_t at) const { return number_at<std::int16_t>(b_, at, swap_); }
  [[nodiscard]] double f32(std::size_t at) const { return static_cast<double>(number_at<float>(b_, at, swap_)); }
  [[nodiscard]] int u8(std::size_t at) const { return static_cast<unsigned char>(b_[at]); }

  [[nodiscard]] std::array<std::int64_t, 3> sizes() const {
    const int dimensions = i16(40);
    std::array<std::int64_t, 3> n{1, 1, 1};
    if (dimensions < 3 || dimensions > 7)
      throw InputError(fmt::format("{}: has {} dimensions; a volume has 3", name_, dimensions));
    for (int k = 1; k <= dimensions; ++k) {
      const int d = i16(40 + 2 * k);
      if (k <= 3)
        n[k - 1] = d;
      else if (d != 1)
        throw InputError(fmt::format("{}: {} volumes in one file; give a file with one", name_, d));
    }
    return n;
  }
  [[nodiscard]] Scalar scalar() const {
    static const std::map<int, Scalar> types{
        {2, Scalar::u8},   {4, Scalar::i16},   {8, Scalar::i32},   {16, Scalar::f32},   {64, Scalar::f64},
        {256, Scalar::i8}, {512, Scalar::u16}, {768, Scalar::u32}, {1024, Scalar::i64}, {1280, Scalar::u64}};
    const auto it = types.find(i16(70));
    if (it == types.end())
      throw InputError(fmt::format("{}: voxels of NIfTI type {}; labels are integers or real numbers", name_, i16(70)));
    const double slope = f32(112), shift = f32(116);
    if ((slope != 0 && slope != 1) || (slope != 0 && shift != 0))
      throw InputError(fmt::format("{}: voxels are scaled ({} x + {}); save labels as they are", name_, slope, shift));
    return it->second;
  }

  /// Step along each index, and origin, in the file's unit.
  [[nodiscard]] Eigen::Matrix<double, 3, 4> sform() const {
    Eigen::Matrix<double, 3, 4> m;
    for (int r = 0; r < 3; ++r)
      for (int c = 0; c < 4; ++c) m(r, c) = f32(280 + 16 * r + 4 * c);
    return m;
  }
  /// The rotation as a quaternion (a, b, c, d) of unit length, a >= 0 left out; pixdim[0] is the handedness.
  [[nodiscard]] Eigen::Matrix<double, 3, 4> qform() const {
    const double b = f32(256), c = f32(260), d = f32(264), a = std::sqrt(std::max(0.0, 1 - b * b - c * c - d * d));
    Eigen::Matrix<double, 3, 4> m;
    m.leftCols<3>() = Eigen::Quaterniond(a, b, c, d).normalized().toRotationMatrix();
    for (int k = 0; k < 3; ++k) m.col(k) *= f32(80 + 4 * k) * (k == 2 && f32(76) < 0 ? -1 : 1);
    m.col(3) = Vec3(f32(268), f32(272), f32(276));
    return m;
  }

 private:
  std::string_view b_;
  const std::string& name_;
  bool swap_ = false;
};

double unit_of(const Header& h, const std::string& name, std::vector<std::string>& notes) {
  switch (h.u8(123) & 7) {
    case 1:
      return 1;
    case 2:
      return 1e-3;
    case 3:
      return 1e-6;
    case 0:
      notes.push_back(fmt::format("{}: states no unit; taken as millimetres", name));
      return 1e-3;
    default:
      throw InputError(fmt::format("{}: unit code {}; allowed 1 (m), 2 (mm), 3 (um)", name, h.u8(123) & 7));
  }
}

}  // namespace

LabelFile read_nifti(std::string_view bytes, const std::string& name) {
  const Header h(bytes, name);
  LabelFile f;
  const auto size = h.sizes();
  const auto count = voxel_count(size, name);
  const auto type = h.scalar();
  const double unit = unit_of(h, name, f.notes);
  const bool s = h.i16(254) > 0, q = h.i16(252) > 0;
  if (!s && !q)
    throw InputError(fmt::format(
        "{}: states no orientation (sform and qform codes are 0): which side is right cannot be told; set one", name));
  const auto m = s ? h.sform() : h.qform();
  if (s && q && !((h.sform() - h.qform()).cwiseAbs().maxCoeff() <= 0.01 * m.leftCols<3>().cwiseAbs().maxCoeff()))
    f.notes.push_back(fmt::format("{}: its sform and qform differ; the sform is used", name));
  auto& v = f.volume;
  for (int k = 0; k < 3; ++k) v.size[k] = static_cast<int>(size[k]);
  v.axes = unit * m.leftCols<3>();
  v.origin = unit * m.col(3);
  check_geometry(v, name);
  const double offset = h.f32(108);
  if (!(offset >= 352 && offset <= static_cast<double>(bytes.size())))
    throw InputError(fmt::format("{}: its voxels begin at byte {}; the file has {}", name, offset, bytes.size()));
  v.labels = labels_from(bytes.substr(static_cast<std::size_t>(offset)), type, h.swapped(), count, name);
  return f;
}

}  // namespace carus::imaging
