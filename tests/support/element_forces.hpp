// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "carus/fem/element_block.hpp"

/// Element forces outside a solver: gather, kernel, scatter.
namespace carus::models {

/// Laws that tests run over, with a name for messages.
struct LawCase {
  material::Law law;
  const char* name;
  bool objective;  ///< rigid rotation costs nothing
};
inline constexpr LawCase laws[] = {{material::Law::neo_hooke, "neo_hooke", true},
                                   {material::Law::mooney_rivlin, "mooney_rivlin", true},
                                   {material::Law::hooke_corotated, "hooke_corotated", true},
                                   {material::Law::hooke_small_strain, "hooke_small_strain", false}};

struct Forces {
  std::vector<Vec3> at;  ///< per node [N]
  fem::KernelReport report;
};

/// Forces at the positions x, with the past that the blocks have. No nodal averages.
Forces element_forces(const fem::Model& model, std::vector<fem::Block>& blocks, const std::vector<Vec3>& x,
                      const fem::Kernel& kernel = fem::kernel());

/// The branches follow the stress at x, `dt` [s] after the last time. Returns what the kernel does [J].
double relax(const fem::Model& model, std::vector<fem::Block>& blocks, const std::vector<Vec3>& x, double dt,
             const fem::Kernel& kernel = fem::kernel());

}  // namespace carus::models
