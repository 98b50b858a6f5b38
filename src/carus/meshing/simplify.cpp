// SPDX-License-Identifier: Apache-2.0
#include "carus/meshing/simplify.hpp"

#include <CGAL/Simple_cartesian.h>
#include <CGAL/Surface_mesh.h>
#include <CGAL/Surface_mesh_simplification/Policies/Edge_collapse/Bounded_normal_change_filter.h>
#include <CGAL/Surface_mesh_simplification/edge_collapse.h>

#include <algorithm>
#include <cmath>

#include "carus/core/error.hpp"
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

}  // namespace

std::vector<mesh::Surface> simplify(const mesh::Surface& surface, const std::vector<std::size_t>& node_counts) {
  CARUS_ASSERT(std::is_sorted(node_counts.rbegin(), node_counts.rend()));
  std::vector<mesh::Surface> states;
  while (states.size() < node_counts.size() && node_counts[states.size()] >= surface.nodes.size())
    states.push_back(surface);
  if (states.size() == node_counts.size()) return states;
  const auto box = mesh::box(surface);
  const Scaling scaling{box.center(), box.sizes().maxCoeff()};
  Mesh m = to_cgal(surface, scaling);
  // Without the filter a few triangles in ten thousand fold over and cut their neighbours.
  Collapse::edge_collapse(m, Recorder(node_counts, states, scaling),
                          CGAL::parameters::filter(Collapse::Bounded_normal_change_filter<>()));
  while (states.size() < node_counts.size()) states.push_back(from_cgal(m, scaling));
  return states;
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
  return best;
}

}  // namespace carus::meshing
