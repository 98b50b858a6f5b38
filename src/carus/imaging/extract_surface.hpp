// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include "carus/imaging/label_volume.hpp"
#include "carus/mesh/surface.hpp"

namespace carus::imaging {

struct ExtractOptions {
  double smoothing = 0.8;     ///< standard deviation of the Gaussian that takes the steps away [voxels], 0.3 to 3
  double spacing = 0;         ///< of the grid that the surface is drawn on [m]; 0: the smallest of the voxels' spacings
  bool largest_part = false;  ///< drop all but the largest connected part
};

struct Extracted {
  mesh::Surface surface;
  double labelled_volume = 0;      ///< of the voxels [m^3]
  double volume = 0;               ///< within the surface [m^3]
  std::vector<std::string> notes;  ///< what was repaired or left out
};

/// The smooth closed surface round one label: the level set of its smoothed indicator function whose enclosed volume is
/// the labelled one, within 0.2 %. The smoothing alone would take volume from whatever is convex or thin. Throws
/// InputError if the label does not occur, NumericalFailure where the organ is too thin for its voxels to keep its
/// volume within 1 %. `name` begins messages. Seconds for 10^7 voxels.
Extracted extract_surface(const LabelVolume& volume, std::int32_t label, const ExtractOptions& options,
                          const std::string& name);

}  // namespace carus::imaging
