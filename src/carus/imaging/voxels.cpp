// SPDX-License-Identifier: Apache-2.0
#include "carus/imaging/voxels.hpp"

#include <fmt/format.h>

#include <Eigen/LU>
#include <cmath>

#include "carus/core/error.hpp"
#include "carus/imaging/bytes.hpp"

namespace carus::imaging {
namespace {

template <class T>
void convert(std::string_view data, bool swap, std::vector<std::int32_t>& labels, const std::string& name) {
  for (std::size_t i = 0; i < labels.size(); ++i) {
    const auto v = static_cast<double>(number_at<T>(data, i * sizeof(T), swap));
    if (!(v >= 0 && v <= 65535 && v == std::floor(v)))
      throw InputError(fmt::format(
          "{}: voxel {} holds {}; labels are whole numbers from 0 to 65535; this looks like an image, not its "
          "segmentation",
          name, i, v));
    labels[i] = static_cast<std::int32_t>(v);
  }
}

}  // namespace

std::size_t bytes_of(Scalar s) {
  switch (s) {
    case Scalar::u8:
    case Scalar::i8:
      return 1;
    case Scalar::u16:
    case Scalar::i16:
      return 2;
    case Scalar::u32:
    case Scalar::i32:
    case Scalar::f32:
      return 4;
    case Scalar::u64:
    case Scalar::i64:
    case Scalar::f64:
      return 8;
  }
  CARUS_ASSERT(false);
}

std::size_t voxel_count(const std::array<std::int64_t, 3>& size, const std::string& name) {
  std::size_t n = 1;
  for (const auto s : size) {
    if (s < 1 || s > 4096)
      throw InputError(fmt::format("{}: {} x {} x {} voxels; each from 1 to 4096", name, size[0], size[1], size[2]));
    n *= static_cast<std::size_t>(s);
  }
  if (n > (std::size_t(1) << 28))
    throw InputError(fmt::format("{}: {} voxels; at most {}: crop or resample it", name, n, 1 << 28));
  return n;
}

std::vector<std::int32_t> labels_from(std::string_view data, Scalar type, bool swap, std::size_t count,
                                      const std::string& name) {
  if (data.size() / bytes_of(type) < count)
    throw InputError(fmt::format("{}: is truncated: {} bytes of voxels, its header promises {}", name, data.size(),
                                 count * bytes_of(type)));
  std::vector<std::int32_t> labels(count);
  switch (type) {
    case Scalar::u8:
      convert<std::uint8_t>(data, swap, labels, name);
      break;
    case Scalar::i8:
      convert<std::int8_t>(data, swap, labels, name);
      break;
    case Scalar::u16:
      convert<std::uint16_t>(data, swap, labels, name);
      break;
    case Scalar::i16:
      convert<std::int16_t>(data, swap, labels, name);
      break;
    case Scalar::u32:
      convert<std::uint32_t>(data, swap, labels, name);
      break;
    case Scalar::i32:
      convert<std::int32_t>(data, swap, labels, name);
      break;
    case Scalar::u64:
      convert<std::uint64_t>(data, swap, labels, name);
      break;
    case Scalar::i64:
      convert<std::int64_t>(data, swap, labels, name);
      break;
    case Scalar::f32:
      convert<float>(data, swap, labels, name);
      break;
    case Scalar::f64:
      convert<double>(data, swap, labels, name);
      break;
  }
  return labels;
}

void check_geometry(const LabelVolume& v, const std::string& name) {
  const Vec3 h = v.spacing();
  for (int k = 0; k < 3; ++k)
    if (!(h[k] >= 1e-6 && h[k] <= 0.1))
      throw InputError(
          fmt::format("{}: voxels of {:.4g} x {:.4g} x {:.4g} mm; each from 0.001 to 100; is the unit right?", name,
                      1e3 * h[0], 1e3 * h[1], 1e3 * h[2]));
  if (!(v.voxel_volume() > 1e-3 * h.prod()))
    throw InputError(fmt::format("{}: the three axes of its voxels lie in a plane", name));
  if (!(v.origin.cwiseAbs().maxCoeff() < 1e3))
    throw InputError(fmt::format("{}: its origin is at no place within a kilometre", name));
}

}  // namespace carus::imaging
