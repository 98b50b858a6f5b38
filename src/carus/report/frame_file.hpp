// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include "carus/mesh/tet_mesh.hpp"

namespace carus::report {

/// What a frame says of the mesh; the same in every frame of a run. Nodes are at rest (position less displacement),
/// labels are indices of `regions`.
struct FrameMesh : mesh::TetMesh {
  std::vector<std::int32_t> organ;  ///< per tet, index of `organs`
  std::vector<std::string> regions, organs;
};

/// One frame's numbers.
struct FrameState {
  std::vector<std::array<float, 3>> x;              ///< [m] per node
  std::vector<std::array<float, 3>> contact_force;  ///< [N] per node
  std::vector<float> volume_ratio, stretch;         ///< J and largest principal stretch per tet
};

/// Read a frames/frame_NNNN.vtu. Both throw InputError (file, what is wrong, what to do) for a file that is missing,
/// cut off, damaged, not carus's, or, for the state, of another mesh. Thread-safe for different files.
FrameMesh read_frame_mesh(const std::filesystem::path& file);
FrameState read_frame_state(const std::filesystem::path& file, std::size_t nodes, std::size_t tets);

/// The frames that a frames.pvd names.
struct FrameEntry {
  double time;  ///< [s of labour]
  std::filesystem::path file;
};
/// Throws InputError if the file cannot be read, is no collection, times do not increase, or a name leads out of the
/// folder.
std::vector<FrameEntry> read_frame_index(const std::filesystem::path& pvd);

}  // namespace carus::report
