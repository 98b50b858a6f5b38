// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <chrono>
#include <cmath>
#include <limits>

#include "carus/contact/contact.hpp"
#include "carus/core/parallel.hpp"
#include "carus/mesh/closest_point.hpp"

namespace carus::contact {

namespace {

constexpr std::size_t probe_chunk = 256;
constexpr std::size_t constraint_chunk = 512;
constexpr int normals_every = 8;      // steps, about: normals turn slowly against the step
constexpr int renew_every = 400;      // steps at most, so that folds find their new partner
constexpr int look_every = 10;        // steps, about: fewer cost looks, more hold constraints that do not touch
constexpr double look_within = 8e-4;  // [m] of travel, both sides': so far the foot and its normal stay good
constexpr double awake = -std::numeric_limits<double>::infinity();

Vec3 interpolate(const std::vector<Vec3>& x, const mesh::Triangle& t, const Vec3& w) {
  return w[0] * x[t[0]] + w[1] * x[t[1]] + w[2] * x[t[2]];
}

}  // namespace

Contact::Contact(std::vector<Surface> surfaces, std::vector<Pair> pairs, const std::vector<Vec3>& rest,
                 std::vector<Vec3> inverse_mass, std::vector<Vec3> inverse_mass_blocked,
                 std::vector<std::int16_t> hinge_of_node, std::vector<HingeBody> hinges, const Options& options)
    : surfaces_(std::move(surfaces)),
      pairs_(std::move(pairs)),
      rest_(rest),
      inverse_mass_(std::move(inverse_mass)),
      inverse_mass_blocked_(std::move(inverse_mass_blocked)),
      hinge_of_node_(std::move(hinge_of_node)),
      hinges_(std::move(hinges)),
      options_(options),
      grids_(surfaces_.size()),
      motion_(surfaces_.size()) {
  const auto add = [&](int nodes, int facets, double friction) {
    const auto first = std::int32_t(probes_.size());
    for (std::size_t v = 0; v < surfaces_[nodes].nodes.size(); ++v) {
      Probe p;
      p.node = surfaces_[nodes].nodes[v], p.vertex = std::int32_t(v), p.pass = std::int32_t(passes_.size());
      probes_.push_back(p);
    }
    passes_.push_back({nodes, facets, nodes == facets, float(friction), first, std::int32_t(probes_.size())});
  };
  for (const Pair& p : pairs_) {
    add(p.a, p.b, p.friction);
    if (p.a != p.b) add(p.b, p.a, p.friction);
  }
  for (const Surface& s : surfaces_) {
    moves_.push_back(std::any_of(s.nodes.begin(), s.nodes.end(),
                                 [&](std::int32_t n) { return hinge_of_node_[n] >= 0 || !inverse_mass_[n].isZero(); }));
  }
  chunk_constraints_.resize((probes_.size() + probe_chunk - 1) / probe_chunk);
}

void Contact::weigh(const std::vector<Vec3>& inverse_mass, const std::vector<Vec3>& inverse_mass_blocked,
                    const std::vector<double>& hinges) {
  inverse_mass_ = inverse_mass, inverse_mass_blocked_ = inverse_mass_blocked;
  for (std::size_t h = 0; h < hinges_.size(); ++h) hinges_[h].inverse_inertia = hinges[h];
  look_due_ = true;  // constraints hold responses and effective masses
  for (Probe& p : probes_) p.constraint = -1;
}

bool Contact::admissible(const Probe& probe, std::int32_t triangle) const {
  const Pass& pass = passes_[probe.pass];
  const Surface& own = surfaces_[pass.nodes];
  const Surface& other = surfaces_[pass.facets];
  // Surfaces that touch face each other; a fold's far side and the back of a thin wall do not.
  // A node of a rim belongs to several sides; their mean faces none of the bodies that they face.
  const Vec3& facing = other.facet_normal[triangle];
  bool faces = !own.on_crease(probe.vertex) && own.normal[probe.vertex].dot(facing) <= 0;
  for (auto s = own.side_begin[probe.vertex]; s < own.side_begin[probe.vertex + 1] && !faces; ++s)
    faces = own.normal[s].dot(facing) <= 0;
  if (!faces) return false;
  return !pass.self || !through_the_wall(own, probe, triangle);
}

bool Contact::near_itself(const Probe& probe, std::int32_t triangle) const {
  const Pass& pass = passes_[probe.pass];
  const double near2 = options_.self_exclusion * options_.self_exclusion;
  return pass.self && (surfaces_[pass.facets].rest_centre[triangle] - rest_[probe.node]).squaredNorm() <= near2;
}

/// How deep behind a facet a node may lie and still be taken to have gone through it. Where a wall bends outwards by
/// more than a right angle, the two flanks of the ridge face away from each other and each lies behind the other, as
/// in a fold whose flanks have passed through each other; only those never get far.
double Contact::deepest(const Probe& probe, std::int32_t triangle) const {
  return near_itself(probe, triangle) ? options_.fold_depth : options_.max_depth;
}

/// A wall's own other side faces its nodes too, and is near them. The same side does so only where it folds, and then
/// however tightly: all of it may touch but the facets that have the node.
bool Contact::through_the_wall(const Surface& wall, const Probe& probe, std::int32_t triangle) const {
  if (!near_itself(probe, triangle)) return false;
  const auto& t = wall.local[triangle];
  if (std::find(t.begin(), t.end(), probe.vertex) != t.end() || wall.on_crease(probe.vertex)) return true;
  const auto& n = wall.shade[triangle];
  return wall.rest_normal[probe.vertex].dot(wall.rest_normal[n[0]] + wall.rest_normal[n[1]] + wall.rest_normal[n[2]]) <=
         0;
}

void Contact::renew_probe(Probe& probe, const std::vector<Vec3>& x) const {
  const Pass& pass = passes_[probe.pass];
  const Surface& other = surfaces_[pass.facets];
  const Vec3& p = x[probe.node];
  double best = options_.reach * options_.reach;
  std::int32_t found = -1;
  const Surface& own = surfaces_[pass.nodes];
  const Vec3 facing = own.on_crease(probe.vertex) ? Vec3::Zero() : own.normal[probe.vertex];
  grids_[pass.facets].for_each_near(p, facing, best, [&](std::int32_t t) {
    const mesh::Triangle& f = other.triangles[t];
    if (!admissible(probe, t)) return;
    const Vec3 w = mesh::closest_point_weights(p, x[f[0]], x[f[1]], x[f[2]]);
    const Vec3 d = p - interpolate(x, f, w);
    const double d2 = d.squaredNorm();
    if (d2 > best || (d2 == best && t >= found)) return;  // of equals the first: the order of search says nothing
    const double depth = -d.dot(other.facet_normal[t]) / other.facet_normal[t].norm();
    if (depth > options_.fold_depth && depth > deepest(probe, t)) return;
    best = d2, found = t;
  });
  if (found < 0) probe.impulse = 0;
  probe.triangle = found;
}

void Contact::renew(const std::vector<Vec3>& x) {
  const auto start = std::chrono::steady_clock::now();
  const bool first = renewals_ == 0;
  update_normals(x);
  parallel::for_chunks(surfaces_.size(), 1, [&](std::size_t s, std::size_t, std::size_t) {
    if (!first && !moves_[s]) return;
    grids_[s].build(x, surfaces_[s].triangles, options_.reach);
  });
  parallel::for_chunks(probes_.size(), probe_chunk, [&](std::size_t b, std::size_t e, std::size_t) {
    for (std::size_t i = b; i < e; ++i) renew_probe(probes_[i], x);
  });
  for (Pass& p : passes_) p.before = 0;
  begin_stretch(x);
  steps_since_renewal_ = 0;
  ++renewals_;
  seconds_renewing_ += std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
}

/// Everything is looked at anew from here on, and motion counted from here.
void Contact::begin_stretch(const std::vector<Vec3>& x) {
  for (std::size_t s = 0; s < surfaces_.size(); ++s) {
    Motion& m = motion_[s];
    m.at_start.clear();
    for (const auto n : surfaces_[s].nodes) m.at_start.push_back(x[n]);
    m.at_look = m.at_start;
  }
  for (Pass& p : passes_) p.net = p.travel = 0;
  near_.clear();
  for (std::size_t i = 0; i < probes_.size(); ++i) {
    probes_[i].sleeps_until = awake, probes_[i].constraint = -1;
    if (probes_[i].triangle >= 0) near_.push_back(std::int32_t(i));
  }
}

/// Cuts that share the constraints out evenly, across the direction in which they reach farthest.
void Contact::cut(const std::vector<Vec3>& x, std::size_t chunks) {
  Eigen::AlignedBox3d box;
  along_cut_.clear();
  const auto for_each_node = [&](auto&& f) {
    for (std::size_t k = 0; k < chunks; ++k)
      for (const Constraint& c : chunk_constraints_[k]) f(x[c.node]);
  };
  for_each_node([&](const Vec3& p) { box.extend(p); });
  if (box.isEmpty()) return;
  box.sizes().maxCoeff(&cut_axis_);
  for_each_node([&](const Vec3& p) { along_cut_.push_back(p[cut_axis_]); });
  auto first = along_cut_.begin();
  for (std::size_t c = 0; c < cuts_.size(); ++c) {
    const auto nth = along_cut_.begin() + std::ptrdiff_t((c + 1) * along_cut_.size() / parts);
    std::nth_element(first, nth, along_cut_.end());
    cuts_[c] = *nth, first = nth;
  }
}

/// The part that has all four nodes, or `parts` where there is none or a hinge is shared.
int Contact::part_of(const Constraint& c, const std::vector<Vec3>& x) const {
  if (c.hinge_node >= 0 || c.hinge_facet >= 0) return parts;
  const auto side = [&](std::int32_t node) {
    return std::upper_bound(cuts_.begin(), cuts_.end(), x[node][cut_axis_]) - cuts_.begin();
  };
  const auto part = side(c.node);
  return std::all_of(c.facet.begin(), c.facet.end(), [&](auto n) { return side(n) == part; }) ? int(part) : parts;
}

/// What moves as one does not move against itself: of all pairs of displacements one is as far from the other as the
/// boxes allow, or as the longest of each in opposite directions.
double Contact::relative_motion(const Spread& a, const Spread& b) {
  const Vec3 apart = (a.most - b.least).cwiseMax(b.most - a.least);
  return std::min(apart.norm(), std::sqrt(a.longest2) + std::sqrt(b.longest2));
}

void Contact::measure_motion(const std::vector<Vec3>& x) {
  parallel::for_chunks(surfaces_.size(), 1, [&](std::size_t s, std::size_t, std::size_t) {
    Motion& m = motion_[s];
    if (!moves_[s] || m.at_look.empty()) return;
    const auto& nodes = surfaces_[s].nodes;
    m.from_start = Spread(x[nodes[0]] - m.at_start[0]), m.from_look = Spread(x[nodes[0]] - m.at_look[0]);
    for (std::size_t v = 0; v < nodes.size(); ++v) {
      const Vec3& p = x[nodes[v]];
      m.from_start.add(p - m.at_start[v]), m.from_look.add(p - m.at_look[v]);
      m.at_look[v] = p;
    }
  });
  for (Pass& p : passes_) {
    const Motion &a = motion_[p.nodes], &b = motion_[p.facets];
    p.net = relative_motion(a.from_start, b.from_start);
    p.travel += relative_motion(a.from_look, b.from_look);
  }
}

/// From where they are: a node that trembles is not far, however fast.
double Contact::relative_motion_since_look(const std::vector<Vec3>& x) {
  parallel::for_chunks(surfaces_.size(), 1, [&](std::size_t s, std::size_t, std::size_t) {
    Motion& m = motion_[s];
    if (!moves_[s] || m.at_look.empty()) return;
    const auto& nodes = surfaces_[s].nodes;
    m.from_look = Spread(x[nodes[0]] - m.at_look[0]);
    for (std::size_t v = 1; v < nodes.size(); ++v) m.from_look.add(x[nodes[v]] - m.at_look[v]);
  });
  double most = 0;
  for (const Pass& p : passes_)
    most = std::max(most, relative_motion(motion_[p.nodes].from_look, motion_[p.facets].from_look));
  return most;
}

/// Of what moves; a fixed bone has had its normals since the start.
void Contact::update_normals(const std::vector<Vec3>& x) {
  steps_since_normals_ = 0;
  for (std::size_t s = 0; s < surfaces_.size(); ++s) {
    if (moves_[s]) surfaces_[s].update_normals(x);
  }
}

/// Some pair of surfaces has moved so far since the renewal that what was out of reach may touch before the next look.
bool Contact::worn_out() const {
  const double reserve = options_.reach - options_.sagitta_limit - held_below_;
  return std::any_of(passes_.begin(), passes_.end(), [&](const Pass& p) { return p.before + p.net > reserve; });
}

void Contact::pause(const std::vector<Vec3>& x) {
  keep_impulses();
  measure_motion(x);
  for (Pass& p : passes_) p.before += p.net;
  begin_stretch(x);
  look_due_ = true, steps_since_normals_ = never;
}

std::vector<double> Contact::save() const {
  std::vector<double> saved{double(steps_since_renewal_)};
  saved.reserve(1 + passes_.size() + 2 * probes_.size());
  for (const Pass& p : passes_) saved.push_back(p.before);
  for (const Probe& p : probes_) saved.push_back(p.triangle), saved.push_back(p.impulse);
  return saved;
}

void Contact::load(const double* saved, const std::vector<Vec3>& x) {
  steps_since_renewal_ = int(*saved++);
  for (Pass& p : passes_) p.before = *saved++;
  for (Probe& p : probes_) p.triangle = std::int32_t(*saved++), p.impulse = *saved++;
  constraints_.clear(), part_begin_.fill(0);
  begin_stretch(x);
  look_due_ = true, steps_since_normals_ = never;
}

/// Constraints of the probes near_[begin..end).
void Contact::constrain_chunk(std::size_t begin, std::size_t end, const std::vector<Vec3>& x,
                              std::vector<Constraint>& out) {
  out.clear();
  Constraint c{};
  double clearance = 0;
  for (std::size_t i = begin; i < end; ++i) {
    Probe& probe = probes_[std::size_t(near_[i])];
    if (probe.constraint >= 0) {
      c = constraints_[std::size_t(probe.constraint)];
      if (foot_serves(c, x)) {
        out.push_back(c);
        continue;
      }
      probe.constraint = -1;
    }
    const double so_far = passes_[std::size_t(probe.pass)].travel;
    if (probe.sleeps_until - so_far > held_below_) continue;
    if (constrain(probe, x, c, clearance)) c.probe = near_[i], out.push_back(c);
    probe.sleeps_until = clearance > held_below_ ? so_far + clearance : awake;
  }
}

void Contact::constrain_all(const std::vector<Vec3>& x) {
  parallel::for_chunks(near_.size(), probe_chunk, [&](std::size_t b, std::size_t e, std::size_t chunk) {
    constrain_chunk(b, e, x, chunk_constraints_[chunk]);
  });
  gather_parts(x);
}

/// One list, by parts; within a part the order of the probes.
void Contact::gather_parts(const std::vector<Vec3>& x) {
  const std::size_t chunks = (near_.size() + probe_chunk - 1) / probe_chunk;
  cut(x, chunks);
  part_begin_.fill(0);
  for (std::size_t k = 0; k < chunks; ++k) {
    for (Constraint& c : chunk_constraints_[k]) c.part = part_of(c, x), ++part_begin_[std::size_t(c.part) + 1];
  }
  for (std::size_t p = 0; p <= parts; ++p) part_begin_[p + 1] += part_begin_[p];
  constraints_.resize(part_begin_.back());
  auto next = part_begin_;
  for (std::size_t k = 0; k < chunks; ++k) {
    for (const Constraint& c : chunk_constraints_[k]) {
      const auto at = next[std::size_t(c.part)]++;
      constraints_[at] = c, probes_[std::size_t(c.probe)].constraint = std::int32_t(at);
    }
  }
}

/// Gaps of the constraints at hand, along their normals.
void Contact::refresh(const std::vector<Vec3>& x) {
  parallel::for_chunks(constraints_.size(), constraint_chunk, [&](std::size_t b, std::size_t e, std::size_t) {
    for (std::size_t i = b; i < e; ++i) update_gap(constraints_[i], x);
  });
}

/// Impulses go back to their probes, where they outlive the constraint.
void Contact::keep_impulses() {
  for (const Constraint& c : constraints_) probes_[std::size_t(c.probe)].impulse = c.impulse;
}

void Contact::look(const std::vector<Vec3>& x) {
  keep_impulses();
  held_below_ = needed_ + std::min(look_every * closing_, look_within);
  measure_motion(x);
  since_look_ = 0;
  if (steps_since_renewal_ >= renew_every || worn_out()) {
    renew(x);
  } else if (steps_since_normals_ >= normals_every) {
    update_normals(x);
  }
  constrain_all(x);
  look_due_ = false;
}

bool Contact::detect(const std::vector<Vec3>& x, double dt, double max_speed) {
  dt_ = dt, closing_ = 2 * dt * max_speed;
  needed_ = options_.activation + closing_;
  const auto spent = [&] { return held_below_ - since_look_ < needed_; };
  if (!look_due_ && spent()) since_look_ = relative_motion_since_look(x);
  const bool looks = look_due_ || steps_since_renewal_ >= renew_every || spent();
  if (looks) {
    look(x);
  } else {
    refresh(x);
  }
  ++steps_since_renewal_, ++steps_since_normals_;
  return looks;
}

double Contact::least_gap() const {
  double gap = std::numeric_limits<double>::infinity();
  for (const Constraint& c : constraints_) gap = std::min(gap, c.gap);
  return gap;
}

}  // namespace carus::contact
