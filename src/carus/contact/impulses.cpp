// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>

#include "carus/contact/contact.hpp"
#include "carus/core/parallel.hpp"

namespace carus::contact {

namespace {

constexpr double least_near = 1e-5;  // [m]
constexpr double rounding = 1e-6;    // [m]: penetrations that are none

[[gnu::always_inline]] inline Vec3 relative(const Constraint& c, const std::vector<Vec3>& v) {
  return v[c.node] - (c.w[0] * v[c.facet[0]] + c.w[1] * v[c.facet[1]] + c.w[2] * v[c.facet[2]]);
}

}  // namespace

/// An impulse along the normal acts on the node, its opposite on the facet.
[[gnu::always_inline]] inline void Contact::push(const Constraint& c, double impulse, std::vector<Vec3>& v,
                                                 std::vector<double>& rate) const {
  v[c.node] += impulse * c.response[0];
  for (int k = 0; k < 3; ++k) v[c.facet[k]] += impulse * c.response[k + 1];
  if (c.hinge_node >= 0) rate[c.hinge_node] += hinges_[c.hinge_node].inverse_inertia * c.lever_node * impulse;
  if (c.hinge_facet >= 0) rate[c.hinge_facet] -= hinges_[c.hinge_facet].inverse_inertia * c.lever_facet * impulse;
}

/// A tangential impulse; hinges feel the normal ones alone.
[[gnu::always_inline]] inline void Contact::shear(const Constraint& c, const Vec3& impulse,
                                                  std::vector<Vec3>& v) const {
  v[c.node] += response(c.node, impulse);
  for (int k = 0; k < 3; ++k) v[c.facet[k]] -= c.w[k] * response(c.facet[k], impulse);
}

/// Coulomb: the tangential impulse that stops the slip, at most friction times the normal one.
[[gnu::always_inline]] inline void Contact::rub(Constraint& c, std::vector<Vec3>& v) const {
  const Vec3 u = relative(c, v);
  Vec3 slip = c.slip - c.mass * (u - u.dot(c.n) * c.n);
  const double limit = double(c.friction) * c.impulse, size = slip.norm();
  if (size > limit) slip *= limit / size;
  shear(c, slip - c.slip, v);
  c.slip = slip;
}

/// Returns the normal speed it found.
[[gnu::always_inline]] inline double Contact::relax(Constraint& c, std::vector<Vec3>& v,
                                                    std::vector<double>& rate) const {
  double speed = c.n.dot(relative(c, v));
  if (c.hinge_node >= 0) speed += rate[c.hinge_node] * c.lever_node;
  if (c.hinge_facet >= 0) speed -= rate[c.hinge_facet] * c.lever_facet;
  const double wanted = std::max(0.0, c.impulse + c.mass * (c.target - speed));
  const double change = wanted - c.impulse;
  c.impulse = wanted;
  if (change != 0) push(c, change, v, rate);
  if (c.friction > 0) rub(c, v);
  return speed;
}

/// Most pairs that might touch do not. What is too far apart to touch in this step is not looked at; what the first
/// sweep leaves further apart at the end of the step than later sweeps can bring it back is left alone by them.
void Contact::sweep(int part, int number, std::vector<Vec3>& v, std::vector<double>& rate) {
  auto& live = live_[std::size_t(part)];
  if (number > 0) {
    for (const auto i : live) relax(constraints_[std::size_t(i)], v, rate);
    return;
  }
  live.clear();
  const double near = std::clamp(2 * closing_, least_near, options_.activation);
  for (auto i = part_begin_[std::size_t(part)]; i < part_begin_[std::size_t(part) + 1]; ++i) {
    Constraint& c = constraints_[i];
    if (c.impulse == 0 && c.gap > needed_) continue;
    const double speed = relax(c, v, rate);
    if (c.impulse > 0 || dt_ * (speed - c.target) < near) live.push_back(std::int32_t(i));
  }
}

void Contact::solve(std::vector<Vec3>& v, std::vector<double>& hinge_rate) {
  const auto warm_start = [&](int part) {
    for (auto i = part_begin_[std::size_t(part)]; i < part_begin_[std::size_t(part) + 1]; ++i)
      if (constraints_[i].impulse > 0) push(constraints_[i], constraints_[i].impulse, v, hinge_rate);
  };
  warm_start(parts);
  for (int number = 0; number < options_.sweeps; ++number) {
    parallel::for_chunks(parts, 1, [&](std::size_t part, std::size_t, std::size_t) {
      if (number == 0) warm_start(int(part));
      sweep(int(part), number, v, hinge_rate);
    });
    sweep(parts, number, v, hinge_rate);
  }
}

/// One pair of `part_penetrated`.
[[gnu::always_inline]] inline void Contact::raise(Constraint& c, const std::vector<Vec3>& v,
                                                  std::vector<Vec3>& lift) const {
  double wanted_speed = 0;
  if (c.gap < -rounding) {
    const double opening = std::max(0.0, c.n.dot(relative(c, v)));
    wanted_speed = std::clamp(-c.gap / dt_ - opening, 0.0, options_.correction_speed);
  }
  const double wanted = std::max(0.0, c.lift + c.mass * (wanted_speed - c.n.dot(relative(c, lift))));
  const double change = wanted - c.lift;
  c.lift = wanted;
  if (change == 0) return;
  lift[c.node] += change * c.response[0];
  for (int k = 0; k < 3; ++k) lift[c.facet[k]] += change * c.response[k + 1];
}

/// The first sweep takes apart what is penetrated; from the second on what bears a load holds off their lift.
void Contact::raise_part(int part, int number, const std::vector<Vec3>& v, std::vector<Vec3>& lift) {
  for (const auto i : live_[std::size_t(part)]) {
    Constraint& c = constraints_[std::size_t(i)];
    if (number == 0) c.lift = 0;
    if (c.gap < -rounding || (number > 0 && c.impulse > 0)) raise(c, v, lift);
  }
}

void Contact::part_penetrated(const std::vector<Vec3>& v, std::vector<Vec3>& lift) {
  const int sweeps = std::max(2, options_.sweeps - 1);  // what is left over waits for the next step
  for (int number = 0; number < sweeps; ++number) {
    parallel::for_chunks(parts, 1,
                         [&](std::size_t part, std::size_t, std::size_t) { raise_part(int(part), number, v, lift); });
    raise_part(parts, number, v, lift);
  }
}

}  // namespace carus::contact
