// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "carus/fem/model.hpp"
#include "carus/mesh/shapes.hpp"
#include "carus/solve/explicit.hpp"

/// Models and solver settings that verification and tests share.
namespace carus::verify {

/// A law with the given shear modulus [Pa] and Poisson's ratio; Mooney-Rivlin takes a third of it from c01.
material::Material soft(material::Law law, double shear_modulus, double poisson, double density = 1000);

/// One region per label "part0", "part1", ...; nothing blocked.
fem::Model of(mesh::TetMesh mesh, std::vector<material::Material> materials);

/// Blocks the axes `bits` of the nodes whose rest position `where` selects.
void block(fem::Model& model, std::uint8_t bits, const std::function<bool(const Vec3& X)>& where);

/// Boundary facets whose three corners `where` selects.
mesh::Triangles facets(const mesh::TetMesh& mesh, const std::function<bool(const Vec3& X)>& where);

/// Surface of one label, as a contact surface.
fem::ContactSurface skin(const mesh::TetMesh& mesh, std::string name, std::int32_t label);

/// Real time (time scale 1), no drag unless given [1/s].
solve::ExplicitOptions real_time(double duration, double time_step, double drag = 0);

/// Sets positions or velocities of a solver at rest.
void set(solve::Explicit& solver, const std::function<void(fem::State&)>& change);

/// Deformation gradient of a tet at the positions x.
Mat3 deformation_gradient(const mesh::TetMesh& mesh, std::size_t tet, const std::vector<Vec3>& x);

/// Cauchy stress of a tet, neo-Hooke only [Pa].
Mat3 neo_hooke_stress(const fem::Model& model, std::size_t tet, const std::vector<Vec3>& x);

/// Speed of longitudinal waves sqrt((K + 4/3 G)/rho) [m/s].
double wave_speed(const material::Material& m);

/// A rotation by `angle` round a fixed skew axis, so that no coordinate plane helps.
Mat3 skew_rotation(double angle);

}  // namespace carus::verify
