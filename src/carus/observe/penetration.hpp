// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <string>
#include <vector>

#include "carus/fem/model.hpp"

namespace carus::observe {

/// How two bodies stand to each other, by an exact search that shares nothing with the solver's contact.
struct Penetration {
  std::string a, b;             ///< bodies (Region::organ)
  double least_gap = 0;         ///< [m] over both passes, at most `search`; negative: deepest penetration
  double least_smooth_gap = 0;  ///< [m] the same against the surface that the facets stand for: see `PenetrationCheck`
  std::int32_t node = -1;       ///< the node that has least_smooth_gap
  int penetrated = 0;           ///< nodes that lie inside the other body
};

/// Contact nodes of a body against all of another's boundary, and the other way round, for any two bodies that some
/// contact pair joins. A node is inside if a tet of the other body holds it that does not have it as a corner; its
/// depth is the exact distance to the nearest facet of that body's boundary, flat as it is in the mesh. A body against
/// itself counts penetration only: a gap to one's own neighbours means nothing.
///
/// Flat facets of edge h cut a surface of radius R short by up to h²/6R, on either side. The smooth gap is to the
/// curved patches that they stand for: a facet's lies ½ Σ w_k (x_k - p)·n_k, at most 1 mm, beyond its point p = Σ w_k
/// x_k, along the mean of the n_k. n_k is the normal at a corner, of those facets round it only that edges of less than
/// 50° at rest join to this one: rims stay rims. From outside it is the nearest facet's patch; from inside the nearest
/// patch of those that the node lies behind.
class PenetrationCheck {
 public:
  /// `search` [m]: gaps beyond it are not looked for.
  PenetrationCheck(const fem::Model& model, double search);
  [[nodiscard]] std::vector<Penetration> check(const std::vector<Vec3>& x) const;

 private:
  struct Body {
    std::string name;
    std::vector<mesh::Tet> tets;
    mesh::Triangles boundary;
    std::vector<std::array<std::vector<std::int32_t>, 3>>
        round;  // per facet and corner: facets that share it, but not over a rim
  };
  struct Pass {
    std::size_t onto;                 // of bodies_
    std::size_t result;               // of joined_
    std::vector<std::int32_t> nodes;  // contact nodes of the other body
    bool self;
  };
  struct Gap {
    double flat, smooth;  // [m]
  };
  /// What a facet stands for at one of its points.
  struct Patch {
    double sagitta;  // [m] that it lies farther out
    Vec3 normal;
  };
  [[nodiscard]] static Patch patch(const std::vector<Vec3>& x, const Body& body, std::int32_t facet,
                                   const Vec3& weights);
  struct Search;
  void run(const std::vector<Vec3>& x, const Search& onto, const Pass& pass, Penetration& out) const;

  double search_;
  std::vector<Body> bodies_;
  std::vector<Pass> passes_;
  std::vector<std::pair<std::size_t, std::size_t>> joined_;
};

}  // namespace carus::observe
