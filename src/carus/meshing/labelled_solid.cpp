// SPDX-License-Identifier: Apache-2.0
// The only translation unit that knows CGAL (GPL; 45 s and 3 GB to compile).
#include "carus/meshing/labelled_solid.hpp"

#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>
#include <CGAL/Labeled_mesh_domain_3.h>
#include <CGAL/Mesh_complex_3_in_triangulation_3.h>
#include <CGAL/Mesh_criteria_3.h>
#include <CGAL/Mesh_domain_with_polyline_features_3.h>
#include <CGAL/Mesh_triangulation_3.h>
#include <CGAL/exude_mesh_3.h>
#include <CGAL/make_mesh_3.h>
#include <CGAL/refine_mesh_3.h>

#include <Eigen/Geometry>
#include <cmath>
#include <limits>
#include <unordered_map>

#include "carus/core/error.hpp"

namespace carus::meshing {
namespace {

using Kernel = CGAL::Exact_predicates_inexact_constructions_kernel;
using Point = Kernel::Point_3;
using Base = CGAL::Mesh_domain_with_polyline_features_3<CGAL::Labeled_mesh_domain_3<Kernel>>;

Vec3 vec(const Point& p) { return {p.x(), p.y(), p.z()}; }

/// A point of the surface between two labels.
struct Seed {
  Vec3 x;
  std::int32_t a, b;
};

/// Points of all surfaces found by walking along the lines of a grid, thinned to about one per facet edge, in a fixed
/// order. CGAL's own start shoots rays from the centre and never finds a part that no Delaunay edge happens to cross.
std::vector<Seed> find_seeds(const LabelFunction& solid, const Sphere& bounds, const Sizing& sizing) {
  const double h = sizing.seed_spacing;
  const int n = static_cast<int>(std::ceil(bounds.radius / h));
  const auto at = [&](int i, int j, int k) { return Vec3(bounds.centre + h * Vec3(i, j, k)); };
  const int w = 2 * n + 1;
  std::vector<std::int32_t> labels(static_cast<std::size_t>(w) * w * w, 0);
  const auto cell = [&](int i, int j, int k) { return (static_cast<std::size_t>(i + n) * w + (j + n)) * w + (k + n); };
  for (int i = -n; i <= n; ++i)
    for (int j = -n; j <= n; ++j)
      for (int k = -n; k <= n; ++k)
        if (h * std::sqrt(static_cast<double>(i * i + j * j + k * k)) < bounds.radius)
          labels[cell(i, j, k)] = solid(at(i, j, k));

  std::vector<Seed> seeds;
  std::unordered_map<std::int64_t, std::vector<std::size_t>> bins;
  constexpr double bin = 0.012;  // [m] of the order of a facet; only speed depends on it
  const auto key = [&](const Vec3& x, int di, int dj, int dk) {
    const auto q = [&](double u, int d) { return static_cast<std::int64_t>(std::floor(u / bin)) + d + 100000; };
    return (q(x.x(), di) * 1000003 + q(x.y(), dj)) * 1000003 + q(x.z(), dk);
  };
  for (const auto& line : sizing.features)  // what lies beside a feature is left to its balls
    for (std::size_t i = 1; i < line.points.size(); ++i) {
      const Vec3 u = line.points[i] - line.points[i - 1];
      const int pieces = static_cast<int>(std::ceil(2 * u.norm() / line.edge));
      for (int k = 0; k <= pieces; ++k) {
        const Vec3 x = line.points[i - 1] + u * k / pieces;
        bins[key(x, 0, 0, 0)].push_back(seeds.size());
        seeds.push_back({x, 0, 0});
      }
    }
  const auto beside_features = static_cast<std::ptrdiff_t>(seeds.size());
  const auto try_seed = [&](Vec3 p, Vec3 q, std::int32_t a, std::int32_t b) {
    for (int it = 0; it < 24; ++it) {
      const Vec3 m = (p + q) / 2;
      const auto l = solid(m);
      if (l == a)
        p = m;
      else
        q = m, b = l;
    }
    const auto [lo, hi] = std::minmax(a, b);
    const double spacing = 0.9 * sizing.facet(p, lo, hi);
    const int reach = static_cast<int>(std::ceil(spacing / bin));
    for (int di = -reach; di <= reach; ++di)
      for (int dj = -reach; dj <= reach; ++dj)
        for (int dk = -reach; dk <= reach; ++dk)
          if (const auto it = bins.find(key(p, di, dj, dk)); it != bins.end())
            for (const auto s : it->second)
              if ((seeds[s].x - p).norm() < spacing) return;
    bins[key(p, 0, 0, 0)].push_back(seeds.size());
    seeds.push_back({p, lo, hi});
  };
  for (int i = -n; i < n; ++i)
    for (int j = -n; j < n; ++j)
      for (int k = -n; k < n; ++k) {
        const auto a = labels[cell(i, j, k)];
        if (const auto b = labels[cell(i + 1, j, k)]; b != a) try_seed(at(i, j, k), at(i + 1, j, k), a, b);
        if (const auto b = labels[cell(i, j + 1, k)]; b != a) try_seed(at(i, j, k), at(i, j + 1, k), a, b);
        if (const auto b = labels[cell(i, j, k + 1)]; b != a) try_seed(at(i, j, k), at(i, j, k + 1), a, b);
      }
  seeds.erase(seeds.begin(), seeds.begin() + beside_features);
  return seeds;
}

/// The labelled solid with our own first points.
class Domain : public Base {
 public:
  Domain(const LabelFunction& solid, const Sphere& bounds, const Sizing& sizing, CGAL::Random& random)
      : Base(
            CGAL::parameters::function = [&solid](const Point& p) { return static_cast<int>(solid(vec(p))); },
            CGAL::parameters::bounding_object = Kernel::Sphere_3(
                {bounds.centre.x(), bounds.centre.y(), bounds.centre.z()}, bounds.radius * bounds.radius),
            CGAL::parameters::relative_error_bound = 1e-6, CGAL::parameters::p_rng = &random),
        seeds_(find_seeds(solid, bounds, sizing)) {
    std::vector<std::vector<Point>> lines;
    for (const auto& f : sizing.features) {
      lines.emplace_back();
      for (const auto& x : f.points) lines.back().emplace_back(x.x(), x.y(), x.z());
    }
    add_features(lines.begin(), lines.end());  // curve indices count from 1
  }

  struct Construct_initial_points {
    const Domain& domain;
    template <class Out>
    Out operator()(Out out, int = 0) const {
      for (const auto& s : domain.seeds_)
        *out++ = std::make_pair(Point(s.x.x(), s.x.y(), s.x.z()), domain.index_from_surface_patch_index({s.a, s.b}));
      return out;
    }
  };
  [[nodiscard]] Construct_initial_points construct_initial_points_object() const { return {*this}; }
  [[nodiscard]] std::size_t seeds() const { return seeds_.size(); }

  /// Into a mesh that has points already.
  template <class Complex>
  void insert_seeds(Complex& c3t3) const {
    for (const auto& s : seeds_) {
      const auto v = c3t3.triangulation().insert(
          typename Complex::Triangulation::Weighted_point(Point(s.x.x(), s.x.y(), s.x.z())));
      if (v == typename Complex::Vertex_handle() || v->in_dimension() >= 0)
        continue;  // within a ball, or one of its own
      c3t3.set_dimension(v, 2);
      c3t3.set_index(v, index_from_surface_patch_index({s.a, s.b}));
    }
  }

 private:
  std::vector<Seed> seeds_;
};

using Triangulation = CGAL::Mesh_triangulation_3<Domain, CGAL::Default, CGAL::Sequential_tag>::type;
using Complex = CGAL::Mesh_complex_3_in_triangulation_3<Triangulation, Domain::Corner_index, Domain::Curve_index>;
using Criteria = CGAL::Mesh_criteria_3<Triangulation>;

/// A field of CGAL's kind from a function of point and labels.
struct Field {
  using FT = Kernel::FT;
  using Point_3 = Point;
  using Index = Domain::Index;
  std::function<double(const Vec3&, std::int32_t, std::int32_t)> f;
  FT operator()(const Point_3& p, int, const Index& index) const {
    if (const auto* patch = boost::get<Domain::Surface_patch_index>(&index))
      return f(vec(p), patch->first, patch->second);
    const auto* label = boost::get<Domain::Subdomain_index>(&index);
    return f(vec(p), label ? *label : 0, 0);
  }
};

/// The same for lines: their own edges; at a corner the shortest of those that meet there.
struct FeatureField {
  using FT = Kernel::FT;
  using Point_3 = Point;
  using Index = Domain::Index;
  const std::vector<mesh::FeatureLine>& lines;
  FT operator()(const Point_3& p, int dimension, const Index& index) const {
    if (dimension == 1) return lines.at(boost::get<Domain::Curve_index>(index) - 1).edge;
    double least = std::numeric_limits<double>::infinity();
    for (const auto& line : lines)
      if (line.points.front() == vec(p) || line.points.back() == vec(p)) least = std::min(least, line.edge);
    return least;
  }
};

mesh::TetMesh tets_of(const Complex& c3t3) {
  mesh::TetMesh m;
  std::unordered_map<Complex::Vertex_handle, std::int32_t, CGAL::Handle_hash_function> index;
  for (auto c = c3t3.cells_in_complex_begin(); c != c3t3.cells_in_complex_end(); ++c) {
    mesh::Tet t{};
    for (int i = 0; i < 4; ++i) {
      const auto v = c->vertex(i);
      const auto [it, fresh] = index.try_emplace(v, static_cast<std::int32_t>(m.nodes.size()));
      if (fresh) m.nodes.push_back(vec(v->point().point()));
      t[i] = it->second;
    }
    m.tets.push_back(t);
    m.labels.push_back(c3t3.subdomain_index(c));
  }
  return m;
}

}  // namespace

mesh::TetMesh mesh_labelled_solid(const LabelFunction& solid, const Sphere& bounds, const Sizing& sizing) {
  CGAL::Random random(0);
  const Domain domain(solid, bounds, sizing, random);
  if (domain.seeds() < 4 && sizing.features.empty())
    throw InputError(
        "meshing: the solid has no surface within its bounding sphere; hint: check its size against seed_spacing");

  // CGAL bounds circumradii: R of the facet's Delaunay ball, equilateral edge sqrt(3) R, regular tet edge sqrt(8/3) R.
  const Field facet{
      [&](const Vec3& p, std::int32_t a, std::int32_t b) { return sizing.facet(p, a, b) / std::sqrt(2.2); }};
  const Field distance{sizing.distance};
  const Field cell{
      [&](const Vec3& p, std::int32_t label, std::int32_t) { return sizing.cell(p, label) / std::sqrt(1.9); }};
  const Criteria criteria(CGAL::parameters::facet_angle = 25, CGAL::parameters::facet_size = facet,
                          CGAL::parameters::facet_distance = distance, CGAL::parameters::cell_radius_edge_ratio = 2.5,
                          CGAL::parameters::cell_size = cell);
  const auto as_it_is = std::pair(CGAL::parameters::no_perturb(), CGAL::parameters::no_exude());
  Complex c3t3;
  if (sizing.features.empty()) {
    c3t3 =
        CGAL::make_mesh_3<Complex>(domain, criteria, CGAL::parameters::no_features(), as_it_is.first, as_it_is.second);
  } else {
    // The lines alone first, for CGAL takes seeds only where it has no feature to begin with.
    const Criteria lines(CGAL::parameters::edge_size = FeatureField{sizing.features});
    c3t3 =
        CGAL::make_mesh_3<Complex>(domain, lines, CGAL::parameters::features(domain), as_it_is.first, as_it_is.second);
    domain.insert_seeds(c3t3);
    CGAL::refine_mesh_3(c3t3, domain, criteria, as_it_is.first, as_it_is.second);
  }
  // No time limit: it would make the mesh depend on the machine. raise_altitudes does better than CGAL's perturbation,
  // and four times faster.
  CGAL::exude_mesh_3(c3t3, CGAL::parameters::sliver_bound = sizing.sliver_bound_deg);
  return tets_of(c3t3);
}

}  // namespace carus::meshing
