// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "carus/report/frame_file.hpp"
#include "carus/scenario/scenario.hpp"

namespace carus::report {

/// A scalar that the viewer colours by. Stored in steps of `quantum` from `offset`.
struct FieldKind {
  std::string name, label, unit;
  double offset, quantum;
  double low, high;  ///< ends of the colour scale, the same for every run
};

/// Per-node fields of a run's frames, each from what a frame holds.
///
/// - stretch: largest principal stretch, the mean of the tets round the node, weighted by rest volume;
/// - pressure: -dU/dJ [kPa], the same mean (material/volumetric.hpp); compression is positive;
/// - contact_pressure: -f.n / A [kPa], f the contact force on the node, n and A the current normal and a third of the
///   area of its surface facets; 0 where it pulls.
///
/// `materials` by region, "bone" for bones; without them there is no pressure.
class Fields {
 public:
  Fields(const FrameMesh& mesh, std::optional<std::map<std::string, material::Material>> materials);

  [[nodiscard]] const std::vector<FieldKind>& kinds() const { return kinds_; }
  /// Values of field k at every node. Thread-safe.
  [[nodiscard]] std::vector<float> values(std::size_t k, const FrameState& state) const;

 private:
  [[nodiscard]] std::vector<float> node_means(const std::vector<float>& per_tet) const;
  [[nodiscard]] std::vector<float> contact_pressure(const FrameState& state) const;

  const FrameMesh& mesh_;
  std::vector<FieldKind> kinds_;
  std::vector<float> volume_;       // rest volume of each tet
  std::vector<float> node_volume_;  // of the tets round each node
  std::vector<float> bulk_;         // per tet [Pa]
  mesh::Triangles surface_;
};

}  // namespace carus::report
