// SPDX-License-Identifier: Apache-2.0
#include "carus/verify/models.hpp"

#include <Eigen/LU>
#include <algorithm>
#include <cmath>

#include "carus/fem/element_block.hpp"

namespace carus::verify {

material::Material soft(material::Law law, double shear_modulus, double poisson, double density) {
  material::Material m;
  m.law = law, m.poisson = poisson, m.density = density;
  m.youngs_modulus = 2 * shear_modulus * (1 + poisson);
  m.c10 = 0.5 * shear_modulus;
  if (law == material::Law::mooney_rivlin) m.c10 = shear_modulus / 3, m.c01 = shear_modulus / 6;
  return m;
}

fem::Model of(mesh::TetMesh mesh, std::vector<material::Material> materials) {
  fem::Model model;
  model.mesh = std::move(mesh);
  model.blocked.assign(model.mesh.nodes.size(), fem::none);
  for (std::size_t i = 0; i < materials.size(); ++i) {
    fem::Region region;
    region.name = region.organ = "part" + std::to_string(i);
    region.material = materials[i];
    model.regions.push_back(std::move(region));
  }
  return model;
}

void block(fem::Model& model, std::uint8_t bits, const std::function<bool(const Vec3& X)>& where) {
  for (std::size_t i = 0; i < model.mesh.nodes.size(); ++i) {
    if (where(model.mesh.nodes[i])) model.blocked[i] = std::uint8_t(model.blocked[i] | bits);
  }
}

mesh::Triangles facets(const mesh::TetMesh& mesh, const std::function<bool(const Vec3& X)>& where) {
  mesh::Triangles out;
  for (const auto& t : mesh::boundary(mesh)) {
    if (std::all_of(t.begin(), t.end(), [&](auto n) { return where(mesh.nodes[n]); })) out.push_back(t);
  }
  return out;
}

fem::ContactSurface skin(const mesh::TetMesh& mesh, std::string name, std::int32_t label) {
  return {std::move(name), mesh::boundary(mesh, [label](std::int32_t l) { return l == label; })};
}

solve::ExplicitOptions real_time(double duration, double time_step, double drag) {
  solve::ExplicitOptions o;
  o.labour_duration = o.pseudo_duration = duration;
  o.time_step = time_step, o.drag = drag;
  o.max_node_speed = 1e3;
  o.threads = 1;
  return o;
}

void set(solve::Explicit& solver, const std::function<void(fem::State&)>& change) {
  fem::State state = solver.state();
  change(state);
  solver.restore(state);
}

Mat3 deformation_gradient(const mesh::TetMesh& mesh, std::size_t tet, const std::vector<Vec3>& x) {
  Mat3 D;
  for (int a = 0; a < 3; ++a) D.col(a) = x[mesh.tets[tet][a + 1]] - x[mesh.tets[tet][0]];
  return D * fem::inverse_edges(mesh, tet);
}

Mat3 neo_hooke_stress(const fem::Model& model, std::size_t tet, const std::vector<Vec3>& x) {
  const auto& m = model.regions[model.mesh.labels[tet]].material;
  const Mat3 F = deformation_gradient(model.mesh, tet, x);
  const double J = F.determinant();
  const Mat3 B = std::pow(J, -2.0 / 3.0) * F * F.transpose();
  // sigma = 2 C10/J dev(B) + K (J - 1) I
  return 2 * m.c10 / J * (B - B.trace() / 3 * Mat3::Identity()) +
         0.5 * m.bulk_modulus() * (J - 1 / J) * Mat3::Identity();
}

double wave_speed(const material::Material& m) {
  return std::sqrt((m.bulk_modulus() + 4.0 / 3.0 * m.shear_modulus()) / m.density);
}

Mat3 skew_rotation(double angle) { return Eigen::AngleAxisd(angle, Vec3(1, -2, 0.7).normalized()).toRotationMatrix(); }

}  // namespace carus::verify
