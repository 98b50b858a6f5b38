// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <string_view>

#include "carus/imaging/label_volume.hpp"

namespace carus::imaging {

enum class Scalar { u8, i8, u16, i16, u32, i32, u64, i64, f32, f64 };
std::size_t bytes_of(Scalar s);

/// Number of voxels of a header's sizes. Throws InputError, beginning with `name`, unless each is 1 to 4096 and
/// together they are at most 2^28.
std::size_t voxel_count(const std::array<std::int64_t, 3>& size, const std::string& name);

/// The labels in raw data. Throws InputError if there is too little of it or a value is no label: not whole, below 0
/// or above 65535 (then it is an image, not its segmentation).
std::vector<std::int32_t> labels_from(std::string_view data, Scalar type, bool swap, std::size_t count,
                                      const std::string& name);

/// Throws InputError unless the axes span a volume and the spacings are between 1 um and 100 mm.
void check_geometry(const LabelVolume& v, const std::string& name);

}  // namespace carus::imaging
