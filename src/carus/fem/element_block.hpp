// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "carus/fem/model.hpp"
#include "carus/material/prony.hpp"

namespace carus::fem {

inline constexpr int lanes = 16;
inline constexpr int max_prony_terms = 4;

/// x, y, z and padding: what the kernel gathers and scatters. 16 bytes, one load.
struct alignas(16) Float4 {
  float v[4];
};

/// Sixteen elements of one region, structure of arrays. Unused lanes repeat the last element with zero volume.
struct alignas(64) Batch {
  std::int32_t node[4][lanes];  ///< block-local node indices
  float B[9][lanes];            ///< inverse of the (stress-free) rest edge matrix, row-major: F = Ds B
  float volume[lanes];          ///< rest volume [m^3]
  float fibre[3][lanes];        ///< rest fibre direction, zero where there is none
  std::int32_t element[lanes];  ///< element in the model
};

/// Second Piola-Kirchhoff stresses of one batch [Pa]: xx, yy, zz, yz, xz, xy.
struct alignas(64) BatchStress {
  float row[6][lanes];
};
/// The past of a batch that relaxes, one BatchStress after the other: what relaxation has taken from the instantaneous
/// stress (all that the forces read), the isochoric stress at the last update, and the branches' stresses.
inline constexpr int relaxed_stress = 0, last_stress = 1, first_branch = 2;

/// Constants of one region as the kernel wants them.
struct KernelMaterial {
  material::Law law;
  float c10, c01, bulk, mu, k1, k2;
  int prony_terms = 0;
  material::PronyFactors prony[max_prony_terms] = {};  ///< over the time since the last update
  bool fibres = false;
};

/// What a pass over batches found: for the guard against inversion.
struct KernelReport {
  float min_J = 1;
  std::int32_t worst_element = -1;
  std::int32_t inverted = 0;
};

/// Adds the nodal forces -dW/dx of `n` batches to f. `pressure` (per local pressure node, or null) replaces dU/dJ by
/// its nodal average. `history`: first_branch + prony_terms entries per batch that relaxes. No allocation; thread-safe
/// over distinct f.
using ElementForces = KernelReport (*)(const Batch* batches, std::size_t n, const KernelMaterial& m, const Float4* x,
                                       Float4* f, const float* pressure, const BatchStress* history);
/// Lets the Maxwell branches follow the stress at x. Between two updates what relaxation has taken, D, stands; so the
/// forces are those of the potential W - D:E, which this changes. Returns by how much it rises [J].
using ElementRelaxation = double (*)(const Batch* batches, std::size_t n, const KernelMaterial& m, const Float4* x,
                                     BatchStress* history);
/// Adds the current volume of each element, a quarter to each node.
using ElementVolumes = void (*)(const Batch* batches, std::size_t n, const Float4* x, float* current);

struct Kernel {
  ElementForces forces;
  ElementRelaxation relax;
  ElementVolumes volumes;
  const char* name;  ///< instruction set
};
/// The fastest kernel that this processor runs; CARUS_ISA=portable|avx2|avx512 in the environment overrides.
const Kernel& kernel();

/// A spatially compact share of the elements with its own copy of its nodes. Blocks are fixed by the model alone, so
/// results do not depend on the number of threads.
struct Block {
  struct Run {
    std::int32_t region;
    std::size_t begin, end;  ///< batches
  };
  std::vector<std::int32_t> nodes;  ///< global indices of the local nodes
  std::vector<Batch> batches;
  std::vector<Run> runs;
  std::vector<BatchStress> history;
  std::vector<std::size_t> history_begin;  ///< per run
  std::vector<Float4> x, f;
  std::vector<std::int32_t> pressure_begin;  ///< per run: first slot of its nodes in `pressure`, -1 where not averaged
  std::vector<float> volume, pressure;  ///< average nodal pressure and what it is made from, see nodal_pressure.hpp
};

/// Splits the elements that carry stress into `count` blocks by recursive bisection, then into batches of one region.
std::vector<Block> make_blocks(const Model& model, int count);

/// Inverse of the rest edge matrix [X1-X0, X2-X0, X3-X0].
Mat3 inverse_edges(const mesh::TetMesh& mesh, std::size_t tet);

}  // namespace carus::fem
