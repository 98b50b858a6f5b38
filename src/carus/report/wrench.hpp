// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "carus/core/types.hpp"
#include "carus/report/frame_file.hpp"

namespace carus::report {

struct Wrench {
  Vec3 force = Vec3::Zero();   ///< [N]
  Vec3 moment = Vec3::Zero();  ///< [N m] about the head's centre
};

/// The head in a run's frames: the nodes of the skull, and those of the fetus' surface that are nearer to it than to
/// neck and body, at rest.
class Head {
 public:
  /// Throws InputError, naming `file`, if the mesh has no region "skull".
  Head(const FrameMesh& mesh, const std::string& file);

  [[nodiscard]] Vec3 rest_centre() const { return rest_centre_; }  ///< [m] mean of the skull's nodes
  [[nodiscard]] Vec3 centre(const FrameState& state) const;        ///< [m]
  /// What the mother's tissues do to the head by contact; the neck's pull is not in it.
  [[nodiscard]] Wrench contact(const FrameState& state) const;

 private:
  std::vector<std::int32_t> skull_, skin_;
  Vec3 rest_centre_;
};

}  // namespace carus::report
