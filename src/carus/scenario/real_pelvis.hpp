// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "carus/anatomy/bony_landmarks.hpp"
#include "carus/scenario/scenario.hpp"

namespace carus::scenario {

/// A real pelvis: landmarks, measures and its bones as a solid in the pelvis' own frame.
struct RealPelvis {
  anatomy::BonyLandmarks landmarks;
  std::shared_ptr<const anatomy::GivenBones> bones;
};

/// Reads and measures it; below the hinge the sacrum counts as coccyx, as in the generated pelvis. Throws InputError
/// if a file or a label is not there, or a landmark cannot be found. About two seconds for 14 million voxels.
RealPelvis read_real_pelvis(const anatomy::BoneSource& source);

/// Where pelvis.from or pelvis.surfaces names files: their bones go into the scenario's anatomy, their measures into
/// `pelvis`, the canal is laid through them. Throws InputError, with reasons, for measures that no pelvis has.
void take_real_pelvis(Scenario& s);

}  // namespace carus::scenario
