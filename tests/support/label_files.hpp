// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>
#include <string>

#include "carus/imaging/label_volume.hpp"

/// Label volumes and the files that other programs would write of them.
namespace carus::test {

/// Voxels whose centres `label` names.
imaging::LabelVolume voxelise(const std::array<int, 3>& size, const Mat3& axes, const Vec3& origin,
                              const std::function<std::int32_t(const Vec3&)>& label);

/// Bytes of files with 8-bit labels. NIfTI with sform, qform or both (axes must be orthogonal for the latter).
enum class Form { s, q, both };
std::string nifti_bytes(const imaging::LabelVolume& v, Form form);
std::string nrrd_bytes(const imaging::LabelVolume& v);       ///< in LPS, raw
std::string metaimage_bytes(const imaging::LabelVolume& v);  ///< in LPS, raw

}  // namespace carus::test
