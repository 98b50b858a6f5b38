// SPDX-License-Identifier: Apache-2.0
#include "carus/observe/penetration.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>

#include "carus/core/parallel.hpp"
#include "carus/mesh/closest_point.hpp"
#include "carus/observe/box_grid.hpp"

namespace carus::observe {
namespace {

constexpr double touching = 1e-9;       // [m] less is no penetration
constexpr double crease = 0.643;        // cos 50°
constexpr double most_sagitta = 0.001;  // [m] more is an edge, not a curved surface
constexpr double as_near = 2e-5;        // [m] from outside: to the nearest facet and to another of its edge

bool has(const auto& simplex, std::int32_t node) {
  return std::find(simplex.begin(), simplex.end(), node) != simplex.end();
}

/// All four sub-volumes of (p, tet) have the tet's sign. A point on a face counts, so that none slips between two tets.
bool inside(const Vec3& p, const std::vector<Vec3>& x, const mesh::Tet& t) {
  const auto volume = [](const Vec3& a, const Vec3& b, const Vec3& c, const Vec3& d) {
    return (b - a).cross(c - a).dot(d - a);
  };
  const Vec3 &a = x[t[0]], &b = x[t[1]], &c = x[t[2]], &d = x[t[3]];
  const double whole = volume(a, b, c, d), sign = whole < 0 ? -1 : 1, least = -1e-12 * std::abs(whole);
  return sign * volume(p, b, c, d) >= least && sign * volume(a, p, c, d) >= least &&
         sign * volume(a, b, p, d) >= least && sign * volume(a, b, c, p) >= least;
}

template <class Simplices>
std::vector<Box> boxes_of(const std::vector<Vec3>& x, const Simplices& simplices) {
  std::vector<Box> boxes(simplices.size());
  for (std::size_t i = 0; i < simplices.size(); ++i) {
    for (const auto n : simplices[i]) boxes[i].extend(x[n]);
  }
  return boxes;
}

double mean_diagonal(const std::vector<Box>& boxes) {
  double sum = 0;
  for (const auto& b : boxes) sum += b.diagonal().norm();
  return boxes.empty() ? 1.0 : std::max(sum / double(boxes.size()), 1e-9);
}

/// Twice the area along the outward normal [m^2].
Vec3 area_of(const std::vector<Vec3>& x, const mesh::Triangle& t) {
  return (x[t[1]] - x[t[0]]).cross(x[t[2]] - x[t[0]]);
}

/// For every facet and corner, the facets that share the corner and are joined to this one there by edges of less than
/// 50° at rest.
std::vector<std::array<std::vector<std::int32_t>, 3>> facets_round(const std::vector<Vec3>& rest,
                                                                   const mesh::Triangles& triangles) {
  std::vector<std::vector<std::int32_t>> of_node(rest.size());
  std::vector<Vec3> normal;
  for (std::size_t f = 0; f < triangles.size(); ++f) {
    for (const auto n : triangles[f]) of_node[n].push_back(std::int32_t(f));
    normal.push_back(area_of(rest, triangles[f]).normalized());
  }
  std::vector<std::array<std::vector<std::int32_t>, 3>> round(triangles.size());
  for (std::size_t f = 0; f < triangles.size(); ++f) {
    for (std::size_t k = 0; k < 3; ++k) {
      const auto& all = of_node[std::size_t(triangles[f][k])];
      auto& fan = round[f][k];
      fan.push_back(std::int32_t(f));
      for (std::size_t i = 0; i < fan.size(); ++i) {
        for (const auto g : all) {
          const auto& t = triangles[std::size_t(fan[i])];
          const auto shared = std::count_if(t.begin(), t.end(), [&](auto n) { return has(triangles[g], n); });
          if (shared == 2 && normal[g].dot(normal[fan[i]]) > crease && std::count(fan.begin(), fan.end(), g) == 0)
            fan.push_back(g);
        }
      }
    }
  }
  return round;
}

}  // namespace

PenetrationCheck::PenetrationCheck(const fem::Model& model, double search) : search_(search) {
  std::vector<std::size_t> body_of_node(model.mesh.nodes.size(), 0), body_of_region;
  for (const auto& region : model.regions) {
    const auto it = std::find_if(bodies_.begin(), bodies_.end(), [&](const Body& b) { return b.name == region.organ; });
    body_of_region.push_back(std::size_t(it - bodies_.begin()));
    if (it == bodies_.end()) bodies_.push_back({region.organ, {}, {}, {}});
  }
  for (std::size_t e = 0; e < model.mesh.tets.size(); ++e) {
    const auto body = body_of_region[model.mesh.labels[e]];
    bodies_[body].tets.push_back(model.mesh.tets[e]);
    for (const auto n : model.mesh.tets[e]) body_of_node[n] = body;
  }
  for (std::size_t b = 0; b < bodies_.size(); ++b) {
    bodies_[b].boundary = mesh::boundary(model.mesh, [&](std::int32_t label) { return body_of_region[label] == b; });
    bodies_[b].round = facets_round(model.mesh.nodes, bodies_[b].boundary);
  }
  const auto add = [&](std::size_t result, std::size_t onto, const mesh::Triangles& from, bool self) {
    auto it = std::find_if(passes_.begin(), passes_.end(),
                           [&](const Pass& p) { return p.result == result && p.onto == onto; });
    if (it == passes_.end()) it = passes_.insert(passes_.end(), {onto, result, {}, self});
    const auto nodes = mesh::nodes_of(from);
    it->nodes.insert(it->nodes.end(), nodes.begin(), nodes.end());
  };
  for (const auto& pair : model.contact_pairs) {
    const auto &ta = model.contact_surfaces[pair.a].triangles, &tb = model.contact_surfaces[pair.b].triangles;
    if (ta.empty() || tb.empty()) continue;
    const auto a = body_of_node[ta.front()[0]], b = body_of_node[tb.front()[0]];
    const auto key = std::minmax(a, b);
    const auto it = std::find(joined_.begin(), joined_.end(), std::pair<std::size_t, std::size_t>(key));
    const auto result = std::size_t(it - joined_.begin());
    if (it == joined_.end()) joined_.emplace_back(key);
    add(result, b, ta, a == b);
    add(result, a, tb, a == b);
  }
  for (auto& pass : passes_) {
    std::sort(pass.nodes.begin(), pass.nodes.end());
    pass.nodes.erase(std::unique(pass.nodes.begin(), pass.nodes.end()), pass.nodes.end());
  }
}

PenetrationCheck::Patch PenetrationCheck::patch(const std::vector<Vec3>& x, const Body& body, std::int32_t facet,
                                                const Vec3& w) {
  const auto& t = body.boundary[facet];
  const Vec3 foot = w[0] * x[t[0]] + w[1] * x[t[1]] + w[2] * x[t[2]];
  Patch p{0, Vec3::Zero()};
  for (int k = 0; k < 3; ++k) {
    Vec3 normal = Vec3::Zero();
    for (const auto f : body.round[facet][k]) normal += area_of(x, body.boundary[f]);
    normal.normalize();
    p.sagitta += 0.5 * w[k] * (x[t[k]] - foot).dot(normal);  // positive where the surface is convex
    p.normal += w[k] * normal;
  }
  p.normal.normalize();
  p.sagitta = std::clamp(p.sagitta, -most_sagitta, most_sagitta);
  return p;
}

/// A body's boxes where it is now, in grids.
struct PenetrationCheck::Search {
  std::vector<Box> facet_boxes, tet_boxes;
  BoxGrid facet_grid, tet_grid;
  Search(const std::vector<Vec3>& x, const Body& body)
      : facet_boxes(boxes_of(x, body.boundary)),
        tet_boxes(boxes_of(x, body.tets)),
        facet_grid(facet_boxes, mean_diagonal(facet_boxes)),
        tet_grid(tet_boxes, mean_diagonal(tet_boxes)) {}
};

void PenetrationCheck::run(const std::vector<Vec3>& x, const Search& onto, const Pass& pass, Penetration& out) const {
  const Body& body = bodies_[pass.onto];
  const auto& triangles = body.boundary;
  const auto& tets = body.tets;
  constexpr double far = std::numeric_limits<double>::infinity();

  struct Near {
    double distance;
    std::int32_t facet;
    Vec3 weights, to_foot;
  };
  // What lies inside is as deep as the nearest patch says that it lies behind; at a sharp edge that need not be the
  // nearest facet's.
  const auto depth = [&](const Near& n) {
    const Patch p = patch(x, body, n.facet, n.weights);
    if (n.to_foot.dot(p.normal) <= 0) return far;
    const Vec3 to_patch = n.to_foot + p.sagitta * p.normal;
    const double across = to_patch.dot(p.normal), beside = (to_patch - across * p.normal).norm();
    return across > 0 ? std::hypot(across, beside) : std::max(0.0, across + beside);
  };
  // Distance to the nearest facet within r, or infinity, and to the surface that the facets stand for.
  const auto nearest = [&](std::int32_t node, double r, bool in) {
    const double beyond = in ? 2 * most_sagitta : as_near;
    double least = far;
    std::vector<Near> near;
    const Vec3& p = x[node];
    onto.facet_grid.visit(Box(p.array() - r, p.array() + r), [&](std::int32_t f) {
      const auto& t = triangles[f];
      const double limit = std::min(r, least + beyond), near2 = limit * limit;
      if (onto.facet_boxes[f].squaredExteriorDistance(p) > near2) return;
      const Vec3 area = area_of(x, t);  // the plane is nearer than the facet: most are ruled out by it
      const double along = area.dot(p - x[t[0]]);
      if (along * along > near2 * area.squaredNorm() || has(t, node)) return;
      const Vec3 w = mesh::closest_point_weights(p, x[t[0]], x[t[1]], x[t[2]]);
      const Vec3 to_foot = w[0] * x[t[0]] + w[1] * x[t[1]] + w[2] * x[t[2]] - p;
      const double d = to_foot.norm();
      if (d > limit) return;
      near.push_back({d, f, w, to_foot});
      least = std::min(least, d);
    });
    Gap found{least, far};
    for (const Near& n : near) {
      if (n.distance > least + beyond) continue;
      found.smooth = std::min(found.smooth, in ? depth(n) : n.distance - patch(x, body, n.facet, n.weights).sagitta);
    }
    if (in && found.smooth == far) found.smooth = least;
    return found;
  };
  const auto gap = [&](std::int32_t node) -> Gap {
    const Vec3& p = x[node];
    bool in = false;
    onto.tet_grid.visit(Box(p, p), [&](std::int32_t e) {
      in = in || (onto.tet_boxes[e].contains(p) && !has(tets[e], node) && inside(p, x, tets[e]));
    });
    if (!in && pass.self) return {search_, search_};
    Gap found = nearest(node, search_, in);
    if (!in && found.flat == far) return {search_, search_};
    if (!in) return {found.flat, std::min(search_, found.smooth)};
    for (double r = 4 * search_; found.flat == far; r *= 4) found = nearest(node, r, in);
    return {-found.flat, -found.smooth};
  };

  std::vector<Gap> gaps(pass.nodes.size());
  parallel::for_chunks(gaps.size(), 256, [&](std::size_t begin, std::size_t end, std::size_t) {
    for (std::size_t i = begin; i < end; ++i) gaps[i] = gap(pass.nodes[i]);
  });
  for (std::size_t i = 0; i < gaps.size(); ++i) {
    out.penetrated += gaps[i].flat < -touching;
    out.least_gap = std::min(out.least_gap, gaps[i].flat);
    if (gaps[i].smooth < out.least_smooth_gap) {
      out.least_smooth_gap = gaps[i].smooth;
      out.node = pass.nodes[i];
    }
  }
}

std::vector<Penetration> PenetrationCheck::check(const std::vector<Vec3>& x) const {
  std::vector<Penetration> result;
  for (const auto& [a, b] : joined_) result.push_back({bodies_[a].name, bodies_[b].name, search_, search_, -1, 0});
  for (std::size_t b = 0; b < bodies_.size(); ++b) {
    std::optional<Search> search;
    for (const auto& pass : passes_) {
      if (pass.onto != b) continue;
      if (!search) search.emplace(x, bodies_[b]);
      run(x, *search, pass, result[pass.result]);
    }
  }
  return result;
}

}  // namespace carus::observe
