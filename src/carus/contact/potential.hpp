// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>
#include <limits>
#include <string>
#include <vector>

#include "carus/contact/barrier.hpp"
#include "carus/contact/broad_phase.hpp"
#include "carus/contact/distance.hpp"

namespace carus::contact {

/// One side of a contact.
struct Side {
  std::string name;
  mesh::Triangles triangles;
};
/// Which sides may touch. a == b: self-contact.
struct Touching {
  int a, b;
  double friction = 0;
};

/// Contact of moving surfaces as an energy that keeps them apart (incremental potential contact, Li et al. 2020):
///
///     B(x) = sum w_k m_k(x) b(d_k(x))  over point-triangle and edge-edge pairs k nearer than the barrier's reach,
///
/// b the barrier, m the mollifier of parallel edges, w a share of the area at rest, so that a finer mesh feels the same
/// pressure. Friction is lagged: normal forces and directions are those at the start of a step.
/// Results do not depend on the number of threads.
class BarrierPotential {
 public:
  /// `moves` per node: pairs of which no node moves are left out.
  BarrierPotential(std::vector<Side> sides, std::vector<Touching> pairs, const std::vector<Vec3>& rest,
                   std::vector<std::uint8_t> moves, Barrier barrier);

  [[nodiscard]] bool any() const { return !pairs_.empty(); }

  /// B(x) [J].
  double energy(const std::vector<Vec3>& x);
  /// g += dB/dx [N].
  void add_gradient(const std::vector<Vec3>& x, std::vector<Vec3>& g);
  /// Prepares products with the positive part b'' grad d grad d^T of the Hessian, and that of friction.
  void linearise(const std::vector<Vec3>& x);
  void add_product(const std::vector<Vec3>& u, std::vector<Vec3>& y) const;
  void add_diagonal(std::vector<Mat3>& d) const;

  /// Begins a step at x0: takes the normal forces for friction; `full_slip` [m]: slip in this step above which friction
  /// is full.
  void begin_step(const std::vector<Vec3>& x0, double full_slip);
  double friction_energy(const std::vector<Vec3>& x) const;
  void add_friction_gradient(const std::vector<Vec3>& x, std::vector<Vec3>& g) const;

  /// Share of the way p that may be gone from x without any pair touching.
  double conservative_step(const std::vector<Vec3>& x, const std::vector<Vec3>& p);

  struct Nearest {
    double distance = std::numeric_limits<double>::infinity();  ///< [m]; infinite: none within what was looked at
    int pair = -1;
    std::array<std::int32_t, 4> nodes{};
    bool edges = false;
  };
  /// Of each pair of sides, within `reach` [m] of each other.
  std::vector<Nearest> nearest(const std::vector<Vec3>& x, double reach);
  [[nodiscard]] const std::vector<Side>& sides() const { return sides_; }
  [[nodiscard]] const std::vector<Touching>& pairs() const { return pairs_; }
  [[nodiscard]] std::size_t active() const { return linear_.size(); }
  [[nodiscard]] std::size_t candidates() const { return candidates_.size(); }
  [[nodiscard]] std::int64_t searches() const { return searches_; }

 private:
  struct Stencil {
    std::array<std::int32_t, 4> nodes;
    bool edges;
    std::int16_t pair;
    double weight;     ///< [m^2]
    double threshold;  ///< of the mollifier [m^4]
  };
  struct Linear {  // of an active stencil: H = k (c n)(c n)^T
    std::array<std::int32_t, 4> nodes;
    Coefficients c;
    Vec3 n;
    double k;
  };
  struct Sliding {
    std::array<std::int32_t, 4> nodes;
    Coefficients c;
    Vec3 n;
    double force;  ///< mu times the normal force [N]
    double k = 0;  ///< of the linearisation
  };

  void search(const std::vector<Vec3>& x, double slack);
  void collect(const std::vector<Vec3>& x, const std::vector<Vec3>& y, double reach, std::vector<Stencil>& out);
  void ready(const std::vector<Vec3>& x, double distance);
  void search_pair(int pair, const std::vector<Vec3>& x, const std::vector<Vec3>& y, double reach,
                   std::vector<Stencil>& all);
  static Corners corners(const Stencil& s, const std::vector<Vec3>& x) {
    return {x[s.nodes[0]], x[s.nodes[1]], x[s.nodes[2]], x[s.nodes[3]]};
  }
  template <class F>
  void for_active(const std::vector<Vec3>& x, F&& f);
  [[nodiscard]] Vec3 slip(const Sliding& s, const std::vector<Vec3>& u) const;

  struct Own {                                      // of a side: what each triangle brings in
    std::vector<std::array<bool, 3>> vertex, edge;  ///< edge k: corners k, k + 1
    std::vector<std::array<double, 3>> vertex_area, edge_area;
  };
  std::vector<Side> sides_;
  std::vector<Touching> pairs_;
  std::vector<Vec3> rest_;
  std::vector<std::uint8_t> moves_;
  Barrier barrier_;
  std::vector<Own> own_;
  std::vector<TriangleTree> trees_;
  std::vector<Stencil> candidates_;          ///< near each other at the last search
  std::vector<Stencil> swept_;               ///< whose ways met, in the last collision detection that needed its own
  std::vector<std::vector<Stencil>> found_;  // per chunk
  std::vector<Vec3> searched_at_;
  double searched_reach_ = -1;
  std::int64_t searches_ = 0;
  std::vector<Linear> linear_;
  std::vector<std::vector<Linear>> chunk_linear_;
  std::vector<Sliding> sliding_;
  std::vector<Vec3> step_start_;
  SmoothSlip friction_{1};
};

}  // namespace carus::contact
