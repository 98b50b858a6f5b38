// SPDX-License-Identifier: Apache-2.0
#include "carus/meshing/deviation.hpp"

#include <CGAL/AABB_traits.h>
#include <CGAL/AABB_tree.h>
#include <CGAL/AABB_triangle_primitive.h>
#include <CGAL/Simple_cartesian.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>

#include "carus/core/error.hpp"
#include "carus/core/parallel.hpp"

namespace carus::meshing {
namespace {

using Kernel = CGAL::Simple_cartesian<double>;
using Point = Kernel::Point_3;
using Facets = std::vector<Kernel::Triangle_3>;
using Primitive = CGAL::AABB_triangle_primitive<Kernel, Facets::const_iterator>;
using Tree = CGAL::AABB_tree<CGAL::AABB_traits<Kernel, Primitive>>;

Point point(const Vec3& x) { return {x.x(), x.y(), x.z()}; }
Vec3 vec(const Point& p) { return {p.x(), p.y(), p.z()}; }
constexpr std::size_t chunk = 4096;

Directed summary(std::vector<double> d) {
  Directed r;
  if (d.empty()) return r;
  const auto n = static_cast<double>(d.size());
  r.mean = std::accumulate(d.begin(), d.end(), 0.0) / n;
  r.rms = std::sqrt(std::inner_product(d.begin(), d.end(), d.begin(), 0.0) / n);
  r.largest = *std::max_element(d.begin(), d.end());
  const auto at = d.begin() + static_cast<std::ptrdiff_t>(0.95 * (n - 1));
  std::nth_element(d.begin(), at, d.end());
  r.percentile_95 = *at;
  return r;
}

/// Mean, RMS and percentile by area from the samples; the largest also over the nodes, where corners are.
Directed directed(const Distances& to, const mesh::Surface& from, std::size_t samples) {
  auto result = summary(to.to(sample(from, samples)));
  if (from.nodes.size() <= 4 * samples)
    for (const double d : to.to(from.nodes)) result.largest = std::max(result.largest, d);
  return result;
}

}  // namespace

struct Distances::Search {
  mesh::Surface surface;
  Facets facets;
  Tree tree;
};

Distances::Distances(const mesh::Surface& surface) : search_(std::make_unique<Search>()) {
  CARUS_ASSERT(!surface.triangles.empty());
  search_->surface = surface;
  auto& f = search_->facets;
  f.reserve(surface.triangles.size());
  for (const auto& t : surface.triangles)
    f.emplace_back(point(surface.nodes[t[0]]), point(surface.nodes[t[1]]), point(surface.nodes[t[2]]));
  search_->tree.insert(f.cbegin(), f.cend());
  search_->tree.do_not_accelerate_distance_queries();  // hints from the point before do better, and cost no memory
  search_->tree.build();
}
Distances::~Distances() = default;
Distances::Distances(Distances&&) noexcept = default;
Distances& Distances::operator=(Distances&&) noexcept = default;

const mesh::Surface& Distances::surface() const { return search_->surface; }

std::vector<double> Distances::to(const std::vector<Vec3>& points) const {
  std::vector<double> d(points.size());
  parallel::for_chunks(points.size(), chunk, [&](std::size_t begin, std::size_t end, std::size_t) {
    Point hint = search_->facets.front().vertex(0);
    for (std::size_t i = begin; i < end; ++i) {
      hint = search_->tree.closest_point(point(points[i]), hint);
      d[i] = (vec(hint) - points[i]).norm();
    }
  });
  return d;
}

Vec3 Distances::nearest(const Vec3& x) const {
  return vec(search_->tree.closest_point(point(x), search_->facets.front().vertex(0)));
}

Vec3 Distances::normal_at(const Vec3& x) const {
  const auto nearest = search_->tree.closest_point_and_primitive(point(x));
  const auto& t = search_->surface.triangles[nearest.second - search_->facets.cbegin()];
  const auto& X = search_->surface.nodes;
  return (X[t[1]] - X[t[0]]).cross(X[t[2]] - X[t[0]]).normalized();
}

double Distances::along(const Vec3& origin, const Vec3& direction) const {
  const Kernel::Ray_3 ray(point(origin), Kernel::Vector_3(direction.x(), direction.y(), direction.z()));
  const auto hit = search_->tree.first_intersection(ray);
  if (!hit) return std::numeric_limits<double>::infinity();
  if (const auto* p = boost::get<Point>(&hit->first)) return (vec(*p) - origin).norm();
  return 0;  // the ray runs within a facet
}

std::vector<Vec3> sample(const mesh::Surface& s, std::size_t count) {
  // The sequence of the plastic number (Roberts 2018), folded into the triangle.
  constexpr double g1 = 0.7548776662466927, g2 = 0.5698402909980532;
  std::vector<double> share(s.triangles.size());
  double whole = 0;
  for (std::size_t t = 0; t < share.size(); ++t) {
    const auto& [a, b, c] = s.triangles[t];
    share[t] = (s.nodes[b] - s.nodes[a]).cross(s.nodes[c] - s.nodes[a]).norm();
    whole += share[t];
  }
  std::vector<Vec3> points;
  points.reserve(count + 1);
  double running = 0.5;
  for (std::size_t t = 0; t < share.size(); ++t) {
    running += share[t] / whole * static_cast<double>(count);
    const auto& [a, b, c] = s.triangles[t];
    for (; running >= 1; running -= 1) {
      const auto i = static_cast<double>(points.size() + 1);
      double u = i * g1 - std::floor(i * g1), v = i * g2 - std::floor(i * g2);
      if (u + v > 1) u = 1 - u, v = 1 - v;
      points.push_back(s.nodes[a] + u * (s.nodes[b] - s.nodes[a]) + v * (s.nodes[c] - s.nodes[a]));
    }
  }
  return points;
}

Deviation compare(const Distances& original, const mesh::Surface& simplified, std::size_t samples) {
  return {directed(Distances(simplified), original.surface(), samples), directed(original, simplified, samples)};
}

std::vector<double> thicknesses(const Distances& solid, const std::function<bool(const Vec3&)>& where,
                                std::size_t samples) {
  const auto& s = solid.surface();
  const double start = 1e-4 * mesh::box(s).sizes().maxCoeff();
  std::vector<double> found;
  const auto points = sample(s, samples);
  for (const auto& x : points) {
    if (!where(x)) continue;
    // The normal of the facet that the sample lies on: inward rays from either side of it tell which way is in.
    const Vec3 n = solid.normal_at(x);
    const double d = solid.along(x - start * n, -n);
    if (!(d < 1)) continue;
    const Vec3 opposite = solid.normal_at(x - (start + d) * n);
    if (opposite.dot(n) < -0.5) found.push_back(start + d);
  }
  std::sort(found.begin(), found.end());
  return found;
}

}  // namespace carus::meshing
