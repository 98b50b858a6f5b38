// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <utility>
#include <vector>

#include "carus/fem/model.hpp"
#include "carus/mesh/named_mesh.hpp"
#include "carus/scenario/model_scenario.hpp"

namespace carus::general {

/// A general model ready for a solver.
struct GeneralModel {
  fem::Model model;
  std::vector<Vec3> initial_velocity;     ///< per node [m/s], or empty
  std::vector<mesh::NamedNodes> watched;  ///< node sets whose means and sums become columns
  std::vector<std::string> notes;         ///< e.g. how many nodes a tie glued
};

/// All meshes of a scenario, made or read, side by side in SI. Throws InputError with every problem of every file.
mesh::NamedMesh gather_meshes(const scenario::ModelScenario& scenario);

/// The model of a scenario on its meshes: materials by region, sets, constraints, loads, ties, contact. Throws
/// InputError with all problems at once: unknown or empty sets, silent regions, nodes constrained twice, inverted tets.
GeneralModel build(const scenario::ModelScenario& scenario, mesh::NamedMesh meshes);

}  // namespace carus::general
