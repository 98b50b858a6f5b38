// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <array>
#include <cstdint>
#include <string>
#include <vector>

#include "carus/contact/triangle_grid.hpp"
#include "carus/mesh/tet_mesh.hpp"

namespace carus::contact {

/// One side of a contact: facets with their own list of vertices, normals and neighbours.
struct Surface {
  std::string name;
  mesh::Triangles triangles;                       ///< node indices, outward oriented
  std::vector<std::int32_t> nodes;                 ///< sorted unique nodes
  std::vector<std::array<std::int32_t, 3>> local;  ///< triangles in local vertex indices
  std::vector<std::int32_t> around_begin, around;  ///< local vertex -> incident triangles (CSR)
  std::vector<std::uint8_t> on_border;             ///< local vertex lies on an open edge
  /// Unit, kept up to date by Contact. Per local vertex the mean of all facets round it; then, for vertices of edges
  /// that are sharp at rest (over 50°), one for each of their sides: the facets between two such edges.
  std::vector<Vec3> normal;
  std::vector<std::array<std::int32_t, 3>> shade;  ///< per triangle and corner: the normal that stands for its side
  std::vector<std::int32_t> side_begin;            ///< local vertex -> its sides, in `normal`; none where smooth
  std::vector<Vec3> facet_normal;                  ///< per triangle, twice the area vector
  std::vector<Vec3> rest_centre;                   ///< per triangle
  std::vector<Vec3> rest_normal;                   ///< as `normal`, at rest

  Surface(std::string name, mesh::Triangles triangles, const std::vector<Vec3>& rest);
  void update_normals(const std::vector<Vec3>& x);
  [[nodiscard]] bool on_crease(std::int32_t vertex) const { return side_begin[vertex] < side_begin[vertex + 1]; }

 private:
  void find_sides();
  [[nodiscard]] std::vector<std::int32_t> take_side(std::vector<std::int32_t>& left) const;
  std::vector<std::int32_t> side_facets_begin_, side_facets_;  // side -> its triangles
};

/// Which surfaces may touch. a == b: self-contact.
struct Pair {
  int a, b;
  double friction;
};

/// A rigid body with one degree of freedom that some nodes belong to.
struct HingeBody {
  Vec3 point, axis;
  double inverse_inertia;  ///< [1/(kg m^2)]
};

struct Options {
  double activation = 1e-4;     ///< [m] a pair enters the solve when its gap is less than that and what may close it
  double reach = 0.010;         ///< [m] distance up to which pairs are looked for at a renewal
  double correction_speed = 1;  ///< [m/s] at most, outward, where penetrated; moves, but leaves no momentum
  double max_depth = 0.004;  ///< [m] a node behind a facet and farther from it belongs elsewhere (a wall's other side)
  double self_exclusion = 0.02;  ///< [m] rest distance below which a wall does not touch its own other side
  double fold_depth = 3e-4;      ///< [m] < max_depth; nearer to itself than that, what lies deeper is a ridge, no fold
  double sagitta_limit = 1e-3;   ///< [m]
  int sweeps = 3;
};

/// Node against facet: v_rel = n.(v_node - sum w_k v_k) >= target. What a step reads of a pair that does not touch lies
/// in the first two lines of the cache.
struct alignas(64) Constraint {
  std::int32_t node;
  std::array<std::int32_t, 3> facet;
  std::array<double, 3> w;
  Vec3 n;
  double gap;      ///< [m] on the smooth gap
  double shift;    ///< [m] gap = n.(x_node - sum w_k x_k) + shift, until the foot is found anew
  double target;   ///< least normal speed [m/s]
  double impulse;  ///< [N s], >= 0
  double mass;     ///< effective mass [kg]
  std::int32_t probe;
  std::int32_t part;  ///< see Contact::parts
  float friction;
  std::int16_t hinge_node, hinge_facet;  ///< -1: none
  std::array<Vec3, 4> response;  ///< velocities that a unit impulse gives to the node and to the facet's corners [1/kg]
  double lever_node, lever_facet;  ///< axis.((p - o) x n) of the hinges
  Vec3 slip;                       ///< tangential impulse [N s]
  double lift;                     ///< impulse [N s] >= 0 that undoes the penetration, forgotten after the step
  Vec3 from_foot;                  ///< x_node - sum w_k x_k when the foot was found
  int looks;                       ///< since then
};

/// Frictionless or Coulomb contact between moving surfaces by impulses: find gaps, then projected Gauss-Seidel on
/// velocities.
///
/// Order of calls in a step: `detect` with the positions at its start, `solve` on the predicted velocities.
/// Deterministic and independent of the number of threads.
/// The inverse mass of a node is D - b b^T: D by axes (`inverse_mass`), b (`inverse_mass_blocked`) takes away a
/// direction in which it cannot move.
class Contact {
 public:
  Contact(std::vector<Surface> surfaces, std::vector<Pair> pairs, const std::vector<Vec3>& rest,
          std::vector<Vec3> inverse_mass, std::vector<Vec3> inverse_mass_blocked,
          std::vector<std::int16_t> hinge_of_node, std::vector<HingeBody> hinges, const Options& options);

  /// Other inverse masses from the next `detect` on, `hinges` by their inverse inertias; of the same lengths as before.
  void weigh(const std::vector<Vec3>& inverse_mass, const std::vector<Vec3>& inverse_mass_blocked,
             const std::vector<double>& hinges);
  /// Finds the active constraints, true if they are others than before: the foot of a node on its facet is looked for
  /// anew only every few steps, between them the gap changes along its normal. `max_speed` bounds every nodal speed in
  /// this step [m/s].
  bool detect(const std::vector<Vec3>& x, double dt, double max_speed);
  /// Changes the velocities (and hinge rates) so that no active pair closes faster than its gap allows.
  void solve(std::vector<Vec3>& v, std::vector<double>& hinge_rate);
  /// After `solve`: velocities that take penetrated pairs apart, added to `lift` [m/s], zero on entry. They are to move
  /// the nodes in this step and to be forgotten: kept, each penetration would leave kinetic energy behind. Hinges stay.
  void part_penetrated(const std::vector<Vec3>& v, std::vector<Vec3>& lift);
  /// To be told how far any node moved at most in this step [m].
  void moved(double distance) { since_look_ += 2 * distance; }

  [[nodiscard]] const std::vector<Constraint>& constraints() const { return constraints_; }
  [[nodiscard]] double least_gap() const;  ///< of the active constraints [m]; +inf without any
  [[nodiscard]] std::int64_t renewals() const { return renewals_; }
  [[nodiscard]] double seconds_renewing() const { return seconds_renewing_; }

  /// Ends a stretch at positions `x`. What follows depends on positions, velocities and what `save` returns alone, so a
  /// checkpoint taken here continues bit for bit.
  void pause(const std::vector<Vec3>& x);
  /// Partners and warm-start impulses per probe, and how far the last renewal is behind; always of the same length.
  [[nodiscard]] std::vector<double> save() const;
  /// As after the `pause` that `saved` is of.
  void load(const double* saved, const std::vector<Vec3>& x);

 private:
  static constexpr int never = 1 << 30;
  /// The sweeps go through as many parts of the constraints side by side, cut across the longest direction so that no
  /// two of them share a node; what lies on the cuts comes after them. Not the number of threads, so that the result
  /// does not depend on it.
  static constexpr int parts = 4;
  struct Pass {
    int nodes, facets;  ///< surfaces
    bool self;
    float friction;
    std::int32_t first, last;  ///< probes
    // How far a node and a facet of the two may have moved against each other, at most [m]:
    double net = 0;     ///< since the stretch began
    double before = 0;  ///< from the renewal to there, a sum over stretches
    double travel = 0;  ///< a sum over the looks since the stretch began
  };
  /// One node looking at one surface.
  struct Probe {
    std::int32_t node, vertex;  ///< global node, local vertex of its own surface
    std::int32_t triangle = -1;
    std::int32_t pass;
    std::int32_t constraint = -1;  ///< the one of the last look, if its foot may serve again
    double impulse = 0;
    double sleeps_until = 0;  ///< travel of both its surfaces before which it cannot touch; less all the time: awake
  };
  /// The displacements of some nodes over some time: their box, and the square of the longest [m^2].
  struct Spread {
    Vec3 least = Vec3::Zero(), most = Vec3::Zero();
    double longest2 = 0;
    Spread() = default;
    explicit Spread(const Vec3& u) : least(u), most(u), longest2(u.squaredNorm()) {}
    void add(const Vec3& u) {
      least = least.cwiseMin(u), most = most.cwiseMax(u);
      longest2 = std::max(longest2, u.squaredNorm());
    }
  };
  /// What one surface did: positions when the stretch began and at the last look, displacements from there.
  struct Motion {
    std::vector<Vec3> at_start, at_look;
    Spread from_start, from_look;
  };

  /// Nearest point of a facet.
  struct Foot {
    Vec3 w, point;   ///< weights of the corners, position
    double squared;  ///< distance [m^2]
  };

  void renew(const std::vector<Vec3>& x);
  void begin_stretch(const std::vector<Vec3>& x);
  void measure_motion(const std::vector<Vec3>& x);
  [[nodiscard]] static double relative_motion(const Spread& a, const Spread& b);
  [[nodiscard]] double relative_motion_since_look(const std::vector<Vec3>& x);
  [[nodiscard]] bool worn_out() const;
  void look(const std::vector<Vec3>& x);
  void constrain_all(const std::vector<Vec3>& x);
  void constrain_chunk(std::size_t begin, std::size_t end, const std::vector<Vec3>& x, std::vector<Constraint>& out);
  void gather_parts(const std::vector<Vec3>& x);
  void refresh(const std::vector<Vec3>& x);
  void keep_impulses();
  void cut(const std::vector<Vec3>& x, std::size_t chunks);
  [[nodiscard]] int part_of(const Constraint& c, const std::vector<Vec3>& x) const;
  [[nodiscard]] double target(double gap) const;
  void update_normals(const std::vector<Vec3>& x);
  void renew_probe(Probe& probe, const std::vector<Vec3>& x) const;
  Foot follow(Probe& probe, const std::vector<Vec3>& x) const;
  [[nodiscard]] bool near_itself(const Probe& probe, std::int32_t triangle) const;
  bool through_the_wall(const Surface& wall, const Probe& probe, std::int32_t triangle) const;
  [[nodiscard]] double deepest(const Probe& probe, std::int32_t triangle) const;
  bool admissible(const Probe& probe, std::int32_t triangle) const;
  [[nodiscard]] int side_of_edge(const Probe& probe, const Vec3& w, const Vec3& d, const std::vector<Vec3>& x) const;
  bool constrain(Probe& probe, const std::vector<Vec3>& x, Constraint& c, double& clearance) const;
  bool foot_serves(Constraint& c, const std::vector<Vec3>& x) const;
  Vec3 update_gap(Constraint& c, const std::vector<Vec3>& x) const;
  [[nodiscard]] Vec3 response(std::int32_t node, const Vec3& impulse) const {
    const Vec3& b = inverse_mass_blocked_[node];
    return inverse_mass_[node].cwiseProduct(impulse) - b.dot(impulse) * b;
  }
  void finish(Constraint& c, const std::vector<Vec3>& x) const;
  void push(const Constraint& c, double impulse, std::vector<Vec3>& v, std::vector<double>& rate) const;
  void shear(const Constraint& c, const Vec3& impulse, std::vector<Vec3>& v) const;
  double relax(Constraint& c, std::vector<Vec3>& v, std::vector<double>& rate) const;
  void rub(Constraint& c, std::vector<Vec3>& v) const;
  void sweep(int part, int number, std::vector<Vec3>& v, std::vector<double>& rate);
  void raise(Constraint& c, const std::vector<Vec3>& v, std::vector<Vec3>& lift) const;
  void raise_part(int part, int number, const std::vector<Vec3>& v, std::vector<Vec3>& lift);

  std::vector<Surface> surfaces_;
  std::vector<Pair> pairs_;
  std::vector<Vec3> rest_, inverse_mass_, inverse_mass_blocked_;
  std::vector<std::int16_t> hinge_of_node_;
  std::vector<HingeBody> hinges_;
  Options options_;
  std::vector<Pass> passes_;
  std::vector<Probe> probes_;
  std::vector<std::uint8_t> moves_;  ///< per surface: some node of it can
  std::vector<TriangleGrid> grids_;  ///< per surface
  std::vector<Motion> motion_;       ///< per surface
  std::vector<std::int32_t> near_;   ///< probes with a partner, in rising order
  std::vector<std::vector<Constraint>> chunk_constraints_;
  std::vector<Constraint> constraints_;  ///< by parts, within them by probes
  std::array<std::size_t, parts + 2> part_begin_{};
  std::array<std::vector<std::int32_t>, parts + 1> live_;  ///< those that the first sweep left close to touching
  int cut_axis_ = 0;
  std::vector<double> along_cut_;         ///< scratch
  std::array<double, parts - 1> cuts_{};  ///< [m] along the axis
  double dt_ = 0, closing_ = 0;           ///< [s], [m]: what two nodes may near each other by in a step
  bool look_due_ = true;
  double since_look_ = 0;  ///< [m] that any two surfaces may have moved against each other since the last look
  double needed_ = 0;      ///< [m] gap below which a pair must be in the solve of this step
  double held_below_ = 0;  ///< [m] gap below which the last look left constraints
  int steps_since_normals_ = never;
  int steps_since_renewal_ = never;
  std::int64_t renewals_ = 0;
  double seconds_renewing_ = 0;
};

}  // namespace carus::contact
