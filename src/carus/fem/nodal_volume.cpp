// SPDX-License-Identifier: Apache-2.0
#include "carus/fem/nodal_volume.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>

#include "carus/core/parallel.hpp"
#include "carus/material/hooke.hpp"
#include "carus/material/volumetric.hpp"

namespace carus::fem {

namespace {

using Finite = material::FiniteVolume<double>;
using Small = material::HookeSmallStrain<double>;
constexpr std::size_t chunk = 1024;

}  // namespace

NodalVolume::NodalVolume(const Model& model, const std::vector<mesh::Tet>& tets,
                         const std::vector<std::int32_t>& regions, const std::vector<double>& volumes)
    : volumes_(volumes), slots_(tets.size(), {-1, -1, -1, -1}) {
  std::map<std::pair<std::int32_t, std::int32_t>, std::vector<std::int32_t>> round;  // (region, node) -> tets
  for (std::size_t e = 0; e < tets.size(); ++e) {
    if (!model.regions[regions[e]].material.average_nodal_pressure) continue;
    for (const auto n : tets[e]) round[{regions[e], n}].push_back(std::int32_t(e));
  }
  for (const auto& [key, list] : round) {
    const auto& material = model.regions[key.first].material;
    Node node{material.bulk_modulus(),
              0,
              material.law != material::Law::hooke_small_strain,
              std::int32_t(entries_.size()),
              0,
              std::int32_t(columns_.size()),
              0};
    std::vector<std::int32_t> row;
    for (const auto e : list) {
      node.rest_volume += 0.25 * volumes[e];
      row.insert(row.end(), tets[e].begin(), tets[e].end());
      for (int a = 0; a < 4; ++a)
        if (tets[e][a] == key.second) slots_[e][a] = std::int32_t(nodes_.size());
    }
    std::sort(row.begin(), row.end());
    row.erase(std::unique(row.begin(), row.end()), row.end());
    for (const auto e : list) {
      Entry entry{e, {}};
      for (int a = 0; a < 4; ++a)
        entry.places[a] =
            node.row_first + std::int32_t(std::lower_bound(row.begin(), row.end(), tets[e][a]) - row.begin());
      entries_.push_back(entry);
    }
    columns_.insert(columns_.end(), row.begin(), row.end());
    node.last = std::int32_t(entries_.size()), node.row_last = std::int32_t(columns_.size());
    nodes_.push_back(node);
  }
  rows_.resize(columns_.size());
  column_begin_.assign(model.mesh.nodes.size() + 1, 0);
  for (const auto n : columns_) ++column_begin_[std::size_t(n) + 1];
  for (std::size_t i = 1; i < column_begin_.size(); ++i) column_begin_[i] += column_begin_[i - 1];
  column_at_.resize(columns_.size());
  auto next = column_begin_;
  for (std::size_t a = 0; a < nodes_.size(); ++a)
    for (auto k = nodes_[a].row_first; k < nodes_[a].row_last; ++k)
      column_at_[std::size_t(next[std::size_t(columns_[k])]++)] = {std::int32_t(a), k};
  strain_.resize(nodes_.size()), pressure_.resize(nodes_.size()), stiffness_.resize(nodes_.size());
  weight_.resize(nodes_.size());
}

double NodalVolume::update(const std::vector<double>& volume_strain) {
  return parallel::sum_chunks(nodes_.size(), chunk, [&](std::size_t begin, std::size_t end) {
    double energy = 0;
    for (std::size_t a = begin; a < end; ++a) {
      const Node& n = nodes_[a];
      double change = 0;
      for (auto k = n.first; k < n.last; ++k) {
        const auto e = std::size_t(entries_[k].tet);
        change += 0.25 * volumes_[e] * volume_strain[e];
      }
      const double e = strain_[a] = change / n.rest_volume;
      if (n.finite && e <= -1) {
        energy = std::numeric_limits<double>::infinity();
        continue;
      }
      pressure_[a] = n.finite ? Finite::volume_pressure(n.bulk, e) : Small::volume_pressure(n.bulk, e);
      stiffness_[a] = n.finite ? Finite::volume_stiffness(n.bulk, e) : Small::volume_stiffness(n.bulk, e);
      energy += n.rest_volume * (n.finite ? Finite::volume_energy(n.bulk, e) : Small::volume_energy(n.bulk, e));
    }
    return energy;
  });
}

double NodalVolume::pressure(std::size_t tet) const {
  const auto& s = slots_[tet];
  return 0.25 * (pressure_[s[0]] + pressure_[s[1]] + pressure_[s[2]] + pressure_[s[3]]);
}

void NodalVolume::linearise(const std::vector<std::array<Vec3, 4>>& volume_gradient) {
  parallel::for_chunks(nodes_.size(), chunk, [&](std::size_t begin, std::size_t end, std::size_t) {
    for (std::size_t a = begin; a < end; ++a) {
      const Node& n = nodes_[a];
      std::fill(rows_.begin() + n.row_first, rows_.begin() + n.row_last, Vec3::Zero());
      for (auto k = n.first; k < n.last; ++k)
        for (int b = 0; b < 4; ++b)
          rows_[entries_[k].places[b]] += 0.25 * volume_gradient[std::size_t(entries_[k].tet)][b];
    }
  });
}

void NodalVolume::add_product(const std::vector<Vec3>& x, std::vector<Vec3>& y) const {
  if (!any()) return;
  parallel::for_chunks(nodes_.size(), chunk, [&](std::size_t begin, std::size_t end, std::size_t) {
    for (std::size_t a = begin; a < end; ++a) {
      double sum = 0;
      for (auto k = nodes_[a].row_first; k < nodes_[a].row_last; ++k) sum += rows_[k].dot(x[columns_[k]]);
      weight_[a] = stiffness_[a] / nodes_[a].rest_volume * sum;
    }
  });
  parallel::for_chunks(y.size(), chunk, [&](std::size_t begin, std::size_t end, std::size_t) {
    for (std::size_t i = begin; i < end; ++i) {
      for (auto k = column_begin_[i]; k < column_begin_[i + 1]; ++k)
        y[i] += weight_[column_at_[k].first] * rows_[column_at_[k].second];
    }
  });
}

void NodalVolume::add_diagonal(std::vector<Mat3>& diagonal) const {
  for (std::size_t i = 0; i < diagonal.size() && any(); ++i) {
    for (auto k = column_begin_[i]; k < column_begin_[i + 1]; ++k) {
      const auto [a, place] = column_at_[k];
      diagonal[i] += stiffness_[a] / nodes_[a].rest_volume * rows_[place] * rows_[place].transpose();
    }
  }
}

}  // namespace carus::fem
