// SPDX-License-Identifier: Apache-2.0
#include "carus/contact/potential.hpp"

#include <algorithm>
#include <map>

#include "carus/contact/ccd.hpp"
#include "carus/core/parallel.hpp"

namespace carus::contact {

namespace {

constexpr std::size_t candidate_chunk = 4096, triangle_chunk = 256;
constexpr double slack =
    2e-3;  // [m] beyond the barrier that a search looks, at least: it then serves several iterations
// Point-triangle pairs are met from both sides, and surfaces that lie on each other have about 1.5 times as many
// crossing edges as points: with these shares a flat contact feels about one to one and a half times the barrier's
// pressure.
constexpr double point_share = 0.5, edge_share = 0.25;

bool share_node(const std::array<std::int32_t, 4>& n, int split) {
  for (int i = 0; i < split; ++i)
    for (int j = split; j < 4; ++j)
      if (n[i] == n[j]) return true;
  return false;
}

double greatest_move(const std::vector<Vec3>& a, const std::vector<Vec3>& b) {
  double most = 0;
  for (std::size_t i = 0; i < a.size(); ++i) most = std::max(most, (a[i] - b[i]).squaredNorm());
  return std::sqrt(most);
}

}  // namespace

BarrierPotential::BarrierPotential(std::vector<Side> sides, std::vector<Touching> pairs, const std::vector<Vec3>& rest,
                                   std::vector<std::uint8_t> moves, Barrier barrier)
    : sides_(std::move(sides)), pairs_(std::move(pairs)), rest_(rest), moves_(std::move(moves)), barrier_(barrier) {
  for (const Side& side : sides_) {
    Own own;
    std::map<std::int32_t, double> area;
    std::map<std::pair<std::int32_t, std::int32_t>, double> edge_area;
    const auto edge = [](const mesh::Triangle& t, int k) { return std::minmax(t[k], t[(k + 1) % 3]); };
    for (const auto& t : side.triangles) {
      const double a = 0.5 * (rest[t[1]] - rest[t[0]]).cross(rest[t[2]] - rest[t[0]]).norm();
      for (int k = 0; k < 3; ++k) area[t[k]] += a / 3, edge_area[edge(t, k)] += a / 3;
    }
    std::map<std::int32_t, bool> taken;
    std::map<std::pair<std::int32_t, std::int32_t>, bool> edge_taken;
    for (const auto& t : side.triangles) {
      auto& v = own.vertex.emplace_back();
      auto& e = own.edge.emplace_back();
      auto& va = own.vertex_area.emplace_back();
      auto& ea = own.edge_area.emplace_back();
      for (int k = 0; k < 3; ++k) {
        v[k] = !std::exchange(taken[t[k]], true), va[k] = area[t[k]];
        e[k] = !std::exchange(edge_taken[edge(t, k)], true), ea[k] = edge_area[edge(t, k)];
      }
    }
    own_.push_back(std::move(own));
    trees_.emplace_back(side.triangles, rest);
  }
}

// ---- candidates ----

/// Pairs of primitives whose boxes, on their way from x to y, come within `reach`, each once: a triangle brings in the
/// nodes and edges that it owns.
void BarrierPotential::search_pair(int pair, const std::vector<Vec3>& x, const std::vector<Vec3>& y, double reach,
                                   std::vector<Stencil>& all) {
  const int a = pairs_[pair].a, b = pairs_[pair].b;
  const bool self = a == b;
  const auto &A = sides_[a].triangles, &B = sides_[b].triangles;
  const Own &own_a = own_[a], &own_b = own_[b];
  const auto box_of = [&](std::initializer_list<std::int32_t> nodes) {
    TriangleTree::Box box;
    for (const auto n : nodes) box.extend(x[n]).extend(y[n]);
    return box;
  };
  const auto grown = [&](TriangleTree::Box box) {
    box.min().array() -= reach, box.max().array() += reach;
    return box;
  };
  const auto movable = [&](const std::array<std::int32_t, 4>& n) {
    return moves_[n[0]] || moves_[n[1]] || moves_[n[2]] || moves_[n[3]];
  };
  found_.resize((A.size() + triangle_chunk - 1) / triangle_chunk);
  parallel::for_chunks(A.size(), triangle_chunk, [&](std::size_t begin, std::size_t end, std::size_t chunk) {
    auto& out = found_[chunk];
    out.clear();
    const auto points = [&](const mesh::Triangle& of, const Own& own, std::size_t i, const mesh::Triangle& t,
                            const TriangleTree::Box& box) {
      for (int k = 0; k < 3; ++k) {
        if (!own.vertex[i][k] || !grown(box).intersects(box_of({of[k]}))) continue;
        const Stencil s{{of[k], t[0], t[1], t[2]}, false, std::int16_t(pair), point_share * own.vertex_area[i][k], 0};
        if (movable(s.nodes) && !share_node(s.nodes, 1)) out.push_back(s);
      }
    };
    for (std::size_t i = begin; i < end; ++i) {
      const TriangleTree::Box around = grown(trees_[a].box(i));
      trees_[b].for_each(around, [&](std::int32_t j) {
        if (self && j <= std::int32_t(i)) return;
        points(A[i], own_a, i, B[j], trees_[b].box(j));
        points(B[j], own_b, j, A[i], trees_[a].box(i));
        for (int k = 0; k < 3; ++k) {
          if (!own_a.edge[i][k]) continue;
          const auto e0 = A[i][k], e1 = A[i][(k + 1) % 3];
          const auto first = grown(box_of({e0, e1}));
          for (int l = 0; l < 3; ++l) {
            if (!own_b.edge[j][l]) continue;
            const auto f0 = B[j][l], f1 = B[j][(l + 1) % 3];
            if (!first.intersects(box_of({f0, f1}))) continue;
            const double u2 = (rest_[e1] - rest_[e0]).squaredNorm(), v2 = (rest_[f1] - rest_[f0]).squaredNorm();
            const Stencil s{{e0, e1, f0, f1},
                            true,
                            std::int16_t(pair),
                            edge_share * 0.5 * (own_a.edge_area[i][k] + own_b.edge_area[j][l]),
                            1e-3 * u2 * v2};
            if (movable(s.nodes) && !share_node(s.nodes, 2)) out.push_back(s);
          }
        }
      });
    }
  });
  for (const auto& f : found_) all.insert(all.end(), f.begin(), f.end());
}

void BarrierPotential::collect(const std::vector<Vec3>& x, const std::vector<Vec3>& y, double reach,
                               std::vector<Stencil>& out) {
  ++searches_;
  out.clear();
  for (std::size_t s = 0; s < sides_.size(); ++s) trees_[s].refit(sides_[s].triangles, x, y);
  for (int p = 0; p < int(pairs_.size()); ++p) search_pair(p, x, y, reach, out);
}

void BarrierPotential::search(const std::vector<Vec3>& x, double extra) {
  searched_at_ = x;
  searched_reach_ = barrier_.reach + extra;
  collect(x, x, searched_reach_, candidates_);
}

/// Makes sure that every pair within `distance` of x is among the candidates: two nodes have come nearer to each other
/// by at most twice what any has moved.
void BarrierPotential::ready(const std::vector<Vec3>& x, double distance) {
  if (searched_reach_ >= 0 && searched_reach_ - 2 * greatest_move(x, searched_at_) >= distance) return;
  search(x, std::max(slack, 1.2 * (distance - barrier_.reach)));
}

// ---- energy ----

template <class F>
void BarrierPotential::for_active(const std::vector<Vec3>& x, F&& f) {
  ready(x, barrier_.reach);
  const double reach2 = barrier_.reach * barrier_.reach;
  parallel::for_chunks(candidates_.size(), candidate_chunk, [&](std::size_t begin, std::size_t end, std::size_t chunk) {
    for (std::size_t k = begin; k < end; ++k) {
      const Stencil& s = candidates_[k];
      const Corners p = corners(s, x);
      const Coefficients c = s.edges ? nearest_edge_edge(p) : nearest_point_triangle(p);
      const Vec3 r = between(c, p);
      if (r.squaredNorm() < reach2) f(s, p, c, r, chunk);
    }
  });
}

double BarrierPotential::energy(const std::vector<Vec3>& x) {
  if (!any()) return 0;
  ready(x, barrier_.reach);
  std::vector<double> part((candidates_.size() + candidate_chunk - 1) / candidate_chunk, 0.0);
  for_active(x, [&](const Stencil& s, const Corners& p, const Coefficients&, const Vec3& r, std::size_t chunk) {
    const double d = r.norm();
    double b = d > 0 ? barrier_.value(d) : std::numeric_limits<double>::infinity();
    if (s.edges) b *= Mollifier{s.threshold}.value((p[1] - p[0]).cross(p[3] - p[2]).squaredNorm());
    part[chunk] += s.weight * b;
  });
  double sum = 0;
  for (const double e : part) sum += e;
  return sum;
}

void BarrierPotential::add_gradient(const std::vector<Vec3>& x, std::vector<Vec3>& g) {
  if (!any()) return;
  ready(x, barrier_.reach);
  struct Force {
    std::array<std::int32_t, 4> nodes;
    Corners f;
  };
  std::vector<std::vector<Force>> chunks((candidates_.size() + candidate_chunk - 1) / candidate_chunk);
  for_active(x, [&](const Stencil& s, const Corners& p, const Coefficients& c, const Vec3& r, std::size_t chunk) {
    const double d = r.norm();
    double slope = s.weight * barrier_.first(d);
    Force force{s.nodes, {Vec3::Zero(), Vec3::Zero(), Vec3::Zero(), Vec3::Zero()}};
    if (s.edges) {
      // d(m b) = m b' dd + b m' d|u x v|^2.
      const Mollifier m{s.threshold};
      const Vec3 u = p[1] - p[0], v = p[3] - p[2];
      const double cross2 = u.cross(v).squaredNorm();
      const double fade = 2 * s.weight * barrier_.value(d) * m.first(cross2);
      slope *= m.value(cross2);
      const Vec3 du = fade * (v.squaredNorm() * u - u.dot(v) * v), dv = fade * (u.squaredNorm() * v - u.dot(v) * u);
      force.f = {-du, du, -dv, dv};
    }
    for (int k = 0; k < 4; ++k) force.f[k] += slope * c[k] / d * r;
    chunks[chunk].push_back(force);
  });
  for (const auto& chunk : chunks)
    for (const Force& force : chunk)
      for (int k = 0; k < 4; ++k) g[force.nodes[k]] += force.f[k];
}

void BarrierPotential::linearise(const std::vector<Vec3>& x) {
  linear_.clear();
  if (!any()) return;
  ready(x, barrier_.reach);
  chunk_linear_.assign((candidates_.size() + candidate_chunk - 1) / candidate_chunk, {});
  for_active(x, [&](const Stencil& s, const Corners& p, const Coefficients& c, const Vec3& r, std::size_t chunk) {
    const double d = r.norm();
    double k = s.weight * barrier_.second(d);
    if (s.edges) k *= Mollifier{s.threshold}.value((p[1] - p[0]).cross(p[3] - p[2]).squaredNorm());
    chunk_linear_[chunk].push_back({s.nodes, c, r / d, k});
  });
  for (const auto& chunk : chunk_linear_) linear_.insert(linear_.end(), chunk.begin(), chunk.end());
  for (Sliding& s : sliding_) {
    const Vec3 t = slip(s, x) - slip(s, step_start_);
    s.k = s.force * friction_.first_over_slip(t.norm());
  }
}

void BarrierPotential::add_product(const std::vector<Vec3>& u, std::vector<Vec3>& y) const {
  for (const Linear& s : linear_) {
    const Vec3 v = s.c[0] * u[s.nodes[0]] + s.c[1] * u[s.nodes[1]] + s.c[2] * u[s.nodes[2]] + s.c[3] * u[s.nodes[3]];
    const Vec3 f = s.k * s.n.dot(v) * s.n;
    for (int k = 0; k < 4; ++k) y[s.nodes[k]] += s.c[k] * f;
  }
  for (const Sliding& s : sliding_) {
    const Vec3 f = s.k * slip(s, u);
    for (int k = 0; k < 4; ++k) y[s.nodes[k]] += s.c[k] * f;
  }
}

void BarrierPotential::add_diagonal(std::vector<Mat3>& d) const {
  for (const Linear& s : linear_) {
    const Mat3 nn = s.k * s.n * s.n.transpose();
    for (int k = 0; k < 4; ++k) d[s.nodes[k]] += s.c[k] * s.c[k] * nn;
  }
  for (const Sliding& s : sliding_) {
    const Mat3 tt = s.k * (Mat3::Identity() - s.n * s.n.transpose());
    for (int k = 0; k < 4; ++k) d[s.nodes[k]] += s.c[k] * s.c[k] * tt;
  }
}

// ---- friction ----

Vec3 BarrierPotential::slip(const Sliding& s, const std::vector<Vec3>& u) const {
  const Vec3 v = s.c[0] * u[s.nodes[0]] + s.c[1] * u[s.nodes[1]] + s.c[2] * u[s.nodes[2]] + s.c[3] * u[s.nodes[3]];
  return v - s.n.dot(v) * s.n;
}

void BarrierPotential::begin_step(const std::vector<Vec3>& x0, double full_slip) {
  sliding_.clear();
  friction_.full = full_slip;
  if (std::none_of(pairs_.begin(), pairs_.end(), [](const Touching& p) { return p.friction > 0; })) return;
  step_start_ = x0;
  ready(x0, barrier_.reach);
  std::vector<std::vector<Sliding>> chunks((candidates_.size() + candidate_chunk - 1) / candidate_chunk);
  for_active(x0, [&](const Stencil& s, const Corners& p, const Coefficients& c, const Vec3& r, std::size_t chunk) {
    const double mu = pairs_[s.pair].friction;
    if (mu <= 0) return;
    const double d = r.norm();
    double force = -s.weight * barrier_.first(d);
    if (s.edges) force *= Mollifier{s.threshold}.value((p[1] - p[0]).cross(p[3] - p[2]).squaredNorm());
    chunks[chunk].push_back({s.nodes, c, r / d, mu * force});
  });
  for (const auto& chunk : chunks) sliding_.insert(sliding_.end(), chunk.begin(), chunk.end());
}

double BarrierPotential::friction_energy(const std::vector<Vec3>& x) const {
  double sum = 0;
  for (const Sliding& s : sliding_) sum += s.force * friction_.value((slip(s, x) - slip(s, step_start_)).norm());
  return sum;
}

void BarrierPotential::add_friction_gradient(const std::vector<Vec3>& x, std::vector<Vec3>& g) const {
  for (const Sliding& s : sliding_) {
    const Vec3 t = slip(s, x) - slip(s, step_start_);
    const Vec3 f = s.force * friction_.first_over_slip(t.norm()) * t;
    for (int k = 0; k < 4; ++k) g[s.nodes[k]] += s.c[k] * f;
  }
}

// ---- continuous collision detection ----

double BarrierPotential::conservative_step(const std::vector<Vec3>& x, const std::vector<Vec3>& p) {
  if (!any()) return 1;
  double longest = 0;
  for (const Vec3& v : p) longest = std::max(longest, v.squaredNorm());
  longest = std::sqrt(longest);
  constexpr double furthest = 0.01;  // [m] that any node may go in one correction: bounds the search
  const double most = longest > furthest ? furthest / longest : 1;
  // What is near serves short ways; long ones are looked at as a whole.
  const std::vector<Stencil>* list = &candidates_;
  if (2 * most * longest <= barrier_.reach + slack) {
    ready(x, std::max(barrier_.reach, 2 * most * longest));
  } else {
    std::vector<Vec3> y = x;
    for (std::size_t i = 0; i < y.size(); ++i) y[i] += most * p[i];
    collect(x, y, 1e-9, swept_);
    list = &swept_;
  }
  std::vector<double> part((list->size() + candidate_chunk - 1) / candidate_chunk, most);
  parallel::for_chunks(list->size(), candidate_chunk, [&](std::size_t begin, std::size_t end, std::size_t chunk) {
    for (std::size_t k = begin; k < end; ++k) {
      const Stencil& s = (*list)[k];
      part[chunk] =
          std::min(part[chunk], contact::conservative_step(corners(s, x), corners(s, p), s.edges, part[chunk]));
    }
  });
  double step = most;
  for (const double t : part) step = std::min(step, t);
  return step;
}

std::vector<BarrierPotential::Nearest> BarrierPotential::nearest(const std::vector<Vec3>& x, double reach) {
  std::vector<Nearest> out(pairs_.size());
  for (int p = 0; p < int(pairs_.size()); ++p) out[p].pair = p;
  ready(x, std::max(reach, barrier_.reach));
  for (const Stencil& s : candidates_) {
    const Corners at = corners(s, x);
    const double d = between(s.edges ? nearest_edge_edge(at) : nearest_point_triangle(at), at).norm();
    Nearest& n = out[s.pair];
    if (d < n.distance && d < reach) n.distance = d, n.nodes = s.nodes, n.edges = s.edges;
  }
  return out;
}

}  // namespace carus::contact
