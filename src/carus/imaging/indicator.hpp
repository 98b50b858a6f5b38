// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "carus/imaging/label_volume.hpp"

namespace carus::imaging {

/// 1 in every labelled voxel and 0 elsewhere, smoothed by a Gaussian of that standard deviation [voxels] along each
/// index.
std::vector<float> smoothed_indicator(const LabelVolume& v, double smoothing);

/// The level at which the smoothed organ keeps its volume, where one half would take from whatever is convex or thin:
/// of eight points spread over each voxel, as many pass it as lie in labelled voxels. v: as in smoothed_indicator, with
/// two empty voxels on every side.
double level_of_volume(const std::vector<float>& values, const LabelVolume& v);

}  // namespace carus::imaging
