// SPDX-License-Identifier: Apache-2.0
#include "carus/meshing/quality_report.hpp"

#include <algorithm>

namespace carus::meshing {

std::map<std::int32_t, LabelQuality> quality_report(const mesh::TetMesh& mesh) {
  std::map<std::int32_t, LabelQuality> report;
  for (std::size_t e = 0; e < mesh.tets.size(); ++e) {
    auto& r = report[mesh.labels[e]];
    const auto q = mesh::quality(mesh, e);
    ++r.tets;
    r.volume += mesh::volume(mesh, e);
    r.min_dihedral_deg = std::min(r.min_dihedral_deg, q.min_dihedral_deg);
    r.max_dihedral_deg = std::max(r.max_dihedral_deg, q.max_dihedral_deg);
    r.min_altitude = std::min(r.min_altitude, q.min_altitude);
    r.mean_altitude += q.min_altitude;
    r.max_aspect = std::max(r.max_aspect, q.aspect);
  }
  for (auto& [label, r] : report) r.mean_altitude /= static_cast<double>(r.tets);
  return report;
}

}  // namespace carus::meshing
