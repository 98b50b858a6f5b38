// SPDX-License-Identifier: Apache-2.0
#include "carus/meshing/simplify.hpp"

#include <CGAL/Simple_cartesian.h>
#include <CGAL/Surface_mesh.h>
#include <CGAL/Surface_mesh_simplification/Policies/Edge_collapse/Bounded_normal_change_filter.h>
#include <CGAL/Surface_mesh_simplification/Policies/Edge_collapse/Constrained_placement.h>
#include <CGAL/Surface_mesh_simplification/Policies/Edge_collapse/LindstromTurk_placement.h>
#include <CGAL/Surface_mesh_simplification/edge_collapse.h>
#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "carus/core/error.hpp"
#include "carus/meshing/closed_solid.hpp"
#include "carus/meshing/deviation.hpp"

namespace carus::meshing {
namespace {

namespace Collapse = CGAL::Surface_mesh_simplification;
using Kernel = CGAL::Simple_cartesian<double>;
using Mesh = CGAL::Surface_mesh<Kernel::Point_3>;

// Costs are sums of squares of volumes and areas: near the origin and of order one they lose least.
struct Scaling {
  Vec3 centre;
  double size;
};

Mesh to_cgal(const mesh::Surface& s, const Scaling& to) {
  Mesh m;
  const auto nodes = static_cast<Mesh::size_type>(s.nodes.size());
  m.reserve(nodes, 3 * nodes, 2 * nodes);
  for (const auto& x : s.nodes) {
    const Vec3 y = (x - to.centre) / to.size;
    m.add_vertex({y.x(), y.y(), y.z()});
  }
  for (const auto& t : s.triangles) {
    const auto f = m.add_face(Mesh::Vertex_index(t[0]), Mesh::Vertex_index(t[1]), Mesh::Vertex_index(t[2]));
    if (f == Mesh::null_face())
      throw InputError("simplification: the surface touches itself in a node; separate its parts there");
  }
  return m;
}

mesh::Surface from_cgal(const Mesh& m, const Scaling& from) {
  mesh::Surface s;
  std::vector<std::int32_t> index(m.num_vertices(), -1);
  s.nodes.reserve(m.number_of_vertices());
  for (const auto v : m.vertices()) {
    index[v] = static_cast<std::int32_t>(s.nodes.size());
    const auto& p = m.point(v);
    s.nodes.push_back(from.centre + from.size * Vec3(p.x(), p.y(), p.z()));
  }
  s.triangles.reserve(m.number_of_faces());
  for (const auto f : m.faces()) {
    const auto h = m.halfedge(f);
    s.triangles.push_back({index[m.source(h)], index[m.target(h)], index[m.target(m.next(h))]});
  }
  return s;
}

/// Looks on before each collapse: takes the wanted states, and ends after the last.
class Recorder {
 public:
  Recorder(const std::vector<std::size_t>& counts, std::vector<mesh::Surface>& states, const Scaling& scaling)
      : counts_(&counts), states_(&states), scaling_(scaling) {}
  template <class Profile>
  bool operator()(double, const Profile& profile, std::size_t, std::size_t) const {
    const Mesh& m = profile.surface_mesh();
    while (states_->size() < counts_->size() && m.number_of_vertices() <= (*counts_)[states_->size()])
      states_->push_back(from_cgal(m, scaling_));
    return states_->size() == counts_->size();
  }

 private:
  const std::vector<std::size_t>* counts_;
  std::vector<mesh::Surface>* states_;
  Scaling scaling_;
};

/// Which edges are to stay, as CGAL asks for it.
struct Kept {
  using key_type = Mesh::Edge_index;
  using value_type = bool;
  using reference = bool;
  using category = boost::readable_property_map_tag;
  const std::vector<char>* edges;  ///< empty if none is
  friend bool get(const Kept& kept, const Mesh::Edge_index& e) { return !kept.edges->empty() && (*kept.edges)[e] != 0; }
};

struct Ball {
  Vec3 centre;
  double radius;
};

/// simplify, but edges of the original that reach into a ball stay.
std::vector<mesh::Surface> simplify_outside(const std::vector<Ball>& balls, const mesh::Surface& surface,
                                            const std::vector<std::size_t>& node_counts) {
  CARUS_ASSERT(std::is_sorted(node_counts.rbegin(), node_counts.rend()));
  std::vector<mesh::Surface> states;
  while (states.size() < node_counts.size() && node_counts[states.size()] >= surface.nodes.size())
    states.push_back(surface);
  if (states.size() == node_counts.size()) return states;
  const auto box = mesh::box(surface);
  const Scaling scaling{box.center(), box.sizes().maxCoeff()};
  Mesh m = to_cgal(surface, scaling);
  std::vector<char> edges;
  if (!balls.empty()) {
    edges.resize(m.num_edges());
    const auto within = [&](Mesh::Vertex_index v) {
      return std::any_of(balls.begin(), balls.end(),
                         [&](const auto& b) { return (surface.nodes[v] - b.centre).norm() < b.radius; });
    };
    for (const auto e : m.edges()) edges[e] = within(m.vertex(e, 0)) || within(m.vertex(e, 1));
  }
  const Kept kept{&edges};
  // Without the filter a few triangles in ten thousand fold over and cut their neighbours.
  Collapse::edge_collapse(
      m, Recorder(node_counts, states, scaling),
      CGAL::parameters::filter(Collapse::Bounded_normal_change_filter<>())
          .edge_is_constrained_map(kept)
          .get_placement(Collapse::Constrained_placement<Collapse::LindstromTurk_placement<Mesh>, Kept>(kept)));
  while (states.size() < node_counts.size()) states.push_back(from_cgal(m, scaling));
  return states;
}

/// Where pairs of triangles cut through each other: round both, half as far again.
std::vector<Ball> cuts(const mesh::Surface& s) {
  std::vector<Ball> balls;
  for (const auto& [a, b] : self_intersections(s)) {
    Eigen::AlignedBox3d box;
    for (const auto t : {a, b})
      for (const auto i : s.triangles[t]) box.extend(s.nodes[i]);
    balls.push_back({box.center(), 0.75 * box.diagonal().norm()});
  }
  return balls;
}

}  // namespace

std::vector<mesh::Surface> simplify(const mesh::Surface& surface, const std::vector<std::size_t>& node_counts) {
  return simplify_outside({}, surface, node_counts);
}

mesh::Surface simplify_soundly(const mesh::Surface& surface, std::size_t node_count) {
  auto state = simplify(surface, {node_count}).front();
  auto kept = cuts(state);
  if (kept.empty()) return state;
  if (node_count >= surface.nodes.size())
    throw NumericalFailure(
        fmt::format("simplification: triangles of the surface itself cut through each other, first "
                    "near ({:.1f}, {:.1f}, {:.1f}) mm; repair it in the program that made it",
                    1e3 * kept[0].centre.x(), 1e3 * kept[0].centre.y(), 1e3 * kept[0].centre.z()));
  const auto finer = simplify_soundly(surface, 4 * node_count);
  for (;;) {
    state = simplify_outside(kept, finer, {node_count}).front();
    const auto found = cuts(state);
    if (found.empty()) return state;
    kept.insert(kept.end(), found.begin(), found.end());
  }
}

mesh::Surface simplify_within(const mesh::Surface& surface, double largest_distance) {
  const Distances original(surface);
  std::size_t good = surface.nodes.size(), bad = 3;
  mesh::Surface best = surface;
  // The first pass halves the number again and again; what follows narrows the last halving down.
  while (static_cast<double>(good) > 1.03 * static_cast<double>(bad) && good > bad + 1) {
    std::vector<std::size_t> counts;
    if (bad == 3)
      for (std::size_t n = good / 2; n >= 8; n /= 2) counts.push_back(n);
    else
      counts = {good - (good - bad) / 4, (good + bad) / 2, bad + (good - bad) / 4};
    const auto before = std::pair(good, bad);
    for (auto& state : simplify(surface, counts)) {
      const auto n = state.nodes.size();
      if (compare(original, state).largest() > largest_distance) {
        bad = std::max(bad, n);
        break;
      }
      good = n, best = std::move(state);
    }
    if (std::pair(good, bad) == before || (bad == 3 && counts.empty())) break;
    if (bad == 3) break;  // even the coarsest state is near enough
  }
  if (self_intersections(best).empty()) return best;
  // What soundness keeps in one place is missing in others.
  for (std::size_t n = best.nodes.size(); n < surface.nodes.size(); n += n / 33 + 1)
    if (auto sound = simplify_soundly(surface, n); compare(original, sound).largest() <= largest_distance) return sound;
  return surface;
}

}  // namespace carus::meshing
