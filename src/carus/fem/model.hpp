// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <functional>
#include <string>
#include <vector>

#include "carus/material/material.hpp"
#include "carus/mesh/tet_mesh.hpp"

namespace carus::fem {

/// Elements of one label: one organ part with one material.
struct Region {
  std::string name;   ///< e.g. "skull"
  std::string organ;  ///< the body it belongs to, e.g. "fetus"
  material::Material material;
  bool rigid = false;   ///< rigid and fixed, or moved by a hinge: its elements carry no stress
  bool fibres = false;  ///< uses Model::fibre
};

enum Blocked : std::uint8_t { none = 0, x = 1, y = 2, z = 4, all = 7 };

/// A rigid body that turns about an axis against a rotational spring and damper.
struct Hinge {
  std::string name;
  std::vector<std::int32_t> nodes;
  Vec3 point, axis;  ///< axis: unit
  double stiffness;  ///< [N m/rad]
  double damping;    ///< [N m s/rad], in labour time
  double inertia;    ///< [kg m^2]
};

/// A spring that holds a node to its rest position along a direction, e.g. a ligament: force = -k d (d.(x - X)).
struct Tether {
  std::int32_t node;
  Vec3 direction;    ///< unit
  double stiffness;  ///< [N/m]
};

/// A pressure on a surface, by labour time.
struct PressureLoad {
  std::string name;
  mesh::Triangles surface;                   ///< outward oriented
  std::function<double(double t)> pressure;  ///< [Pa], t in s of labour
  bool directed = false;                     ///< false: follower -p n; true: only its part along `direction`
  Vec3 direction = Vec3::Zero();             ///< unit, where the push goes
};

/// Places imposed on nodes by time: X goes to point + R(angle) (X - point) + displacement, on the axes named. All axes
/// of all nodes of a rigid region make it a rigid body that is moved.
struct Motion {
  std::string name;
  std::vector<std::int32_t> nodes;
  std::uint8_t axes = Blocked::all;            ///< Blocked bits: the components that are imposed
  std::function<Vec3(double t)> displacement;  ///< [m], t in s of labour; empty: none
  std::function<double(double t)> angle;       ///< [rad] about `axis` through `point`; empty: none
  Vec3 point = Vec3::Zero(), axis = Vec3::UnitZ();
};

/// A force per mass, e.g. gravity, on some regions.
struct BodyForce {
  std::string name;
  std::vector<std::int32_t> regions;           ///< empty: all
  std::function<Vec3(double t)> acceleration;  ///< [m/s^2], t in s of labour
};

/// A node glued to a facet, x = sum w_k x_k; it lies there at rest. The facet's nodes are glued to nothing themselves.
struct Tie {
  std::int32_t node;
  mesh::Triangle facet;
  Vec3 weights;  ///< >= 0, sum 1
};

/// One surface that can touch others; nodes and facets of one body.
struct ContactSurface {
  std::string name;
  mesh::Triangles triangles;  ///< outward oriented
};
struct ContactPair {
  int a, b;             ///< indices of surfaces; a == b: self-contact
  double friction = 0;  ///< Coulomb coefficient
};

/// Active shortening of a muscular wall: F = F_e F_a, det F_a = 1.
struct Retraction {
  enum class Kind { off, imposed, ratchet };
  Kind kind = Kind::off;
  std::vector<std::int32_t> elements;
  std::vector<Vec3> meridian, normal;        ///< per element of `elements`, rest configuration
  std::vector<double> dome;                  ///< per element, 0..1: see anatomy::WallFrame
  std::vector<double> s;                     ///< per element [m]: rings of one rest length
  std::vector<double> strength;              ///< per element, 0..1: how much of the retraction acts here
  double ring_width = 0.02;                  ///< [m] smoothing length of the rest length along s
  double tau = 5;                            ///< [s of labour]
  double isometric_strain = 0;               ///< elastic strain at which the active muscle only holds (ratchet)
  double floor = 0.2;                        ///< least rest length
  std::function<double(double t)> imposed;   ///< rest length by labour time (imposed)
  std::function<double(double t)> activity;  ///< 0..1 by labour time (ratchet acts during contractions)
};

/// Everything a solver needs. Knows nothing of files or births.
struct Model {
  mesh::TetMesh mesh;  ///< all bodies; labels are indices into `regions`
  std::vector<Region> regions;
  std::vector<std::uint8_t> blocked;    ///< per node, Blocked bits
  std::vector<Vec3> blocked_direction;  ///< per node or empty: unit, no motion along it (zero: none)
  std::vector<Vec3> fibre;              ///< per element or empty
  std::vector<Hinge> hinges;
  std::vector<Tether> tethers;
  std::vector<PressureLoad> pressures;
  std::vector<BodyForce> body_forces;
  std::vector<Motion> motions;
  std::vector<Tie> ties;
  std::vector<ContactSurface> contact_surfaces;
  std::vector<ContactPair> contact_pairs;
  Retraction retraction;
};

/// The moving part of a solver. Doubles, one entry per node.
struct State {
  double time = 0;               ///< [s of labour]
  double labour_per_pseudo = 1;  ///< time scaling now: seconds of labour in one of pseudo-time
  std::int64_t step = 0;
  std::vector<Vec3> x;                          ///< current positions [m]
  std::vector<Vec3> v;                          ///< velocities [m/s of pseudo-time]
  std::vector<double> hinge_angle, hinge_rate;  ///< [rad], [rad/s of pseudo-time]
  std::vector<double> rest_length;              ///< retraction, one per ring
  std::vector<double> internal;  ///< warm-start impulses, relaxation history, work sums: solver-private layout
};

}  // namespace carus::fem
