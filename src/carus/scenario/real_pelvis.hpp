// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "carus/anatomy/bony_landmarks.hpp"
#include "carus/scenario/scenario.hpp"

namespace carus::scenario {

/// The pelvis of a label volume: landmarks, measures and its bones as a solid in the pelvis' own frame.
struct RealPelvis {
  anatomy::BonyLandmarks landmarks;
  std::shared_ptr<const anatomy::GivenBones> bones;
};

/// Reads and measures it; below the hinge the sacrum counts as coccyx, as in the generated pelvis. Throws InputError
/// if the file or a label is not there, or a landmark cannot be found. About two seconds for 14 million voxels.
RealPelvis read_real_pelvis(const anatomy::BoneSource& source);

/// Where pelvis.from names a file: its bones go into the scenario's anatomy, their measures into `pelvis`, the canal
/// is laid through them. Throws InputError, with reasons, for measures that no pelvis has.
void take_real_pelvis(Scenario& s);

}  // namespace carus::scenario
