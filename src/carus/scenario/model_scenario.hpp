// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <string>
#include <vector>

#include "carus/core/types.hpp"
#include "carus/material/material.hpp"

namespace carus::scenario {

/// What a scenario file describes, by its key `kind`. Throws InputError if the file cannot be read or names neither.
enum class Kind { birth, model };
Kind kind_of(const std::filesystem::path& file, const std::vector<std::string>& overrides = {});

/// A general model as its file states it, all in SI: keys, units, bounds and defaults are those of
/// schema/model.schema.json (docs/reference/model.md). Empty lists of coordinates are `bounded == false` boxes or zero.
struct ModelScenario {
  enum class Shape { file, box, ball, tube };
  enum class Analysis { dynamic, quasi_static, static_equilibrium };
  struct Box {
    Vec3 low, high;  ///< infinite where not given
  };
  struct Mesh {
    Shape shape = Shape::file;
    std::string file;  ///< absolute
    double unit = 1;   ///< [m] of one unit of the file
    std::string region;
    Vec3 low, size;
    std::vector<int> cells;
    double radius = 0, inner_radius = 0, height = 0;
  };
  struct Region {
    std::string name;
    bool rigid = false;
    material::Material material;
  };
  struct NodeSet {
    std::string name, nodes;
    Box box;
  };
  struct Surface {
    std::string name, region;
    Box box;
  };
  struct Fixed {
    std::string nodes;
    std::uint8_t axes;  ///< fem::Blocked bits
  };
  struct Motion {
    std::string name, nodes;
    std::uint8_t axes;
    Vec3 displacement, point, axis;  ///< axis: unit
    double angle = 0;                ///< [rad]
    std::function<double(double)> curve;
  };
  struct InitialVelocity {
    std::string nodes;
    Vec3 velocity;
  };
  struct Pressure {
    std::string name, surface;
    double pressure = 0;
    bool directed = false;
    Vec3 direction;  ///< unit
    std::function<double(double)> curve;
  };
  struct BodyForce {
    std::string name, region;
    Vec3 acceleration;
    std::function<double(double)> curve;
  };
  struct Tie {
    std::string nodes, surface;
    double tolerance = 0;
  };
  struct ContactPair {
    std::string a, b;
    double friction = 0;
  };

  std::string file, name, description;
  std::vector<Mesh> meshes;
  std::vector<Region> regions;
  std::vector<NodeSet> node_sets;
  std::vector<Surface> surfaces;
  std::vector<Fixed> fixed;
  std::vector<Motion> motions;
  std::vector<InitialVelocity> initial_velocities;
  std::vector<Pressure> pressures;
  std::vector<BodyForce> body_forces;
  std::vector<Tie> ties;
  std::vector<ContactPair> contact_pairs;
  double contact_search = 0, contact_correction = 0;
  int contact_sweeps = 0;
  double barrier_distance = 0, barrier_pressure = 0, newton_tolerance = 0;
  bool implicit = false;
  Analysis analysis = Analysis::dynamic;
  double duration = 0, time_scaling = 1, time_step = 0, safety = 0, drag = 0, max_node_speed = 0;
  int threads = 0;
  int frames = 0, rows = 0;
  std::vector<std::string> output_nodes;
  std::string resolved;  ///< every key with its value and unit, as YAML
  std::vector<std::string> warnings;
};

/// The general model of a YAML file, with `path.to.key=value` overrides. Throws carus::InputError with all problems at
/// once.
ModelScenario load_model(const std::filesystem::path& file, const std::vector<std::string>& overrides = {});
/// The same from text; `file` names it in messages and is what its files are relative to.
ModelScenario parse_model(const std::string& yaml, const std::filesystem::path& file,
                          const std::vector<std::string>& overrides = {});

}  // namespace carus::scenario
