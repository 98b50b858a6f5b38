// SPDX-License-Identifier: Apache-2.0
#include "carus/solve/freedom.hpp"

#include "carus/fem/constraints.hpp"

namespace carus::solve {

Freedom::Freedom(const fem::Model& model)
    : model_(model), nodes_(model.mesh.nodes.size()), fixed_(fem::constrained_axes(model)), imposed_(nodes_, 0) {
  std::vector<std::uint8_t> bears(nodes_, 0);
  for (std::size_t e = 0; e < model.mesh.tets.size(); ++e) {
    if (model.regions[model.mesh.labels[e]].rigid) continue;
    for (const auto n : model.mesh.tets[e]) bears[n] = 1;
  }
  for (std::size_t i = 0; i < nodes_; ++i)
    if (!bears[i]) fixed_[i] = fem::all;
  moves_.assign(nodes_, 0);
  for (std::size_t i = 0; i < nodes_; ++i) moves_[i] = fixed_[i] != fem::all;
  const auto passive = [&](std::int32_t n) { fixed_[n] = fem::all, moves_[n] = 1; };
  for (const auto& h : model.hinges)
    for (const auto n : h.nodes) passive(n);
  for (const auto& t : model.ties) passive(t.node);
  for (const auto& m : model.motions)
    for (const auto n : m.nodes) imposed_[n] = std::uint8_t(imposed_[n] | m.axes), moves_[n] = 1;
}

Vec3 Freedom::project(std::size_t i, Vec3 u) const {
  const auto bits = fixed_[i];
  if (bits == fem::none) {
    if (!model_.blocked_direction.empty()) {
      const Vec3& t = model_.blocked_direction[i];
      u -= t.dot(u) * t;
    }
    return u;
  }
  for (int k = 0; k < 3; ++k)
    if ((bits >> k) & 1) u[k] = 0;
  return u;
}

void Freedom::expand(const Unknowns& q, const std::vector<Vec3>& x, std::vector<Vec3>& u) const {
  u.resize(nodes_);
  parallel::for_chunks(nodes_, unknown_chunk, [&](std::size_t begin, std::size_t end, std::size_t) {
    for (std::size_t i = begin; i < end; ++i) u[i] = project(i, q[i]);
  });
  for (std::size_t h = 0; h < model_.hinges.size(); ++h) {
    const auto& hinge = model_.hinges[h];
    for (const auto n : hinge.nodes) u[n] = q[nodes_ + h].x() * hinge.axis.cross(x[n] - hinge.point);
  }
  for (const auto& t : model_.ties)
    u[t.node] = t.weights[0] * u[t.facet[0]] + t.weights[1] * u[t.facet[1]] + t.weights[2] * u[t.facet[2]];
}

void Freedom::reduce(const std::vector<Vec3>& f, const std::vector<Vec3>& x, Unknowns& r) const {
  r.assign(f.begin(), f.end());
  r.resize(unknowns(), Vec3::Zero());
  for (const auto& t : model_.ties)
    for (int k = 0; k < 3; ++k) r[t.facet[k]] += t.weights[k] * f[t.node];
  for (std::size_t h = 0; h < model_.hinges.size(); ++h) {
    const auto& hinge = model_.hinges[h];
    double moment = 0;
    for (const auto n : hinge.nodes) moment += hinge.axis.cross(x[n] - hinge.point).dot(r[n]);
    r[nodes_ + h] = {moment, 0, 0};
  }
  parallel::for_chunks(nodes_, unknown_chunk, [&](std::size_t begin, std::size_t end, std::size_t) {
    for (std::size_t i = begin; i < end; ++i) r[i] = project(i, r[i]);
  });
}

void Freedom::reduce_diagonal(const std::vector<Mat3>& d, const std::vector<Vec3>& x, std::vector<Mat3>& out) const {
  out.assign(d.begin(), d.end());
  out.resize(unknowns(), Mat3::Zero());
  for (const auto& t : model_.ties)
    for (int k = 0; k < 3; ++k) out[t.facet[k]] += t.weights[k] * t.weights[k] * d[t.node];
  for (std::size_t h = 0; h < model_.hinges.size(); ++h) {
    const auto& hinge = model_.hinges[h];
    for (const auto n : hinge.nodes) {
      const Vec3 arm = hinge.axis.cross(x[n] - hinge.point);
      out[nodes_ + h](0, 0) += arm.dot(d[n] * arm);
    }
  }
}

void Freedom::fill_blocked(std::vector<Mat3>& d) const {
  for (std::size_t i = 0; i < nodes_; ++i) {
    Mat3& m = d[i];
    for (int k = 0; k < 3; ++k) {
      if (!((fixed_[i] >> k) & 1)) continue;
      m.row(k).setZero(), m.col(k).setZero();
      m(k, k) = 1;
    }
    if (fixed_[i] != fem::none || model_.blocked_direction.empty()) continue;
    const Vec3& t = model_.blocked_direction[i];
    if (t.isZero()) continue;
    const Mat3 P = Mat3::Identity() - t * t.transpose();
    m = (P * m * P + m.trace() / 3 * t * t.transpose()).eval();
  }
  for (std::size_t h = nodes_; h < d.size(); ++h) d[h](1, 1) = d[h](2, 2) = 1;
}

void Freedom::place(const std::vector<double>& hinge_angle, std::vector<Vec3>& x) const {
  for (std::size_t h = 0; h < model_.hinges.size(); ++h) {
    const auto& hinge = model_.hinges[h];
    const Eigen::AngleAxisd turn(hinge_angle[h], hinge.axis);
    for (const auto n : hinge.nodes) x[n] = hinge.point + turn * (model_.mesh.nodes[n] - hinge.point);
  }
  for (const auto& t : model_.ties)
    x[t.node] = t.weights[0] * x[t.facet[0]] + t.weights[1] * x[t.facet[1]] + t.weights[2] * x[t.facet[2]];
}

}  // namespace carus::solve
