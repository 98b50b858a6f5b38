// SPDX-License-Identifier: Apache-2.0
#include "carus/fem/retraction.hpp"

#include <algorithm>
#include <cmath>

#include "carus/core/parallel.hpp"
#include "carus/fem/element_block.hpp"

namespace carus::fem {

RestLength::RestLength(const Model& model) : model_(&model) {
  const Retraction& r = model.retraction;
  if (r.kind == Retraction::Kind::off || r.elements.empty()) return;
  const auto [lo, hi] = std::minmax_element(r.s.begin(), r.s.end());
  const auto count = std::size_t(std::max(1.0, std::ceil((*hi - *lo) / r.ring_width))) + 1;
  rings_.assign(count, 1.0), stretch_.assign(count, 1.0), ring_volume_.assign(count, 0.0);
  share_.resize(r.elements.size()), volume_.resize(r.elements.size()), element_stretch_.resize(r.elements.size());
  inverse_edges_.resize(r.elements.size());
  for (std::size_t i = 0; i < r.elements.size(); ++i) {
    const double u = (r.s[i] - *lo) / r.ring_width;
    const auto ring = std::min(std::int32_t(u), std::int32_t(count) - 2);
    share_[i] = {ring, 1 - (u - ring)};
    volume_[i] = mesh::volume(model.mesh, std::size_t(r.elements[i]));
    ring_volume_[std::size_t(ring)] += volume_[i] * share_[i].weight;
    ring_volume_[std::size_t(ring) + 1] += volume_[i] * (1 - share_[i].weight);
    inverse_edges_[i] = inverse_edges(model.mesh, std::size_t(r.elements[i]));
  }
}

double RestLength::of(std::size_t i) const {
  const auto ring = std::size_t(share_[i].ring);
  const double length = share_[i].weight * rings_[ring] + (1 - share_[i].weight) * rings_[ring + 1];
  return 1 + model_->retraction.strength[i] * (length - 1);
}

double RestLength::mean() const {
  double sum = 0, volume = 0;
  for (std::size_t k = 0; k < rings_.size(); ++k) sum += ring_volume_[k] * rings_[k], volume += ring_volume_[k];
  return volume > 0 ? sum / volume : 1;
}

/// Mean stretch per ring: |F m| on the tube; on the dome, where the meridian is singular, the root of the stretch of
/// the area.
void RestLength::measure(const std::vector<Vec3>& x) {
  const Retraction& r = model_->retraction;
  parallel::for_chunks(r.elements.size(), 1024, [&](std::size_t b, std::size_t e, std::size_t) {
    for (std::size_t i = b; i < e; ++i) {
      const auto& t = model_->mesh.tets[r.elements[i]];
      Mat3 D;
      for (int a = 0; a < 3; ++a) D.col(a) = x[t[a + 1]] - x[t[0]];
      const Mat3 F = D * inverse_edges_[i];
      const Vec3 m = F * r.meridian[i], h = F * r.normal[i].cross(r.meridian[i]);
      element_stretch_[i] = (1 - r.dome[i]) * m.norm() + r.dome[i] * std::sqrt(m.cross(h).norm());
    }
  });
  std::fill(stretch_.begin(), stretch_.end(), 0.0);
  for (std::size_t i = 0; i < share_.size(); ++i) {
    const auto ring = std::size_t(share_[i].ring);
    stretch_[ring] += volume_[i] * share_[i].weight * element_stretch_[i];
    stretch_[ring + 1] += volume_[i] * (1 - share_[i].weight) * element_stretch_[i];
  }
  for (std::size_t k = 0; k < stretch_.size(); ++k)
    stretch_[k] = ring_volume_[k] > 0 ? stretch_[k] / ring_volume_[k] : 1;
}

void RestLength::advance(const std::vector<Vec3>& x, double t, double dt) {
  const Retraction& r = model_->retraction;
  if (r.kind == Retraction::Kind::imposed) {
    std::fill(rings_.begin(), rings_.end(), r.imposed(t));
    return;
  }
  const double activity = r.activity(t);
  if (activity <= 0) return;
  measure(x);
  const double share = 1 - std::exp(-activity * dt / r.tau);
  for (std::size_t k = 0; k < rings_.size(); ++k) {
    const double held = stretch_[k] * (1 - r.isometric_strain);
    if (held < rings_[k]) rings_[k] = std::max(r.floor, rings_[k] + share * (held - rings_[k]));
  }
}

}  // namespace carus::fem
