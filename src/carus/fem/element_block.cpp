// SPDX-License-Identifier: Apache-2.0
#include "carus/fem/element_block.hpp"

#include <Eigen/LU>
#include <algorithm>
#include <numeric>

namespace carus::fem {

Mat3 inverse_edges(const mesh::TetMesh& mesh, std::size_t tet) {
  const auto& t = mesh.tets[tet];
  Mat3 D;
  for (int a = 0; a < 3; ++a) D.col(a) = mesh.nodes[t[a + 1]] - mesh.nodes[t[0]];
  return D.inverse();
}

namespace {

using Elements = std::vector<std::int32_t>;

Vec3 centroid(const mesh::TetMesh& mesh, std::int32_t e) {
  const auto& t = mesh.tets[e];
  return 0.25 * (mesh.nodes[t[0]] + mesh.nodes[t[1]] + mesh.nodes[t[2]] + mesh.nodes[t[3]]);
}

/// Recursive bisection along the longest side of the bounding box.
void bisect(const mesh::TetMesh& mesh, const std::vector<Vec3>& centre, Elements elements, int parts,
            std::vector<Elements>& out) {
  if (parts == 1) {
    out.push_back(std::move(elements));
    return;
  }
  Vec3 lo = Vec3::Constant(1e30), hi = -lo;
  for (const auto e : elements) lo = lo.cwiseMin(centre[e]), hi = hi.cwiseMax(centre[e]);
  int axis = 0;
  (hi - lo).maxCoeff(&axis);
  const auto mid = elements.begin() + std::ptrdiff_t(elements.size()) * (parts / 2) / parts;
  std::nth_element(elements.begin(), mid, elements.end(),
                   [&](auto a, auto b) { return std::pair(centre[a][axis], a) < std::pair(centre[b][axis], b); });
  bisect(mesh, centre, Elements(elements.begin(), mid), parts / 2, out);
  bisect(mesh, centre, Elements(mid, elements.end()), parts - parts / 2, out);
}

void fill_lane(Batch& b, int lane, const Model& model, std::int32_t e, const std::vector<std::int32_t>& local,
               bool padding) {
  const Mat3 B = inverse_edges(model.mesh, std::size_t(e));
  for (int a = 0; a < 4; ++a) b.node[a][lane] = local[model.mesh.tets[e][a]];
  for (int i = 0; i < 3; ++i) {
    for (int j = 0; j < 3; ++j) b.B[3 * i + j][lane] = float(B(i, j));
    b.fibre[i][lane] = model.fibre.empty() ? 0.f : float(model.fibre[e][i]);
  }
  b.volume[lane] = padding ? 0.f : float(mesh::volume(model.mesh, std::size_t(e)));
  b.element[lane] = e;
}

Block make_block(const Model& model, Elements elements, std::vector<std::int32_t>& local) {
  Block block;
  std::sort(elements.begin(), elements.end(),
            [&](auto a, auto b) { return std::pair(model.mesh.labels[a], a) < std::pair(model.mesh.labels[b], b); });
  for (const auto e : elements) {
    for (const auto n : model.mesh.tets[e]) {
      if (local[n] < 0) local[n] = std::int32_t(block.nodes.size()), block.nodes.push_back(n);
    }
  }
  for (std::size_t i = 0; i < elements.size();) {
    const auto region = model.mesh.labels[elements[i]];
    std::size_t end = i;
    while (end < elements.size() && model.mesh.labels[elements[end]] == region) ++end;
    const std::size_t first = block.batches.size();
    for (; i < end; i += lanes) {
      Batch& b = block.batches.emplace_back();
      for (int l = 0; l < lanes; ++l) {
        const bool padding = i + std::size_t(l) >= end;
        fill_lane(b, l, model, elements[padding ? end - 1 : i + std::size_t(l)], local, padding);
      }
    }
    i = end;
    block.runs.push_back({region, first, block.batches.size()});
    block.history_begin.push_back(block.history.size());
    const auto terms = model.regions[region].material.prony.size();
    if (terms > 0) block.history.resize(block.history.size() + (first_branch + terms) * (block.batches.size() - first));
  }
  for (const auto n : block.nodes) local[n] = -1;
  block.x.resize(block.nodes.size());
  block.f.resize(block.nodes.size());
  return block;
}

}  // namespace

std::vector<Block> make_blocks(const Model& model, int count) {
  std::vector<Vec3> centre(model.mesh.tets.size());
  Elements elements;
  for (std::size_t e = 0; e < centre.size(); ++e) {
    centre[e] = centroid(model.mesh, std::int32_t(e));
    if (!model.regions[model.mesh.labels[e]].rigid) elements.push_back(std::int32_t(e));
  }
  std::vector<Elements> parts;
  bisect(model.mesh, centre, std::move(elements), count, parts);
  std::vector<std::int32_t> local(model.mesh.nodes.size(), -1);
  std::vector<Block> blocks;
  for (auto& p : parts) {
    if (!p.empty()) blocks.push_back(make_block(model, std::move(p), local));
  }
  return blocks;
}

}  // namespace carus::fem
