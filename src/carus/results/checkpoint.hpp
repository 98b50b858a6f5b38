// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "carus/fem/model.hpp"
#include "carus/scenario/scenario.hpp"

namespace carus::results {

/// What a run needs to go on from, with how much of its files was written by then.
struct Checkpoint {
  fem::State state;
  std::string scenario_hash, mesh_hash, version;
  std::int64_t rows = 0, stops = 0, events = 0;  ///< rows of curves.csv; stops of the schedule; lines of events.jsonl
  std::vector<double> frame_times;               ///< [s of labour]
  std::vector<double> wall;                      ///< [s] meshing, solving, output so far
};

/// HDF5, all numbers in full. Atomic: a kill leaves the checkpoint before.
void write_checkpoint(const std::filesystem::path& file, const Checkpoint& checkpoint);
/// Throws InputError if the file is missing or not a checkpoint.
Checkpoint read_checkpoint(const std::filesystem::path& file);

/// Everything in a scenario that the results depend on (the number of threads is not).
std::string hash_of(const scenario::Scenario& scenario);
std::string hash_of(const mesh::TetMesh& mesh);

/// Throws InputError with both hashes if the checkpoint belongs to another scenario or mesh.
void refuse_foreign(const std::filesystem::path& file, const Checkpoint& checkpoint, const std::string& scenario_hash,
                    const std::string& mesh_hash);

}  // namespace carus::results
