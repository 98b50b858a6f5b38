// SPDX-License-Identifier: Apache-2.0
#include <cmath>

#include "carus/contact/contact.hpp"

namespace carus::contact {

/// The impulse acts on the node, its opposite on the facet.
void Contact::apply(const Constraint& c, const Vec3& impulse, std::vector<Vec3>& v, std::vector<double>& rate) const {
  v[c.node] += response(c.node, impulse);
  for (int k = 0; k < 3; ++k) v[c.facet[k]] -= c.w[k] * response(c.facet[k], impulse);
  const double along = impulse.dot(c.n);
  if (c.hinge_node >= 0) rate[c.hinge_node] += hinges_[c.hinge_node].inverse_inertia * c.lever_node * along;
  if (c.hinge_facet >= 0) rate[c.hinge_facet] -= hinges_[c.hinge_facet].inverse_inertia * c.lever_facet * along;
}

void Contact::solve(std::vector<Vec3>& v, std::vector<double>& hinge_rate) {
  const auto relative = [&](const Constraint& c) -> Vec3 {
    return v[c.node] - (c.w[0] * v[c.facet[0]] + c.w[1] * v[c.facet[1]] + c.w[2] * v[c.facet[2]]);
  };
  const auto normal_speed = [&](const Constraint& c) {
    double s = c.n.dot(relative(c));
    if (c.hinge_node >= 0) s += hinge_rate[c.hinge_node] * c.lever_node;
    if (c.hinge_facet >= 0) s -= hinge_rate[c.hinge_facet] * c.lever_facet;
    return s;
  };
  for (const Constraint& c : constraints_) {
    if (c.impulse > 0) apply(c, c.impulse * c.n, v, hinge_rate);
  }
  const auto relax = [&](Constraint& c) {
    const double speed = normal_speed(c), wanted = std::max(0.0, c.impulse + c.mass * (c.target - speed));
    const double change = wanted - c.impulse;
    c.impulse = wanted;
    if (change != 0) apply(c, change * c.n, v, hinge_rate);
    if (c.friction > 0) {
      const Vec3 u = relative(c);
      Vec3 slip = c.slip - c.mass * (u - u.dot(c.n) * c.n);
      const double limit = double(c.friction) * c.impulse, size = slip.norm();
      if (size > limit) slip *= limit / size;
      apply(c, slip - c.slip, v, hinge_rate);
      c.slip = slip;
    }
    return speed;
  };
  // Most pairs that might touch do not: what the first sweep leaves further than `activation` apart at the end of the
  // step is left alone by the others.
  live_.clear();
  for (std::size_t i = 0; i < constraints_.size(); ++i) {
    Constraint& c = constraints_[i];
    const double speed = relax(c);
    if (c.impulse > 0 || dt_ * (speed - c.target) < options_.activation) live_.push_back(std::int32_t(i));
  }
  for (int sweep = 1; sweep < options_.sweeps; ++sweep) {
    for (const auto i : live_) relax(constraints_[std::size_t(i)]);
  }
  for (const Constraint& c : constraints_) probes_[c.probe].impulse = c.impulse;
}

}  // namespace carus::contact
