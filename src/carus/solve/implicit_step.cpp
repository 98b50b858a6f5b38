// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>

#include "carus/core/error.hpp"
#include "carus/core/stopwatch.hpp"
#include "carus/fem/constraints.hpp"
#include "carus/solve/implicit_impl.hpp"

namespace carus::solve {

namespace {

double largest(const std::vector<Vec3>& u) {
  double most = 0;
  for (const Vec3& v : u) most = std::max(most, v.squaredNorm());
  return std::sqrt(most);
}

}  // namespace

/// Where the motions would have the nodes go from x; zero elsewhere. False where nothing is left to do.
bool Implicit::Impl::imposed_motion(std::vector<Vec3>& out) const {
  bool any = false;
  for (const auto& m : model.motions)
    for (const auto n : m.nodes) {
      const Vec3 d = fem::placed(m, model.mesh.nodes[n], t1) - x[n];
      for (int k = 0; k < 3; ++k)
        if ((m.axes >> k) & 1) out[n][k] = d[k], any |= d[k] != 0;
    }
  return any;
}

/// Solves for the direction of the next correction; `given` is imposed on some nodes.
void Implicit::Impl::solve_direction(const std::vector<Vec3>* given) {
  if (given) {
    multiply_nodes(*given, product);
    for (std::size_t i = 0; i < g.size(); ++i) product[i] = load[i] - g[i] - product[i];
  } else {
    for (std::size_t i = 0; i < g.size(); ++i) product[i] = load[i] - g[i];
  }
  freedom.reduce(product, x, residual);
  for (std::size_t h = 0; h < model.hinges.size(); ++h) residual[freedom.nodes() + h].x() -= hinge_moment(h);
  const Stopwatch watch(seconds[linear]);
  const auto precondition = [&](const Unknowns& r, Unknowns& z) {
    parallel::for_chunks(r.size(), unknown_chunk, [&](std::size_t begin, std::size_t end, std::size_t) {
      for (std::size_t i = begin; i < end; ++i) z[i].noalias() = preconditioner[i] * r[i];
    });
  };
  const auto result = pcg([&](const Unknowns& q, Unknowns& y) { multiply(q, y); }, precondition, residual, direction,
                          options.linear_tolerance, options.max_linear_iterations, pcg_work);
  counts.linear += result.iterations;
  last.linear = result.iterations;
}

void Implicit::Impl::move(double a, const std::vector<Vec3>* given, std::vector<Vec3>& to,
                          std::vector<double>& turned) const {
  to = x, turned = angle;
  add_scaled(a, u, to);
  if (given) add_scaled(a, *given, to);
  for (std::size_t h = 0; h < model.hinges.size(); ++h) turned[h] += a * direction[freedom.nodes() + h].x();
  freedom.place(turned, to);
}

/// Goes along the direction as far as the potential, less the loads' work on the way, falls. Where motions are
/// imposed it may rise: then as far as it is finite.
Implicit::Impl::Refusal Implicit::Impl::search_line(const std::vector<Vec3>* given, double& a) {
  a = last.clear = clear_way(given);
  const Stopwatch watch(seconds[line_search]);
  const double before = potential(x, angle);
  const double slope = last.slope = -dot(residual, direction);
  std::vector<Vec3> next;
  std::vector<double> turned;
  for (const double least = 1e-9 * a; a > least; a *= 0.5) {
    ++counts.line_search;
    move(a, given, next, turned);
    const double after = potential(next, turned);
    if (!std::isfinite(after)) continue;
    std::vector<Vec3> new_load = loads_at(next, t1);
    if (!given) {
      const double done = work_between(next, new_load);
      // Near the minimum the fall drowns in the rounding of the sums.
      if (after - before - done > 1e-4 * a * slope + 1e-13 * (std::abs(before) + std::abs(done))) continue;
    }
    x.swap(next), angle.swap(turned), load.swap(new_load);
    return {};
  }
  return fmt::format("no descent along the Newton direction (slope {:.3g} J)", slope);
}

/// Share of the direction along which nothing touches. A hinge's nodes go along an arc, which keeps to its chord
/// within a few micrometres at the angles of one correction; the proof at the end of a step sees the arc.
double Implicit::Impl::clear_way(const std::vector<Vec3>* given) {
  if (!contact.any()) return 1;
  const Stopwatch watch(seconds[collision]);
  std::vector<Vec3> way;
  std::vector<double> turned;
  move(1, given, way, turned);
  for (std::size_t i = 0; i < way.size(); ++i) way[i] -= x[i];
  return contact.conservative_step(x, way);
}

/// Goes on as in the step before, as far as that is free of collisions and lowers the potential: bodies that creep
/// together then start nearly where they will end.
void Implicit::Impl::extrapolate() {
  if (state.step == 0 || !model.motions.empty()) return;
  u = state.v;
  for (Vec3& v : u) v *= dt;
  direction.assign(freedom.unknowns(), Vec3::Zero());
  for (std::size_t h = 0; h < model.hinges.size(); ++h) direction[freedom.nodes() + h].x() = dt * state.hinge_rate[h];
  double a = clear_way(nullptr);
  const Stopwatch watch(seconds[line_search]);
  const double before = potential(x, angle);
  std::vector<Vec3> next;
  std::vector<double> turned;
  for (const double least = 0.1 * a; a > least; a *= 0.5) {
    move(a, nullptr, next, turned);
    const double after = potential(next, turned);
    if (!std::isfinite(after)) continue;
    std::vector<Vec3> new_load = loads_at(next, t1);
    if (after - before > work_between(next, new_load)) continue;
    x.swap(next), angle.swap(turned), load.swap(new_load);
    return;
  }
}

/// Of the loads on the way from x, in the middle of their change [J].
double Implicit::Impl::work_between(const std::vector<Vec3>& next, const std::vector<Vec3>& new_load) const {
  double done = 0;
  for (std::size_t i = 0; i < x.size(); ++i) done += 0.5 * (load[i] + new_load[i]).dot(next[i] - x[i]);
  return done;
}

Implicit::Impl::Refusal Implicit::Impl::minimise() {
  std::vector<Vec3> given(x.size(), Vec3::Zero());
  extrapolate();
  for (int iteration = 0; iteration < options.max_iterations; ++iteration) {
    ++counts.newton;
    gradient();
    add_motion_gradient();
    add_contact_gradient();
    linearise();
    const bool imposed = !model.motions.empty() && imposed_motion(given);
    solve_direction(imposed ? &given : nullptr);
    freedom.expand(direction, x, u);
    if (imposed) {
      for (const auto& t : model.ties)
        given[t.node] =
            t.weights[0] * given[t.facet[0]] + t.weights[1] * given[t.facet[1]] + t.weights[2] * given[t.facet[2]];
    }
    const double length = largest(u);
    if (!std::isfinite(length)) return "a correction that is not finite";
    double a = 1;
    const auto refusal = search_line(imposed ? &given : nullptr, a);
    last.time = t1, last.dt = dt, last.iteration = iteration, last.length = length, last.taken = a;
    if (options.watch) options.watch(last);
    if (!refusal.empty()) return refusal;
    if (!imposed && length <= options.newton_tolerance) return {};
  }
  return fmt::format("no convergence in {} Newton iterations", options.max_iterations);
}

Implicit::Impl::Refusal Implicit::Impl::step(double length) {
  dt = length, t1 = state.time + dt;
  x0 = x = state.x, angle0 = angle = state.hinge_angle;
  const auto rings = rest_length.rings();
  double active = 0;
  if (rest_length.active()) {
    const double stored = elastic.stored(x);
    rest_length.advance(x, state.time + 0.5 * dt, dt);
    elastic.set_rest_length(rest_length);
    active = elastic.stored(x) - stored;
  }
  elastic.begin_step(dt);
  contact.begin_step(x, options.friction_speed * dt);
  load = loads_at(x, t1);
  const double barrier = contact.energy(x);
  auto refusal = minimise();
  if (refusal.empty() && too_long()) refusal = "the step's error is beyond its tolerance";
  if (refusal.empty()) {
    if (const auto cut = intersecting(x); !cut.empty()) refusal = "surfaces cut each other: " + cut;
  }
  if (!refusal.empty()) {
    rest_length.rings() = rings;
    if (rest_length.active()) elastic.set_rest_length(rest_length);
    ++counts.rejected;
    return refusal;
  }
  work.active += active;
  work.contact -= contact.energy(x) - barrier;
  accept();
  return {};
}

/// Backward Euler errs by dt^2/2 times the acceleration, which the change of velocity tells. Not asked of the first
/// step, whose loads come at once, nor of the shortest.
bool Implicit::Impl::too_long() {
  if (options.step_tolerance <= 0 || state.step == 0) return false;
  double error = 0;
  for (std::size_t i = 0; i < x.size(); ++i)
    error = std::max(error, 0.25 * (x[i] - x0[i] - dt * state.v[i]).squaredNorm());
  error = std::sqrt(error);
  growth = std::clamp(0.9 * std::sqrt(options.step_tolerance / std::max(error, 1e-12)), 0.3, 1.5);
  return error > options.step_tolerance && dt >= 2 * options.least_time_step;
}

void Implicit::Impl::accept() {
  work.relaxation += elastic.end_step(x);
  for (std::size_t i = 0; i < x.size(); ++i) {
    const Vec3 d = x[i] - x0[i];
    work.external += load[i].dot(d);
    work.damping += mass[i] * options.drag / dt * d.squaredNorm();
    state.v[i] = d / dt;
  }
  for (std::size_t h = 0; h < model.hinges.size(); ++h) {
    state.hinge_rate[h] = (angle[h] - angle0[h]) / dt;
    work.damping += model.hinges[h].damping * state.hinge_rate[h] * (angle[h] - angle0[h]);
  }
  state.x = x, state.hinge_angle = angle;
  state.time = t1;
  ++state.step, ++counts.steps;
}

void Implicit::Impl::advance_to(double time) {
  const double end = time * (1 - 1e-12);
  while (state.time < end) {
    const double left = time - state.time;
    const double length = left / std::ceil(left / step_length * (1 - 1e-9));
    const auto refusal = step(length);
    if (refusal.empty()) {
      if (left - length < 1e-9 * left) state.time = time;
      step_length = std::min(options.time_step, std::max(options.least_time_step, growth * length));
      continue;
    }
    step_length = 0.5 * length;
    if (step_length < options.least_time_step) {
      keep();
      throw NumericalFailure(
          fmt::format("{} at {:.2f} s of labour, in a step of {:.3g} s, the shortest allowed; the "
                      "state kept is that of {:.2f} s",
                      refusal, t1, length, state.time));
    }
  }
  keep();
}

}  // namespace carus::solve
