// SPDX-License-Identifier: Apache-2.0
#include "carus/mesh/feature_lines.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <numeric>
#include <unordered_map>

namespace carus::mesh {
namespace {

using Edge = std::pair<std::int32_t, std::int32_t>;  ///< first < second

/// Points, those within a tolerance of an earlier one taken for it.
class Welded {
 public:
  explicit Welded(double tolerance) : tolerance_(tolerance) {}

  std::int32_t add(const Vec3& x) {
    const Cell c = (x / tolerance_).array().floor().cast<std::int64_t>();
    for (int i = -1; i <= 1; ++i)
      for (int j = -1; j <= 1; ++j)
        for (int k = -1; k <= 1; ++k)
          if (const auto it = bins_.find(key(c + Cell(i, j, k))); it != bins_.end())
            for (const auto p : it->second)
              if ((points[p] - x).norm() < tolerance_) return p;
    bins_[key(c)].push_back(static_cast<std::int32_t>(points.size()));
    points.push_back(x);
    return static_cast<std::int32_t>(points.size()) - 1;
  }

  std::vector<Vec3> points;

 private:
  using Cell = Eigen::Array<std::int64_t, 3, 1>;
  /// Cells that share a key only cost time.
  static std::int64_t key(const Cell& c) { return (c[0] * 1000003 + c[1]) * 1000003 + c[2]; }
  double tolerance_;
  std::unordered_map<std::int64_t, std::vector<std::int32_t>> bins_;
};

/// The network of lines while it is put together: edges with the length wanted of what the mesh makes of them.
struct Network {
  Welded nodes;
  std::map<Edge, double> edges;

  void add(std::int32_t a, std::int32_t b, double length) {
    if (a == b) return;
    auto& wanted = edges.try_emplace(std::minmax(a, b), length).first->second;
    wanted = std::min(wanted, length);
  }
};

void add_sharp_edges(Network& network, const Featured& f, double cosine) {
  const auto& s = *f.surface;
  std::map<Edge, std::pair<Vec3, bool>> once;  // normal of the first triangle; whether the edge is a sharp one
  for (const auto& t : s.triangles) {
    const Vec3 n = (s.nodes[t[1]] - s.nodes[t[0]]).cross(s.nodes[t[2]] - s.nodes[t[0]]).normalized();
    for (int k = 0; k < 3; ++k) {
      const auto [it, fresh] = once.try_emplace(std::minmax(t[k], t[(k + 1) % 3]), n, false);
      if (!fresh) it->second.second = n.dot(it->second.first) < cosine;
    }
  }
  for (const auto& [e, found] : once)
    if (found.second) network.add(network.nodes.add(s.nodes[e.first]), network.nodes.add(s.nodes[e.second]), f.edge);
}

/// Where the points of two segments that are nearest to each other lie on them, from 0 to 1; parallel ones have none.
std::pair<double, double> nearest(const Vec3& a, const Vec3& u, const Vec3& b, const Vec3& v) {
  const Vec3 w = a - b;
  const double uu = u.squaredNorm(), uv = u.dot(v), vv = v.squaredNorm(), det = uu * vv - uv * uv;
  if (det < 1e-12 * uu * vv) return {-1, -1};
  return {(uv * v.dot(w) - vv * u.dot(w)) / det, (uu * v.dot(w) - uv * u.dot(w)) / det};
}

/// Cuts edges where another one's end lies on them, and where two cross.
void cut(Network& network, double tolerance) {
  const std::vector<std::pair<Edge, double>> edges(network.edges.begin(), network.edges.end());
  std::vector<std::vector<std::pair<double, std::int32_t>>> cuts(edges.size());  // where on the edge, and by which node
  auto& x = network.nodes.points;
  const auto cut_at = [&](std::size_t e, std::int32_t node) {
    const auto [a, b] = edges[e].first;
    if (node == a || node == b) return;
    const Vec3 u = x[b] - x[a];
    const double t = u.dot(x[node] - x[a]) / u.squaredNorm();
    if (t > 0 && t < 1 && (x[a] + t * u - x[node]).norm() < tolerance) cuts[e].emplace_back(t, node);
  };
  const auto box = [&](std::size_t e) {
    Eigen::AlignedBox3d b(x[edges[e].first.first]);
    b.extend(x[edges[e].first.second]);
    return b;
  };
  std::vector<Eigen::AlignedBox3d> boxes(edges.size());
  std::vector<std::size_t> order(edges.size()), awake;
  for (std::size_t e = 0; e < edges.size(); ++e) boxes[e] = box(e);
  std::iota(order.begin(), order.end(), 0);
  std::sort(order.begin(), order.end(),
            [&](auto a, auto b) { return std::pair(boxes[a].min().x(), a) < std::pair(boxes[b].min().x(), b); });
  for (const auto e : order) {
    std::erase_if(awake, [&](auto o) { return boxes[o].max().x() < boxes[e].min().x() - tolerance; });
    for (const auto o : awake) {
      if (boxes[e].exteriorDistance(boxes[o]) > tolerance) continue;
      const auto [a, b] = edges[e].first;
      const auto [c, d] = edges[o].first;
      for (const auto node : {c, d}) cut_at(e, node);
      for (const auto node : {a, b}) cut_at(o, node);
      const Vec3 u = x[b] - x[a], v = x[d] - x[c];
      const auto [s, t] = nearest(x[a], u, x[c], v);
      const auto within = [&](double q, double length) {
        return q * length > tolerance && (1 - q) * length > tolerance;
      };
      if (!within(s, u.norm()) || !within(t, v.norm())) continue;
      const Vec3 p = x[a] + s * u, q = x[c] + t * v;
      if ((p - q).norm() > tolerance) continue;
      const auto node = network.nodes.add((p + q) / 2);
      cuts[e].emplace_back(s, node), cuts[o].emplace_back(t, node);
    }
    awake.push_back(e);
  }
  network.edges.clear();
  for (std::size_t e = 0; e < edges.size(); ++e) {
    std::sort(cuts[e].begin(), cuts[e].end());
    auto from = edges[e].first.first;
    for (const auto& [t, node] : cuts[e]) network.add(from, node, edges[e].second), from = node;
    network.add(from, edges[e].first.second, edges[e].second);
  }
}

/// Lines from corner to corner: nodes where not exactly two edges meet, or where the two turn by more than `angle`;
/// then what is left, rings without a corner.
std::vector<FeatureLine> lines_of(const Network& network, double angle) {
  const auto& x = network.nodes.points;
  std::vector<std::vector<std::int32_t>> beside(x.size());
  for (const auto& [e, length] : network.edges)
    beside[e.first].push_back(e.second), beside[e.second].push_back(e.first);
  const auto corner = [&](std::int32_t i) {
    if (beside[i].size() != 2) return true;
    const Vec3 in = x[i] - x[beside[i][0]], out = x[beside[i][1]] - x[i];
    return in.normalized().dot(out.normalized()) < std::cos(angle);
  };
  auto left = network.edges;
  std::vector<FeatureLine> lines;
  const auto walk = [&](std::int32_t from, std::int32_t to) {
    FeatureLine line{{x[from]}, std::numeric_limits<double>::infinity()};
    for (const auto first = from;;) {
      const auto it = left.find(std::minmax(from, to));
      line.edge = std::min(line.edge, it->second);
      left.erase(it);
      line.points.push_back(x[to]);
      if (to == first || corner(to)) break;
      const auto next = beside[to][beside[to][0] == from ? 1 : 0];
      from = to, to = next;
    }
    lines.push_back(std::move(line));
  };
  for (std::int32_t i = 0; i < static_cast<std::int32_t>(x.size()); ++i)
    if (corner(i))
      for (const auto j : beside[i])
        if (left.contains(std::minmax(i, j))) walk(i, j);
  while (!left.empty()) walk(left.begin()->first.first, left.begin()->first.second);
  return lines;
}

/// Takes lines away that end in nothing and are shorter than an edge of the mesh: a rough surface's noise.
void drop_short_ends(Network& network, const std::vector<FeatureLine>& lines) {
  std::vector<int> degree(network.nodes.points.size());
  for (const auto& [e, wanted] : network.edges) ++degree[e.first], ++degree[e.second];
  for (const auto& line : lines) {
    const auto end = [&](const Vec3& x) { return degree[network.nodes.add(x)] == 1; };
    if (length(line) >= line.edge || !(end(line.points.front()) || end(line.points.back()))) continue;
    for (std::size_t i = 1; i < line.points.size(); ++i)
      network.edges.erase(std::minmax(network.nodes.add(line.points[i - 1]), network.nodes.add(line.points[i])));
  }
}

}  // namespace

double length(const FeatureLine& line) {
  double sum = 0;
  for (std::size_t i = 1; i < line.points.size(); ++i) sum += (line.points[i] - line.points[i - 1]).norm();
  return sum;
}

std::vector<FeatureLine> feature_lines(const std::vector<Featured>& surfaces, double angle) {
  double finest = std::numeric_limits<double>::infinity();
  for (const auto& f : surfaces) finest = std::min(finest, f.edge);
  const double tolerance = finest / 20;
  Network network{Welded(tolerance), {}};
  for (const auto& f : surfaces) add_sharp_edges(network, f, std::cos(angle));
  cut(network, tolerance);
  for (;;) {
    auto lines = lines_of(network, angle);
    const auto edges = network.edges.size();
    drop_short_ends(network, lines);
    if (network.edges.size() == edges) return lines;
  }
}

}  // namespace carus::mesh
