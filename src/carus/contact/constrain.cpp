// SPDX-License-Identifier: Apache-2.0
// From a node and a facet near it to a constraint: foot, normal, gap, responses.
#include <algorithm>
#include <cmath>

#include "carus/contact/contact.hpp"
#include "carus/mesh/closest_point.hpp"

namespace carus::contact {

namespace {

constexpr double foot_holds = 1e-4;  // [m] of relative motion: on a radius of 1 cm the gap errs by 0.5 um
constexpr int foot_lasts = 8;        // looks, so that normals do not grow old
constexpr double touching = 1e-6;    // [m]: nearer than this to an edge, no direction is left
constexpr double cos_folded = 0.5;   // 60 degrees: a fold this sharp is no smooth surface any more

/// Normal of facet t at the foot that lies on corners v of it with weights w; zero if t does not have them all.
Vec3 normal_at(const Surface& s, std::int32_t t, const std::array<std::int32_t, 3>& v, const Vec3& w) {
  Vec3 n = Vec3::Zero();
  for (int k = 0; k < 3; ++k) {
    if (w[k] <= 0) continue;
    const auto corner = std::find(s.local[t].begin(), s.local[t].end(), v[k]) - s.local[t].begin();
    if (corner == 3) return Vec3::Zero();
    n += w[k] * s.normal[std::size_t(s.shade[t][std::size_t(corner)])];
  }
  return n;
}

/// Whether a neighbour may be as near as the facet that has the foot inside: the foot lies no further from one of its
/// edges than twice the node from the facet.
bool close_to_edge(const Vec3& a, const Vec3& b, const Vec3& c, const Vec3& w, double area2, double squared) {
  const double sides[3] = {(c - b).squaredNorm(), (a - c).squaredNorm(), (b - a).squaredNorm()};  // opposite to a, b, c
  const double near2 = 4 * squared / area2;  // altitude_k = 2 area / side_k
  return w[0] * w[0] < near2 * sides[0] || w[1] * w[1] < near2 * sides[1] || w[2] * w[2] < near2 * sides[2];
}

/// Of facet t at its local vertex [rad].
double angle_at(const Surface& s, std::int32_t t, std::int32_t vertex, const std::vector<Vec3>& x) {
  const auto corner = std::find(s.local[t].begin(), s.local[t].end(), vertex) - s.local[t].begin();
  const auto at = [&](std::ptrdiff_t k) -> const Vec3& { return x[s.triangles[t][std::size_t((corner + k) % 3)]]; };
  const Vec3 a = at(1) - at(0), b = at(2) - at(0);
  return std::atan2(a.cross(b).norm(), a.dot(b));
}

}  // namespace

/// Walks over the facets from the last one to the nearest.
Contact::Foot Contact::follow(Probe& probe, const std::vector<Vec3>& x) const {
  const Surface& other = surfaces_[passes_[probe.pass].facets];
  const Vec3& p = x[probe.node];
  const auto foot_on = [&](std::int32_t t) -> Foot {
    const mesh::Triangle& f = other.triangles[t];
    const Vec3 &a = x[f[0]], &b = x[f[1]], &c = x[f[2]];
    const Vec3 w = mesh::closest_point_weights(p, a, b, c), foot = w[0] * a + w[1] * b + w[2] * c;
    return {w, foot, (p - foot).squaredNorm()};
  };
  Foot best = foot_on(probe.triangle);
  for (int hop = 0; hop < 4; ++hop) {
    const std::int32_t here = probe.triangle;
    const mesh::Triangle& f = other.triangles[here];
    const Vec3 w = best.w;
    if (w.minCoeff() > 0 &&
        !close_to_edge(x[f[0]], x[f[1]], x[f[2]], w, other.facet_normal[here].squaredNorm(), best.squared))
      break;
    for (int k = 0; k < 3; ++k) {
      if (w[k] <= 0) continue;  // only round the vertices that carry the foot
      const auto v = std::size_t(other.local[here][k]);
      for (std::int32_t q = other.around_begin[v]; q < other.around_begin[v + 1]; ++q) {
        const std::int32_t t = other.around[std::size_t(q)];
        if (t == here || !admissible(probe, t)) continue;
        const Foot foot = foot_on(t);
        if (foot.squared < best.squared * (1 - 1e-12)) best = foot, probe.triangle = t;
      }
    }
    if (probe.triangle == here) break;
  }
  return best;
}

/// Whether the foot lies on an edge or corner between sides, or on a fold that has become sharper than 60 degrees, and
/// then on which side of the surface the node is: 1 outside, -1 inside, 0 if there is no such edge, or some facet there
/// is no partner and may hide a nearer one. It follows from the sum of the unit normals of the facets that meet in the
/// foot, at a corner weighted by their angles (Baerentzen and Aanaes 2005), and from no smoothed normal: a rim may be
/// squeezed to a blade, a crease be sharper than a right angle, and then what is inside lies before one of its facets,
/// too.
int Contact::side_of_edge(const Probe& probe, const Vec3& w, const Vec3& d, const std::vector<Vec3>& x) const {
  if (w.minCoeff() > 0) return 0;
  const Surface& s = surfaces_[passes_[probe.pass].facets];
  const auto& v = s.local[probe.triangle];
  int carriers = 0;
  std::int32_t carrier = -1;
  bool creased = true;
  for (int k = 0; k < 3; ++k) {
    if (w[k] <= 0) continue;
    creased &= s.on_crease(v[k]);
    carrier = v[k], ++carriers;
  }
  if (carriers == 1 && !creased) return 0;
  const Vec3 facing = s.facet_normal[probe.triangle].normalized();
  const Vec3 own = normal_at(s, probe.triangle, v, w);
  const auto for_each_facet = [&](auto&& f) {
    for (auto q = s.around_begin[carrier]; q < s.around_begin[carrier + 1]; ++q) {
      const auto t = s.around[std::size_t(q)];
      if (const Vec3 n = normal_at(s, t, v, w); !n.isZero(0)) f(t, n);
    }
  };
  bool sides = false;
  Vec3 outward = Vec3::Zero();
  for_each_facet([&](std::int32_t t, const Vec3& n) {
    const Vec3 normal = s.facet_normal[t].normalized();
    sides |= (creased && n != own) || (carriers > 1 && normal.dot(facing) < cos_folded);
    outward += (carriers > 1 ? 1 : angle_at(s, t, carrier, x)) * normal;
  });
  if (!sides) return 0;
  if (outward.dot(d) > 0) return 1;
  bool all_faced = true;
  for_each_facet([&](std::int32_t t, const Vec3&) { all_faced = all_faced && admissible(probe, t); });
  return all_faced ? -1 : 0;
}

/// `clearance`: how far node and facets must move towards each other, at least, before this can become a constraint.
bool Contact::constrain(Probe& probe, const std::vector<Vec3>& x, Constraint& c, double& clearance) const {
  const Pass& pass = passes_[probe.pass];
  const Surface& other = surfaces_[pass.facets];
  const Foot nearest = follow(probe, x);
  const Vec3 &w = nearest.w, &foot = nearest.point;
  const mesh::Triangle& f = other.triangles[probe.triangle];
  const auto &v = other.local[probe.triangle], &shade = other.shade[probe.triangle];
  const Vec3 d = x[probe.node] - foot;
  Vec3 n = w[0] * other.normal[shade[0]] + w[1] * other.normal[shade[1]] + w[2] * other.normal[shade[2]];
  n.normalize();
  const double along = d.dot(n);
  // Beyond an open edge the surface has ended: no contact on its continuation.
  bool border = true;
  for (int k = 0; k < 3; ++k) border = border && (w[k] <= 0 || other.on_border[std::size_t(v[k])]);
  const double beside2 = (d - along * n).squaredNorm();
  if (border && w.minCoeff() <= 0 && beside2 > 1e-8 + 0.01 * along * along) {
    probe.impulse = 0;
    clearance = along > 0 ? d.norm() : std::sqrt(beside2) + 0.1 * along;
    return false;
  }
  // Depth is a distance: a node a little below a facet's plane but far beside it has gone through something else, whose
  // facets do not face it, or through nothing.
  if (along < 0 && nearest.squared > options_.max_depth * options_.max_depth) {
    probe.impulse = 0;
    clearance = std::sqrt(nearest.squared) - options_.max_depth;
    return false;
  }
  double gap = along;
  if (const int side = side_of_edge(probe, w, d, x); side != 0 && d.squaredNorm() > touching * touching) {
    // There is no plane, only the edge; in a crease each of its facets alone would let the node into the other.
    gap = side * d.norm(), n = d / gap;
  } else {
    // The facets cut the corner of the smooth surface by the sagitta 1/2 sum w_k (x_k - p).n_k.
    double sagitta = 0;
    for (int k = 0; k < 3; ++k) sagitta += 0.5 * w[k] * (x[f[k]] - foot).dot(other.normal[std::size_t(shade[k])]);
    gap -= std::clamp(sagitta, -options_.sagitta_limit, options_.sagitta_limit);
  }
  if (gap > held_below_) {
    probe.impulse = 0;
    clearance = std::min(d.norm(), gap);
    return false;
  }
  if (gap < -options_.fold_depth) {  // seldom: the rest shape is not fetched for the others
    if (const double lowest = -deepest(probe, probe.triangle); gap < lowest) {
      probe.impulse = 0;
      clearance = lowest - gap;
      return false;
    }
  }
  clearance = 0;
  c.node = probe.node, c.facet = f, c.w = {w[0], w[1], w[2]}, c.n = n, c.gap = gap, c.friction = pass.friction;
  c.impulse = probe.impulse, c.slip = Vec3::Zero();
  c.from_foot = d, c.looks = 0;
  c.target = target(gap), c.shift = gap - n.dot(d);
  finish(c, x);
  return c.mass > 0;
}

/// Most of what a look finds is what the last one found. A constraint whose node and facet have hardly moved against
/// each other keeps its foot, its normal and its responses; only the gap is new, along that normal.
bool Contact::foot_serves(Constraint& c, const std::vector<Vec3>& x) const {
  const Vec3 d = update_gap(c, x);
  return ++c.looks <= foot_lasts && (d - c.from_foot).squaredNorm() <= foot_holds * foot_holds && c.gap <= held_below_;
}

/// Along the normal it has. Returns where the node is from the foot.
Vec3 Contact::update_gap(Constraint& c, const std::vector<Vec3>& x) const {
  const Vec3 d = x[c.node] - (c.w[0] * x[c.facet[0]] + c.w[1] * x[c.facet[1]] + c.w[2] * x[c.facet[2]]);
  c.gap = c.n.dot(d) + c.shift;
  c.target = target(c.gap);
  if (c.friction > 0) c.slip.setZero();
  return d;
}

/// Least normal speed: what closes an open gap by the end of the step.
double Contact::target(double gap) const { return std::min(0.0, -gap / dt_); }

/// Responses, and the effective mass 1 / (n.M^-1 n + sum w_k^2 n.M_k^-1 n + hinges).
void Contact::finish(Constraint& c, const std::vector<Vec3>& x) const {
  c.response[0] = response(c.node, c.n);
  double inverse = c.n.dot(c.response[0]);
  for (int k = 0; k < 3; ++k) {
    c.response[k + 1] = -c.w[k] * response(c.facet[k], c.n);
    inverse -= c.w[k] * c.n.dot(c.response[k + 1]);
  }
  const auto lever = [&](std::int16_t h) {
    return h < 0 ? 0.0 : hinges_[h].axis.dot((x[c.node] - hinges_[h].point).cross(c.n));
  };
  c.hinge_node = hinge_of_node_[c.node], c.hinge_facet = hinge_of_node_[c.facet[0]];
  c.lever_node = lever(c.hinge_node), c.lever_facet = lever(c.hinge_facet);
  if (c.hinge_node >= 0) inverse += c.lever_node * c.lever_node * hinges_[c.hinge_node].inverse_inertia;
  if (c.hinge_facet >= 0) inverse += c.lever_facet * c.lever_facet * hinges_[c.hinge_facet].inverse_inertia;
  c.mass = inverse > 0 ? 1 / inverse : 0;
}

}  // namespace carus::contact
