// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <map>
#include <string>
#include <vector>

#include "carus/anatomy/anatomy.hpp"
#include "carus/fem/model.hpp"
#include "carus/labour/labour.hpp"
#include "carus/material/material.hpp"
#include "carus/solve/implicit.hpp"

namespace carus::scenario {

struct Calibration {
  std::string key, to;
};

enum class Resolution { coarse, paper, fine };
enum class CoccyxModel { hinge, elastic, fixed };
enum class SolverKind { explicit_dynamics, implicit_dynamics };

/// Loads with the uterine surfaces that they act on ("contraction", "push", "tone").
struct Loads {
  labour::Contractions contractions;
  labour::Push push;
  labour::ResidualTone residual_tone;
  std::string contractions_region, push_region, residual_tone_region;
};
struct Retraction {
  bool enabled = true;
  fem::Retraction::Kind kind = fem::Retraction::Kind::ratchet;
  double tau = 0;                     ///< [s of labour]
  double isometric_strain = 0;        ///< elastic strain at which the active muscle only holds (ratchet)
  double floor = 0;                   ///< least rest length of the ratchet, of the length at the start
  double ring_width = 0;              ///< [m]
  double final = 0;                   ///< rest length at the end of the labour (imposed)
  double lower_segment_strength = 0;  ///< 0..1
};
struct Contact {
  double friction = 0;
  double search = 0;            ///< [m]
  double correction_speed = 0;  ///< [m/s of pseudo-time]
  int sweeps = 0;
};
struct Coccyx {
  CoccyxModel model = CoccyxModel::hinge;
  double stiffness = 0;  ///< [N m/rad]
  double damping = 0;    ///< [N m s/rad], in labour time
};
struct Attachments {
  double tie_axial = 0, tie_transverse = 0;   ///< [N/m], totals over all tied nodes
  double bed_posterior = 0, bed_lateral = 0;  ///< [Pa/m], of the canal's outer face
  double bed_depth = 0;                       ///< [m], where the canal is wide
  bool canal_blocked = true;
};
/// Of the implicit solver: the keys of `solver.implicit`.
struct Implicit {
  double time_step = 0, least_time_step = 0;        ///< [s of labour]
  double step_tolerance = 0, newton_tolerance = 0;  ///< [m]
  int max_iterations = 0;
  double linear_tolerance = 0;
  double barrier_distance = 0;  ///< [m]
  double barrier_pressure = 0;  ///< [Pa]
  double friction_speed = 0;    ///< [m/s]
};
struct Numerics {
  double labour_duration = 0;   ///< [s]
  double pseudo_duration = 0;   ///< [s]
  double time_step = 0;         ///< [s of pseudo-time]
  double safety = 0, drag = 0;  ///< -, [1/s of labour]
  double max_node_speed = 0;    ///< [m/s of pseudo-time]
  double pace_kinetic_ratio = 0, pace_slowest = 1, pace_fastest = 1;
  double pseudo_time_factor = 1, drag_factor = 1, mesh_factor = 1;
  int threads = 0;
};
struct Output {
  int frames = 0;
  double curve_interval = 0;  ///< [s of labour]
  bool run_after_birth = true;
};

/// One birth, all in SI. Its keys, units, bounds and defaults are those of schema/scenario.schema.json
/// (docs/reference/scenario.md).
struct Scenario {
  std::string file;  ///< where it came from, for messages
  std::string name, description;
  Resolution resolution = Resolution::paper;
  std::vector<Calibration> calibrated;
  std::string anatomy_from;     ///< folder of ready meshes; empty: mesh `anatomy`
  anatomy::Parameters anatomy;  ///< its mesh sizes follow from `resolution` and `numerics.mesh_factor`
  std::map<std::string, material::Material> materials;  ///< by region; "bone" for all bones
  Loads loads;
  Retraction retraction;
  Contact contact;
  Coccyx coccyx;
  Attachments attachments;
  SolverKind solver = SolverKind::explicit_dynamics;
  Implicit implicit;
  Numerics numerics;
  Output output;
  std::vector<std::string> warnings;  ///< values outside the range that their source covers
};

/// The scenario of a YAML file, with `path.to.key=value` overrides applied before validation and every silent key at
/// its default. Throws carus::InputError with all problems of the file, of those it extends and of the overrides at
/// once.
Scenario load(const std::filesystem::path& file, const std::vector<std::string>& overrides = {});

/// The same from text; `file` names it in messages and is what `extends` is relative to.
Scenario parse(const std::string& yaml, const std::filesystem::path& file,
               const std::vector<std::string>& overrides = {});

/// Every key of the schema with its value and unit; parses back to exactly the same scenario.
std::string resolved_yaml(const Scenario& scenario);

/// The keys that the meshes depend on, each with its value as resolved_yaml writes it.
std::map<std::string, std::string> anatomy_settings(const Scenario& scenario);

/// Options of the explicit solver, with the multipliers of drag and pseudo-time applied.
solve::ExplicitOptions explicit_options(const Scenario& scenario);
/// Options of the implicit solver; drag and its multiplier are the explicit one's.
solve::ImplicitOptions implicit_options(const Scenario& scenario);

const char* name_of(Resolution resolution);

}  // namespace carus::scenario
