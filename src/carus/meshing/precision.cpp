// SPDX-License-Identifier: Apache-2.0
#include "carus/meshing/precision.hpp"

#include <algorithm>
#include <cmath>

#include "carus/core/error.hpp"
#include "carus/meshing/simplify.hpp"

namespace carus::meshing {

Precision precision(const Distances& original, std::vector<double> reductions, std::size_t samples) {
  std::sort(reductions.begin(), reductions.end());
  const auto& s = original.surface();
  std::vector<std::size_t> counts;
  for (const double r : reductions) {
    CARUS_ASSERT(r >= 0 && r < 1);
    counts.push_back(static_cast<std::size_t>(std::ceil((1 - r) * static_cast<double>(s.nodes.size()))));
  }
  Precision p;
  p.surfaces = simplify(s, counts);
  for (std::size_t i = 0; i < reductions.size(); ++i)
    p.rows.push_back({reductions[i], p.surfaces[i].nodes.size(), compare(original, p.surfaces[i], samples)});
  return p;
}

Thickness iliac_wing_thickness(const Distances& innominate) {
  const auto box = mesh::box(innominate.surface());
  const double height = box.sizes().z(), from = box.max().z() - 0.4 * height;
  auto t = thicknesses(innominate, [=](const Vec3& x) { return x.z() > from; });
  std::erase_if(t, [=](double d) { return d > 0.25 * height; });
  if (t.empty()) throw InputError("iliac wing: nothing in the upper two fifths of this organ has two sides");
  return {t[t.size() / 2], t.size()};
}

Thickness thin_part_thickness(const Distances& organ) {
  const auto t = thicknesses(organ, [](const Vec3&) { return true; });
  if (t.empty()) throw InputError("thickness: no place of this organ has two sides");
  return {t[t.size() / 4], t.size() / 2};
}

}  // namespace carus::meshing
