// SPDX-License-Identifier: Apache-2.0
#include "carus/verify/contact_scenes.hpp"

#include <algorithm>

namespace carus::verify {

fem::ContactSurface flat_face(const mesh::TetMesh& mesh, const char* name, int label, double z) {
  fem::ContactSurface s{name, {}};
  for (const auto& t : mesh::boundary(mesh, [label](int l) { return l == label; })) {
    if (std::all_of(t.begin(), t.end(), [&](auto n) { return on(mesh.nodes[n].z(), z); })) s.triangles.push_back(t);
  }
  return s;
}

fem::PressureLoad press(const mesh::TetMesh& mesh, double z, double pressure, double ramp) {
  fem::PressureLoad load;
  load.surface = facets(mesh, [z](const Vec3& X) { return on(X.z(), z); });
  load.pressure = [=](double t) { return pressure * std::min(1.0, t / ramp); };
  return load;
}

Vec3 force_on(const fem::Model& m, const solve::Observables& o, int label) {
  std::vector<bool> in(m.mesh.nodes.size(), false);
  for (std::size_t e = 0; e < m.mesh.tets.size(); ++e) {
    if (m.mesh.labels[e] != label) continue;
    for (const auto n : m.mesh.tets[e]) in[std::size_t(n)] = true;
  }
  Vec3 sum = Vec3::Zero();
  for (std::size_t i = 0; i < in.size(); ++i) {
    if (in[i]) sum += o.contact_force[i];
  }
  return sum;
}

}  // namespace carus::verify
