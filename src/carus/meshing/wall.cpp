// SPDX-License-Identifier: Apache-2.0
#include "carus/meshing/wall.hpp"

#include <algorithm>
#include <cmath>

#include "carus/core/error.hpp"
#include "carus/meshing/layer.hpp"

namespace carus::meshing {
namespace {

/// Rings stand closer than the edge: equilateral rows at 0.87, and the outer side of the bend stretches them.
constexpr double row = 0.80;
constexpr int perineal_layers = 3;
constexpr double search = 0.25;  // [m] the wall's inner face lies nearer to the axis than this

/// The inner face along a ray from within.
Vec3 on_inner(const anatomy::Uterus& uterus, const Vec3& from, const Vec3& direction) {
  double low = 0, high = 0.005;
  while (uterus.inner_distance(from + high * direction) < 0 && high < search) low = high, high += 0.005;
  CARUS_ASSERT(high < search);
  for (int i = 0; i < 40; ++i) {
    const double mid = (low + high) / 2;
    (uterus.inner_distance(from + mid * direction) < 0 ? low : high) = mid;
  }
  return from + low * direction;
}

/// The facets whose centre `keep` selects.
template <class Keep>
mesh::Triangles part(const mesh::TetMesh& m, const mesh::Triangles& from, Keep keep) {
  mesh::Triangles result;
  for (const auto& t : from)
    if (keep(Vec3((m.nodes[t[0]] + m.nodes[t[1]] + m.nodes[t[2]]) / 3))) result.push_back(t);
  return result;
}

struct Ring {
  std::int32_t first;
  int n;
  double start;  ///< angle of its first node, in turns of its own spacing
  [[nodiscard]] double angle(int i) const { return 2 * pi * (i + start) / n; }
  [[nodiscard]] std::int32_t node(int i) const { return first + i % n; }
};

/// Triangles between two rings, walking round both and always taking the shorter step.
void zip(const Ring& upper, const Ring& lower, mesh::Triangles& out) {
  int i = 0, j = 0;
  while (i < upper.n || j < lower.n) {
    const bool step_upper = j == lower.n || (i < upper.n && upper.angle(i + 1) < lower.angle(j + 1));
    if (step_upper) {
      out.push_back({upper.node(i), lower.node(j), upper.node(i + 1)});
      ++i;
    } else {
      out.push_back({upper.node(i), lower.node(j), lower.node(j + 1)});
      ++j;
    }
  }
}

}  // namespace

mesh::TetMesh mesh_wall(const anatomy::Uterus& uterus, const anatomy::PelvicFloor& floor, double levator_thickness,
                        double h) {
  const auto& axis = uterus.axis();
  const double top = -uterus.fundus_z(), end = axis.vulva();
  const double radius = (on_inner(uterus, axis.point(0), Vec3::UnitX()) - axis.point(0)).norm();
  const Vec3 centre = axis.point(top);
  const double dome = (on_inner(uterus, centre, Vec3::UnitZ()) - centre).norm();
  const int around = static_cast<int>(std::lround(2 * pi * std::max(radius, dome) / h));

  mesh::TetMesh m;
  std::vector<Ring> rings;
  const auto add_ring = [&](int n, const auto& point) {
    Ring r{static_cast<std::int32_t>(m.nodes.size()), n, rings.size() % 2 ? 0.5 : 0.0};
    for (int i = 0; i < n; ++i) m.nodes.push_back(point(r.angle(i)));
    rings.push_back(r);
  };
  // Pole, dome (rays from the breech's centre), tube (rays from the axis, in planes across it).
  m.nodes.push_back(on_inner(uterus, centre, Vec3::UnitZ()));
  const int rows = std::max(3, static_cast<int>(std::lround(pi / 2 * dome / (0.866 * h))));
  for (int k = 1; k < rows; ++k) {
    const double polar = pi / 2 * k / rows;
    const int n = std::min(around, std::max(6, static_cast<int>(std::lround(around * std::sin(polar)))));
    add_ring(n, [&](double a) {
      return on_inner(uterus, centre,
                      Vec3(std::cos(a) * std::sin(polar), std::sin(a) * std::sin(polar), std::cos(polar)));
    });
  }
  const int tube = static_cast<int>(std::lround((end - top) / (row * h)));
  for (int k = 0; k <= tube; ++k) {
    const double s = top + (end - top) * k / tube;
    const Vec3 t = axis.tangent(s), front(0, -t.z(), t.y());
    add_ring(around, [&](double a) {
      return on_inner(uterus, axis.centre(s), std::cos(a) * Vec3::UnitX() + std::sin(a) * front);
    });
  }

  mesh::Triangles surface;
  for (int i = 0; i < rings.front().n; ++i) surface.push_back({0, rings.front().node(i), rings.front().node(i + 1)});
  for (std::size_t k = 0; k + 1 < rings.size(); ++k) zip(rings[k], rings[k + 1], surface);

  const Vec3 last = axis.point(end), plane = axis.tangent(end);
  const auto outward = [&](const Vec3& x) -> Vec3 {
    Vec3 n = uterus.frame(x).normal;
    if (std::abs((x - last).dot(plane)) < 1e-9) n = (n - n.dot(plane) * plane).normalized();  // the end stays plane
    return x + uterus.thickness(x) * n;
  };
  const auto outer = add_layer(m, surface, outward, [&](const Vec3& x) { return uterus.region(x); });
  const auto sheet = add_layer(
      m, part(m, outer, [&](const Vec3& x) { return floor.levator(x); }),
      [&](const Vec3& x) { return Vec3(x + levator_thickness * floor.outward(x)); },
      [](const Vec3&) { return anatomy::levator_ani; });
  auto face = part(m, sheet, [&](const Vec3& x) { return floor.perineum(x); });
  for (int k = 0; k < perineal_layers; ++k)
    face = add_layer(
        m, face,
        [&](const Vec3& x) { return Vec3(x + floor.perineal_thickness(x) / perineal_layers * floor.outward(x)); },
        [](const Vec3&) { return anatomy::perineal_body; });
  return m;
}

}  // namespace carus::meshing
