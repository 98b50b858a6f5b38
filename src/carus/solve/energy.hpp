// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "carus/fem/element_block.hpp"
#include "carus/fem/model.hpp"

namespace carus::solve {

/// What the element kernel needs of a region, but the factors of relaxation.
fem::KernelMaterial kernel_material(const fem::Region& region);
/// Those, for an update `dt` seconds of labour after the last.
void set_relaxation(fem::KernelMaterial& kernel, const fem::Region& region, double dt);

/// F_a^-1 of the i-th retracting element at the given rest length.
Mat3 inverse_active_strain(const fem::Retraction& retraction, std::size_t i, double rest_length);

/// Stored elastic energy of one lane of a batch at the positions x, in double precision [J].
double element_energy(const fem::Model& model, const fem::Batch& batch, int lane, const std::vector<Vec3>& x);

/// What relaxation has taken of one lane's stress, over its strain: D:E V [J]; 0 where nothing relaxes.
double element_relaxed(const fem::Model& model, const fem::Block& block, std::size_t batch, int lane,
                       const std::vector<Vec3>& x);
/// Of all elements [J].
double relaxed_energy(const fem::Model& model, const std::vector<fem::Block>& blocks, const std::vector<Vec3>& x);

/// Energy in the tethers [J].
double tether_energy(const fem::Model& model, const fem::State& state);

/// Stored elastic energy of all elements, by their instantaneous stiffness, of tethers and hinges [J].
double stored_energy(const fem::Model& model, const std::vector<fem::Block>& blocks, const fem::State& state);

}  // namespace carus::solve
