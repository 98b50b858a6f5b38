// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "carus/meshing/deviation.hpp"

namespace carus::meshing {

/// What an organ keeps of its shape when so much of its nodes is taken away: the paper's section 3.2.
struct PrecisionRow {
  double reduction = 0;   ///< part of the nodes wanted away, 0 to 1
  std::size_t nodes = 0;  ///< left
  Deviation deviation;
  /// The paper's alpha: 100 (d_organ - d_mean) / d_organ [%].
  [[nodiscard]] double alpha(double d_organ) const { return 100 * (d_organ - deviation.mean()) / d_organ; }
};
struct Precision {
  std::vector<PrecisionRow> rows;       ///< one per reduction, in rising order
  std::vector<mesh::Surface> surfaces;  ///< the simplified ones
};

/// Simplifies once, to the highest of the reductions, and measures the states on the way. 1.75 million nodes and ten
/// reductions: docs/theory/geometry.md has the time.
Precision precision(const Distances& original, std::vector<double> reductions, std::size_t samples = 100000);

/// A length that stands for an organ in alpha, measured on it.
struct Thickness {
  double median = 0;        ///< [m]
  std::size_t samples = 0;  ///< that it is the median of
};
/// Of a bone's iliac wing: thickness where the innominate bone is a plate: median over the upper two fifths of its
/// height (z), where the bone is no thicker than a quarter of that height (the crest's and the joint's ends aside).
Thickness iliac_wing_thickness(const Distances& innominate);
/// Of an organ's thin parts: the median over its thinner half, that is, the lower quartile of its local thickness.
Thickness thin_part_thickness(const Distances& organ);

}  // namespace carus::meshing
