// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <map>
#include <string>
#include <vector>

#include "carus/scenario/scenario.hpp"

namespace carus::scenario {

/// Where a body's nodes and tets are in the model: its i-th node is node_begin + i.
struct BodyRange {
  std::int32_t node_begin = 0, node_end = 0;
  std::int32_t tet_begin = 0, tet_end = 0;
};

/// A model with the names by which measurements find their way in it.
struct Assembly {
  fem::Model model;
  std::map<std::string, BodyRange> bodies;                     ///< "fetus", "uterus", "abdomen"
  std::map<std::string, std::vector<std::int32_t>> node_sets;  ///< "body.name" of anatomy::Body::nodes
  std::map<std::string, mesh::Triangles> surfaces;             ///< "body.name" of anatomy::Body::surfaces
  std::map<std::string, std::int32_t> nodes;  ///< "body.landmark": the body's node nearest to it at rest
};

/// Puts the bodies of an anatomy into one model with the scenario's materials, attachments, loads, contacts and
/// retraction.
///
///     fetus    skull, fetal_body, neck, fetal_skin      all free
///     uterus   fundus ... canal                         canal blocked along z, lower uterus tied by springs; loads;
///     retraction abdomen  tissue, innominates, sacrum, coccyx      bones rigid and fixed but for the coccyx; back and
///     thighs fixed
///
/// Throws carus::InputError naming everything that the anatomy lacks. Linear in the size of the meshes.
Assembly assemble(const Scenario& scenario, const anatomy::Anatomy& anatomy);

/// What can be said against an anatomy before a run, with the numbers: each begins "error: " (refuse) or "warning: ".
/// Distances between bodies are exact, so this costs seconds on fine meshes.
std::vector<std::string> preflight(const Scenario& scenario, const anatomy::Anatomy& anatomy);

}  // namespace carus::scenario
