// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "carus/fem/model.hpp"

namespace carus::fem {

/// Where a motion puts the rest position X at time t [m].
inline Vec3 placed(const Motion& motion, const Vec3& X, double t) {
  Vec3 x = X;
  if (motion.angle) x = motion.point + Eigen::AngleAxisd(motion.angle(t), motion.axis) * (X - motion.point);
  if (motion.displacement) x += motion.displacement(t);
  return x;
}

/// Blocked bits per node of all that does not move freely: blocked axes and those of the motions.
std::vector<std::uint8_t> constrained_axes(const Model& model);

/// Mass of the deformable elements of some regions (empty: all), a quarter of each element's to each of its nodes [kg].
std::vector<double> lumped_mass(const Model& model, const std::vector<std::int32_t>& regions);

/// Adds the body forces at time t to f [N]; `mass` has one lumped_mass per body force.
void add_body_forces(const Model& model, const std::vector<std::vector<double>>& mass, double t, std::vector<Vec3>& f);

}  // namespace carus::fem
