// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>
#include <memory>
#include <vector>

#include "carus/mesh/surface.hpp"

namespace carus::meshing {

/// Distances from points to a surface, ready to be asked for; keeps a copy of nothing but a search tree. Thread-safe.
class Distances {
 public:
  explicit Distances(const mesh::Surface& surface);
  ~Distances();
  Distances(Distances&&) noexcept;
  Distances& operator=(Distances&&) noexcept;
  /// To the nearest point of the surface [m], one for each point. Points near each other in the list are fastest.
  [[nodiscard]] std::vector<double> to(const std::vector<Vec3>& points) const;
  [[nodiscard]] Vec3 nearest(const Vec3& x) const;    ///< nearest point of the surface
  [[nodiscard]] Vec3 normal_at(const Vec3& x) const;  ///< unit normal of the facet nearest to x
  /// Distance along a ray of unit direction to its first meeting with the surface; infinity if there is none.
  [[nodiscard]] double along(const Vec3& origin, const Vec3& direction) const;
  [[nodiscard]] const mesh::Surface& surface() const;

 private:
  struct Search;
  std::unique_ptr<Search> search_;
};

/// Distances of one surface from another at points spread evenly over it [m].
struct Directed {
  double mean = 0, rms = 0, percentile_95 = 0, largest = 0;
};
struct Deviation {
  Directed forward, backward;  ///< of the original from the simplified one, and back
  [[nodiscard]] double mean() const { return std::max(forward.mean, backward.mean); }  ///< as MESH's symmetric mean
  [[nodiscard]] double largest() const { return std::max(forward.largest, backward.largest); }  ///< Hausdorff
};

/// About `count` points on a surface, evenly by area: each triangle gets its share, the remainders of the shares go to
/// the triangles where their running sum passes a whole number; within a triangle a sequence of low discrepancy.
/// Deterministic, in the order of the triangles.
std::vector<Vec3> sample(const mesh::Surface& surface, std::size_t count);

/// Both directions, in the manner of MESH (Aspert, Santa-Cruz and Ebrahimi 2002): samples on each surface, and its
/// nodes where they are no more than four times the samples. 100,000 samples know means to 0.3 % and, short of the
/// nodes, largest distances from below.
Deviation compare(const Distances& original, const mesh::Surface& simplified, std::size_t samples = 100000);

/// How thick a closed surface is at samples of it that `where` selects: along the inward normal to the opposite side
/// [m]. Normals that graze (opposite facet more than 60 degrees off) are left out. Sorted.
std::vector<double> thicknesses(const Distances& solid, const std::function<bool(const Vec3&)>& where,
                                std::size_t samples = 20000);

}  // namespace carus::meshing
