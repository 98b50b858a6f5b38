// SPDX-License-Identifier: Apache-2.0
#include "carus/fem/nodal_pressure.hpp"

#include <algorithm>
#include <map>

#include "carus/core/parallel.hpp"
#include "carus/material/volumetric.hpp"

namespace carus::fem {

NodalPressure::NodalPressure(const Model& model, std::vector<Block>& blocks) {
  std::map<std::pair<std::int32_t, std::int32_t>, std::vector<Share>> where;  // (region, node)
  std::map<std::pair<std::int32_t, std::int32_t>, double> rest;
  for (std::size_t b = 0; b < blocks.size(); ++b) {
    Block& block = blocks[b];
    block.pressure_begin.assign(block.runs.size(), -1);
    for (std::size_t r = 0; r < block.runs.size(); ++r) {
      const auto& run = block.runs[r];
      if (!model.regions[run.region].material.average_nodal_pressure) continue;
      block.pressure_begin[r] = std::int32_t(block.pressure.size());
      block.pressure.resize(block.pressure.size() + block.nodes.size(), 0.f);
      std::vector<std::uint8_t> used(block.nodes.size(), 0);
      for (std::size_t q = run.begin; q < run.end; ++q) {
        const Batch& batch = block.batches[q];
        for (int l = 0; l < lanes; ++l) {
          for (int a = 0; a < 4; ++a) {
            const auto local = batch.node[a][l];
            used[std::size_t(local)] = 1;
            rest[{run.region, block.nodes[std::size_t(local)]}] += 0.25 * double(batch.volume[l]);
          }
        }
      }
      for (std::size_t n = 0; n < used.size(); ++n) {
        if (used[n])
          where[{run.region, block.nodes[n]}].push_back({std::int32_t(b), block.pressure_begin[r] + std::int32_t(n)});
      }
    }
    block.volume.resize(block.pressure.size());
  }
  for (const auto& [key, shares] : where) {
    const auto first = std::int32_t(shares_.size());
    shares_.insert(shares_.end(), shares.begin(), shares.end());
    nodes_.push_back({float(model.regions[key.first].material.bulk_modulus()), float(rest.at(key)), first,
                      std::int32_t(shares_.size())});
  }
  strain_.resize(nodes_.size());
}

void NodalPressure::add_volumes(Block& b) const {
  std::fill(b.volume.begin(), b.volume.end(), 0.f);
  for (std::size_t r = 0; r < b.runs.size(); ++r) {
    if (b.pressure_begin[r] < 0) continue;
    kernel().volumes(b.batches.data() + b.runs[r].begin, b.runs[r].end - b.runs[r].begin, b.x.data(),
                     b.volume.data() + b.pressure_begin[r]);
  }
}

void NodalPressure::update(std::vector<Block>& blocks) const {
  parallel::for_chunks(nodes_.size(), 1024, [&](std::size_t begin, std::size_t end, std::size_t) {
    for (std::size_t a = begin; a < end; ++a) {
      const Node& n = nodes_[a];
      float volume = 0;
      for (auto s = n.first; s < n.last; ++s)
        volume += blocks[std::size_t(shares_[s].block)].volume[std::size_t(shares_[s].slot)];
      strain_[a] = volume / n.rest_volume - 1;
      const float pressure = material::FiniteVolume<float>::volume_pressure(n.bulk, strain_[a]);
      for (auto s = n.first; s < n.last; ++s) {
        blocks[std::size_t(shares_[s].block)].pressure[std::size_t(shares_[s].slot)] = pressure;
      }
    }
  });
}

double NodalPressure::energy() const {
  double sum = 0;
  for (std::size_t a = 0; a < nodes_.size(); ++a) {
    const double density = material::FiniteVolume<double>::volume_energy(double(nodes_[a].bulk), double(strain_[a]));
    sum += double(nodes_[a].rest_volume) * density;
  }
  return sum;
}

}  // namespace carus::fem
