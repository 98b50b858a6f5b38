// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "carus/fem/element_block.hpp"
#include "carus/solve/explicit.hpp"

/// The standard scenes that bench_elements and `carus bench` both measure.
namespace carus::bench {

/// Cube of 0.1 m, 50,400 tets, neo-Hooke, nothing blocked, no contact: the block of the tests.
fem::Model block(bool average_nodal_pressure);

/// The element kernel by itself on one thread: forces of all elements of a block stretched by 1 %.
class Kernel {
 public:
  explicit Kernel(const fem::Model& model);
  fem::KernelReport forces();  ///< one pass over all elements; what it found in the last block

 private:
  std::vector<fem::Block> blocks_;
  fem::KernelMaterial material_;
};

/// Whole steps on the block, one second of labour in one of pseudo-time.
solve::ExplicitOptions step_options(int threads);

}  // namespace carus::bench
