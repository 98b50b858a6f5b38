// SPDX-License-Identifier: Apache-2.0
// From triangles as a file has them to a solid's boundary: each repair is a step of its own and says what it did.
#include <fmt/format.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <map>
#include <numeric>
#include <unordered_map>

#include "carus/core/error.hpp"
#include "carus/mesh/surface.hpp"

namespace carus::mesh {
namespace {

std::string place(const Vec3& x) {
  return fmt::format("({:.1f}, {:.1f}, {:.1f}) mm", 1e3 * x.x(), 1e3 * x.y(), 1e3 * x.z());
}

std::uint64_t undirected(std::int32_t a, std::int32_t b) {
  const auto [lo, hi] = std::minmax(a, b);
  return (static_cast<std::uint64_t>(lo) << 32) | static_cast<std::uint32_t>(hi);
}

struct EdgeHash {
  std::size_t operator()(std::uint64_t e) const { return (e ^ (e >> 31)) * 0x9e3779b97f4a7c15ULL; }
};
/// The two triangles of an edge, -1 where there is none, and how many there are.
struct Edge {
  std::array<std::int32_t, 2> triangles{-1, -1};
  int count = 0;
};
using Edges = std::unordered_map<std::uint64_t, Edge, EdgeHash>;

class Closer {
 public:
  Closer(Surface s, std::string name) : s_(std::move(s)), name_(std::move(name)) {}

  Closed run(int largest_hole) {
    check_numbers();
    merge_nodes();
    drop_triangles();
    if (s_.triangles.empty()) refuse("has no triangle with three different corners");
    drop_unused();
    check_edges();
    orient();
    close_holes(largest_hole);
    turn_outward();
    return {std::move(s_), std::move(repairs_)};
  }

 private:
  [[noreturn]] void refuse(const std::string& why) const { throw InputError(fmt::format("{}: {}", name_, why)); }
  void tell(std::string what) { repairs_.push_back(std::move(what)); }

  void check_numbers() const {
    for (std::size_t i = 0; i < s_.nodes.size(); ++i)
      if (!(s_.nodes[i].cwiseAbs().maxCoeff() < 1e3))  // NaN, too
        refuse(fmt::format("node {} is at no place within a kilometre; is the unit right?", i));
    const auto n = static_cast<std::int32_t>(s_.nodes.size());
    for (std::size_t t = 0; t < s_.triangles.size(); ++t)
      for (const auto i : s_.triangles[t])
        if (i < 0 || i >= n) refuse(fmt::format("triangle {} names node {}; there are {}", t, i, n));
  }

  /// Nodes at the very same place are one: formats such as STL repeat them for each triangle.
  void merge_nodes() {
    std::vector<std::int32_t> order(s_.nodes.size()), first(s_.nodes.size());
    std::iota(order.begin(), order.end(), 0);
    const auto less = [&](std::int32_t a, std::int32_t b) {
      const Vec3 &p = s_.nodes[a], &q = s_.nodes[b];
      return std::tie(p[0], p[1], p[2], a) < std::tie(q[0], q[1], q[2], b);
    };
    std::sort(order.begin(), order.end(), less);
    std::size_t merged = 0;
    for (std::size_t i = 0; i < order.size(); ++i) {
      const bool same = i > 0 && s_.nodes[order[i]] == s_.nodes[order[i - 1]];
      first[order[i]] = same ? first[order[i - 1]] : order[i];
      merged += same;
    }
    for (auto& t : s_.triangles)
      for (auto& i : t) i = first[i];
    if (merged > 0) tell(fmt::format("{} nodes at the place of another merged with it", merged));
  }

  void drop_triangles() {
    const auto degenerate =
        std::erase_if(s_.triangles, [](const Triangle& t) { return t[0] == t[1] || t[1] == t[2] || t[2] == t[0]; });
    if (degenerate > 0) tell(fmt::format("{} triangles with two corners in one dropped", degenerate));
    std::map<Triangle, int> seen;
    const auto repeated = std::erase_if(s_.triangles, [&](Triangle t) {
      std::sort(t.begin(), t.end());
      return seen[t]++ > 0;
    });
    if (repeated > 0) tell(fmt::format("{} repeated triangles dropped", repeated));
  }

  void drop_unused() {
    std::vector<std::int32_t> renumbered(s_.nodes.size(), -1);
    std::vector<Vec3> kept;
    for (auto& t : s_.triangles)
      for (auto& i : t) {
        if (renumbered[i] < 0) renumbered[i] = static_cast<std::int32_t>(kept.size()), kept.push_back(s_.nodes[i]);
        i = renumbered[i];
      }
    s_.nodes = std::move(kept);
  }

  void check_edges() {
    edges_.reserve(2 * s_.triangles.size());
    std::size_t crowded = 0;
    Vec3 where = Vec3::Zero();
    for (std::size_t t = 0; t < s_.triangles.size(); ++t)
      for (int k = 0; k < 3; ++k) {
        const auto a = s_.triangles[t][k], b = s_.triangles[t][(k + 1) % 3];
        auto& e = edges_[undirected(a, b)];
        if (e.count < 2) e.triangles[e.count] = static_cast<std::int32_t>(t);
        if (++e.count == 3 && crowded++ == 0) where = (s_.nodes[a] + s_.nodes[b]) / 2;
      }
    if (crowded > 0)
      refuse(
          fmt::format("{} edges have more than two triangles, the first at {}; which side is inside cannot be told; "
                      "separate the shells that touch there",
                      crowded, place(where)));
  }

  [[nodiscard]] bool runs(std::int32_t t, std::int32_t a, std::int32_t b) const {
    const auto& q = s_.triangles[t];
    return (q[0] == a && q[1] == b) || (q[1] == a && q[2] == b) || (q[2] == a && q[0] == b);
  }

  /// Neighbours run along their common edge in opposite directions.
  void orient() {
    std::vector<char> done(s_.triangles.size(), 0);
    std::size_t turned = 0;
    for (std::size_t seed = 0; seed < s_.triangles.size(); ++seed) {
      if (done[seed]) continue;
      done[seed] = 1;
      std::vector<std::int32_t> front{static_cast<std::int32_t>(seed)};
      while (!front.empty()) {
        const auto t = front.back();
        front.pop_back();
        for (int k = 0; k < 3; ++k) {
          const auto a = s_.triangles[t][k], b = s_.triangles[t][(k + 1) % 3];
          const auto& e = edges_.at(undirected(a, b));
          if (e.count < 2) continue;
          const auto other = e.triangles[0] == t ? e.triangles[1] : e.triangles[0];
          if (!runs(other, b, a)) {
            if (done[other]) refuse(fmt::format("cannot be oriented (like a Moebius strip) at {}", place(s_.nodes[a])));
            std::swap(s_.triangles[other][1], s_.triangles[other][2]);
            ++turned;
          }
          if (!done[other]) done[other] = 1, front.push_back(other);
        }
      }
    }
    if (turned > 0) tell(fmt::format("{} triangles turned to agree with their neighbours", turned));
  }

  /// The loops along open edges, against the direction of the triangles there; each node's next.
  void close_holes(int largest) {
    std::map<std::int32_t, std::int32_t> next;
    std::size_t open = 0;
    for (const auto& t : s_.triangles)
      for (int k = 0; k < 3; ++k) {
        const auto a = t[k], b = t[(k + 1) % 3];
        if (edges_.at(undirected(a, b)).count != 1) continue;
        ++open;
        if (!next.emplace(b, a).second)
          refuse(fmt::format("two holes touch in one node at {}; which edges belong together cannot be told",
                             place(s_.nodes[b])));
      }
    std::size_t filled = 0;
    while (!next.empty()) {
      std::vector<std::int32_t> loop;
      for (auto i = next.begin()->first; next.contains(i);) {
        loop.push_back(i);
        const auto to = next[i];
        next.erase(i);
        i = to;
      }
      if (static_cast<int>(loop.size()) > largest)
        refuse(
            fmt::format("is not closed: {} open edges, a hole of {} edges at {}; holes of up to {} edges are closed, "
                        "close this one in the program that made the surface",
                        open, loop.size(), place(s_.nodes[loop.front()]), largest));
      fill(loop);
      ++filled;
    }
    if (filled > 0) tell(fmt::format("{} holes of at most {} edges closed", filled, largest));
  }

  void fill(const std::vector<std::int32_t>& loop) {
    if (loop.size() == 3) {
      s_.triangles.push_back({loop[0], loop[1], loop[2]});
      return;
    }
    Vec3 centre = Vec3::Zero();
    for (const auto i : loop) centre += s_.nodes[i] / static_cast<double>(loop.size());
    const auto c = static_cast<std::int32_t>(s_.nodes.size());
    s_.nodes.push_back(centre);
    for (std::size_t i = 0; i < loop.size(); ++i) s_.triangles.push_back({loop[i], loop[(i + 1) % loop.size()], c});
  }

  /// A shell within an odd number of others is the wall of a cavity: it faces inward.
  void turn_outward() {
    const auto p = parts(s_);
    std::vector<Surface> shells(p.count);
    for (std::size_t t = 0; t < s_.triangles.size(); ++t) shells[p.of[t]].triangles.push_back(s_.triangles[t]);
    std::vector<Eigen::AlignedBox3d> boxes(p.count);
    std::vector<double> volumes(p.count);
    for (std::int32_t i = 0; i < p.count; ++i) {
      for (const auto& t : shells[i].triangles)
        for (const auto k : t) boxes[i].extend(s_.nodes[k]);
      volumes[i] = signed_volume(shells[i].triangles, boxes[i].center());
    }
    int turned = 0, cavities = 0;
    std::vector<char> turn(p.count, 0);
    for (std::int32_t i = 0; i < p.count; ++i) {
      const Vec3& x = s_.nodes[shells[i].triangles[0][0]];
      int around = 0;
      for (std::int32_t j = 0; j < p.count; ++j)
        if (j != i && boxes[j].contains(x)) around += std::abs(winding(shells[j].triangles, x)) > 0.5;
      const bool cavity = around % 2 == 1;
      cavities += cavity;
      turn[i] = cavity ? volumes[i] > 0 : volumes[i] < 0;
      turned += turn[i];
    }
    for (std::size_t t = 0; t < s_.triangles.size(); ++t)
      if (turn[p.of[t]]) std::swap(s_.triangles[t][1], s_.triangles[t][2]);
    if (turned > 0) tell(fmt::format("{} of {} parts were inside out: turned", turned, p.count));
    if (cavities > 0) tell(fmt::format("{} of {} parts lie within another: they are its cavities", cavities, p.count));
    if (p.count - cavities > 1) tell(fmt::format("{} separate parts, all kept", p.count - cavities));
  }

  [[nodiscard]] double signed_volume(const Triangles& triangles, const Vec3& o) const {
    double v = 0;
    for (const auto& t : triangles) v += (s_.nodes[t[0]] - o).dot((s_.nodes[t[1]] - o).cross(s_.nodes[t[2]] - o)) / 6;
    return v;
  }
  [[nodiscard]] double winding(const Triangles& triangles, const Vec3& x) const {
    Surface shell;
    for (const auto& t : triangles) {
      const auto n = static_cast<std::int32_t>(shell.nodes.size());
      for (const auto i : t) shell.nodes.push_back(s_.nodes[i]);
      shell.triangles.push_back({n, n + 1, n + 2});
    }
    return winding_number(shell, x);
  }

  Surface s_;
  std::string name_;
  std::vector<std::string> repairs_;
  Edges edges_;
};

}  // namespace

Closed closed(Surface s, const std::string& name, int largest_hole) {
  return Closer(std::move(s), name).run(largest_hole);
}

}  // namespace carus::mesh
