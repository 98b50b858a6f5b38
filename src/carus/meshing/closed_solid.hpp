// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <string>

#include "carus/mesh/surface.hpp"

namespace carus::meshing {

/// A closed surface as a solid: what is inside, and how far the surface is. Thread-safe.
class ClosedSolid {
 public:
  /// surface: closed and outward oriented (mesh::closed).
  explicit ClosedSolid(const mesh::Surface& surface);
  ~ClosedSolid();
  ClosedSolid(ClosedSolid&&) noexcept;
  ClosedSolid& operator=(ClosedSolid&&) noexcept;
  [[nodiscard]] bool contains(const Vec3& x) const;    ///< exact; O(log n), a microsecond
  [[nodiscard]] double distance(const Vec3& x) const;  ///< signed, negative inside [m]; O(log n), ten microseconds
  [[nodiscard]] Vec3 nearest(const Vec3& x) const;     ///< point of the surface

 private:
  struct Search;
  std::unique_ptr<Search> search_;
};

/// Pairs of triangles of a surface that cut through each other, by their numbers. O(n log n).
std::vector<std::pair<std::int32_t, std::int32_t>> self_intersections(const mesh::Surface& surface);

/// Throws InputError with count and place if triangles of the surface cut through each other: then which side is inside
/// cannot be told. `name` begins the message. O(n log n).
void require_no_self_intersection(const mesh::Surface& surface, const std::string& name);

}  // namespace carus::meshing
