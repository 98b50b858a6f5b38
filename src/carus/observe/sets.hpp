// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include "carus/fem/model.hpp"

namespace carus::observe {

using Nodes = std::vector<std::int32_t>;

/// Indices of the tets whose region is one of `names`; of all their nodes, sorted.
std::vector<std::int32_t> tets_of(const fem::Model& model, const std::vector<std::string>& names);
Nodes nodes_of(const fem::Model& model, const std::vector<std::int32_t>& tets);

Vec3 centroid(const std::vector<Vec3>& x, const Nodes& nodes);
/// Largest minus smallest coordinate along a unit direction [m]: what a calliper reads.
double extent(const std::vector<Vec3>& x, const Nodes& nodes, const Vec3& direction);
/// Smallest and largest signed distance from a plane [m].
double least_height(const std::vector<Vec3>& x, const Nodes& nodes, const Vec3& origin, const Vec3& normal);
double most_height(const std::vector<Vec3>& x, const Nodes& nodes, const Vec3& origin, const Vec3& normal);

/// A closed line round an opening, from nodes near its rim: the mean of those in each of `sectors` sectors round `axis`
/// at rest.
class Ring {
 public:
  Ring(const std::vector<Vec3>& rest, const Nodes& nodes, const Vec3& axis, int sectors = 24);
  [[nodiscard]] bool valid() const { return sectors_.size() >= 3; }
  [[nodiscard]] double perimeter(const std::vector<Vec3>& x) const;  ///< [m]

 private:
  std::vector<Nodes> sectors_;
};

/// The surface nodes of a head with their shares of skin, for contact forces and pressures.
class HeadSkin {
 public:
  /// Facets of `skin` whose nodes all lie nearer to a node of `bone` than to one of `other`, at rest.
  HeadSkin(const std::vector<Vec3>& rest, const mesh::Triangles& skin, const Nodes& bone, const Nodes& other);
  struct Load {
    Vec3 net;              ///< [N] Σf
    double force;          ///< [N] Σ|f|
    double mean_pressure;  ///< [Pa] normal force over the area of the nodes that are in contact
    double max_pressure;   ///< [Pa] largest over patches of a node and its neighbours: single nodes only show the mesh
  };
  [[nodiscard]] Load load(const std::vector<Vec3>& x, const std::vector<Vec3>& force) const;

 private:
  mesh::Triangles facets_;
  Nodes nodes_;
};

}  // namespace carus::observe
