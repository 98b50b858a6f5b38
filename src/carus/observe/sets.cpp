// SPDX-License-Identifier: Apache-2.0
#include "carus/observe/sets.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <limits>

namespace carus::observe {

std::vector<std::int32_t> tets_of(const fem::Model& model, const std::vector<std::string>& names) {
  std::vector<std::int32_t> tets;
  for (std::size_t e = 0; e < model.mesh.tets.size(); ++e) {
    const auto& region = model.regions[model.mesh.labels[e]].name;
    if (std::find(names.begin(), names.end(), region) != names.end()) tets.push_back(std::int32_t(e));
  }
  return tets;
}

Nodes nodes_of(const fem::Model& model, const std::vector<std::int32_t>& tets) {
  Nodes nodes;
  for (const auto e : tets) nodes.insert(nodes.end(), model.mesh.tets[e].begin(), model.mesh.tets[e].end());
  std::sort(nodes.begin(), nodes.end());
  nodes.erase(std::unique(nodes.begin(), nodes.end()), nodes.end());
  return nodes;
}

Vec3 centroid(const std::vector<Vec3>& x, const Nodes& nodes) {
  Vec3 sum = Vec3::Zero();
  for (const auto n : nodes) sum += x[n];
  return sum / double(std::max<std::size_t>(nodes.size(), 1));
}

double least_height(const std::vector<Vec3>& x, const Nodes& nodes, const Vec3& origin, const Vec3& normal) {
  double least = std::numeric_limits<double>::infinity();
  for (const auto n : nodes) least = std::min(least, (x[n] - origin).dot(normal));
  return least;
}

double most_height(const std::vector<Vec3>& x, const Nodes& nodes, const Vec3& origin, const Vec3& normal) {
  return -least_height(x, nodes, origin, -normal);
}

double extent(const std::vector<Vec3>& x, const Nodes& nodes, const Vec3& direction) {
  return most_height(x, nodes, Vec3::Zero(), direction) - least_height(x, nodes, Vec3::Zero(), direction);
}

Ring::Ring(const std::vector<Vec3>& rest, const Nodes& nodes, const Vec3& axis, int sectors) : sectors_(sectors) {
  const Vec3 centre = centroid(rest, nodes), e1 = axis.unitOrthogonal(), e2 = axis.cross(e1);
  for (const auto n : nodes) {
    const Vec3 r = rest[n] - centre;
    const double turn = 0.5 + std::atan2(r.dot(e2), r.dot(e1)) / (2 * pi);
    sectors_[std::min(sectors - 1, int(turn * sectors))].push_back(n);
  }
  std::erase_if(sectors_, [](const Nodes& s) { return s.empty(); });
}

double Ring::perimeter(const std::vector<Vec3>& x) const {
  double sum = 0;
  Vec3 last = centroid(x, sectors_.back());
  for (const auto& s : sectors_) {
    const Vec3 here = centroid(x, s);
    sum += (here - last).norm();
    last = here;
  }
  return sum;
}

HeadSkin::HeadSkin(const std::vector<Vec3>& rest, const mesh::Triangles& skin, const Nodes& bone, const Nodes& other) {
  const auto nearest = [&](const Vec3& p, const Nodes& nodes) {
    double best = std::numeric_limits<double>::infinity();
    for (const auto n : nodes) best = std::min(best, (rest[n] - p).squaredNorm());
    return best;
  };
  std::vector<signed char> on_head(rest.size(), 0);
  for (const auto n : mesh::nodes_of(skin)) on_head[n] = nearest(rest[n], bone) < nearest(rest[n], other);
  for (const auto& t : skin) {
    if (on_head[t[0]] && on_head[t[1]] && on_head[t[2]]) facets_.push_back(t);
  }
  nodes_ = mesh::nodes_of(facets_);
}

HeadSkin::Load HeadSkin::load(const std::vector<Vec3>& x, const std::vector<Vec3>& force) const {
  if (nodes_.empty() || force.empty()) return {Vec3::Zero(), 0, 0, 0};
  const auto local = [&](std::int32_t n) {
    return std::size_t(std::lower_bound(nodes_.begin(), nodes_.end(), n) - nodes_.begin());
  };
  std::vector<Vec3> area(nodes_.size(), Vec3::Zero());  // outward, a third of each facet
  for (const auto& t : facets_) {
    const Vec3 third = (x[t[1]] - x[t[0]]).cross(x[t[2]] - x[t[0]]) / 6;
    for (const auto n : t) area[local(n)] += third;
  }
  Load load{Vec3::Zero(), 0, 0, 0};
  std::vector<double> pressed(nodes_.size(), 0.0);  // normal force inwards [N]
  double sum_pressed = 0, sum_area = 0;
  for (std::size_t i = 0; i < nodes_.size(); ++i) {
    load.net += force[nodes_[i]], load.force += force[nodes_[i]].norm();
    const double a = area[i].norm();
    if (a > 0) pressed[i] = std::max(0.0, -force[nodes_[i]].dot(area[i]) / a);
    if (pressed[i] > 0) sum_pressed += pressed[i], sum_area += a;
  }
  if (sum_area > 0) load.mean_pressure = sum_pressed / sum_area;
  std::vector<double> patch_force(pressed), patch_area(nodes_.size());
  for (std::size_t i = 0; i < nodes_.size(); ++i) patch_area[i] = area[i].norm();
  for (const auto& t : facets_) {  // neighbours along an edge are met in two facets: half each
    for (int k = 0; k < 3; ++k) {
      const auto i = local(t[k]), j = local(t[(k + 1) % 3]);
      patch_force[i] += 0.5 * pressed[j], patch_force[j] += 0.5 * pressed[i];
      patch_area[i] += 0.5 * area[j].norm(), patch_area[j] += 0.5 * area[i].norm();
    }
  }
  for (std::size_t i = 0; i < nodes_.size(); ++i) {
    if (patch_area[i] > 0) load.max_pressure = std::max(load.max_pressure, patch_force[i] / patch_area[i]);
  }
  return load;
}

}  // namespace carus::observe
