// SPDX-License-Identifier: Apache-2.0
#include "carus/solve/implicit.hpp"

#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <limits>

#include "carus/contact/intersection.hpp"
#include "carus/core/error.hpp"
#include "carus/core/stopwatch.hpp"
#include "carus/fem/constraints.hpp"
#include "carus/fem/elastic.hpp"
#include "carus/fem/pressure.hpp"
#include "carus/fem/retraction.hpp"
#include "carus/solve/energy.hpp"
#include "carus/solve/freedom.hpp"
#include "carus/solve/pcg.hpp"

namespace carus::solve {

namespace {

enum Stage { elements, assembly, linear, line_search, contact_forces, collision, loads, proof, stage_count };
constexpr const char* stage_names[stage_count] = {
    "elements", "assembly", "linear solve", "line search", "contact forces", "collision detection", "loads", "proof"};

struct Work {
  double external = 0, contact = 0, damping = 0, active = 0;
};

std::vector<contact::Side> sides_of(const fem::Model& model) {
  std::vector<contact::Side> out;
  for (const auto& s : model.contact_surfaces) out.push_back({s.name, s.triangles});
  return out;
}
std::vector<contact::Touching> touching(const fem::Model& model) {
  std::vector<contact::Touching> out;
  for (const auto& p : model.contact_pairs) out.push_back({p.a, p.b, p.friction});
  return out;
}

/// Why a step did not come about; empty: it did.
using Refusal = std::string;

double largest(const std::vector<Vec3>& u) {
  double most = 0;
  for (const Vec3& v : u) most = std::max(most, v.squaredNorm());
  return std::sqrt(most);
}

}  // namespace

struct Implicit::Impl {
  const fem::Model& model;
  ImplicitOptions options;
  parallel::Threads threads;
  Freedom freedom;
  fem::Elastic elastic;
  fem::RestLength rest_length;
  contact::BarrierPotential contact;
  std::vector<double> mass;                    // [kg] per node, lumped
  std::vector<std::vector<double>> body_mass;  // per body force
  fem::State state;
  Work work;
  double step_length;   // [s] that the next step would like
  double growth = 1.5;  // of it, after an accepted step
  std::vector<double> pressures;
  ImplicitCounts counts;
  NewtonIteration last{};
  double seconds[stage_count] = {};

  // Of the step under way.
  double dt = 0, t1 = 0;
  std::vector<Vec3> x0, x, u;
  std::vector<double> angle0, angle;
  std::vector<Vec3> load, load0;  // at x, and at the start of the step
  std::vector<Vec3> g;
  Unknowns residual, direction;
  std::vector<Mat3> diagonal, preconditioner;
  PcgWork pcg_work;
  mutable std::vector<Vec3> expanded, product;

  Impl(const fem::Model& m, const ImplicitOptions& o)
      : model(m),
        options(o),
        threads(o.threads),
        freedom(m),
        elastic(m),
        rest_length(m),
        contact(sides_of(m), touching(m), m.mesh.nodes, moving(freedom), {o.barrier_distance, o.barrier_pressure}),
        step_length(o.time_step) {
    state.x = model.mesh.nodes;
    state.v.assign(state.x.size(), Vec3::Zero());
    state.hinge_angle.assign(model.hinges.size(), 0.0);
    state.hinge_rate.assign(model.hinges.size(), 0.0);
    mass = fem::lumped_mass(model, {});
    for (const auto& f : model.body_forces) body_mass.push_back(fem::lumped_mass(model, f.regions));
    pressures.assign(model.pressures.size(), 0.0);
    expanded.resize(state.x.size()), product.resize(state.x.size());
    if (rest_length.active()) elastic.set_rest_length(rest_length);
    load = loads_at(state.x, 0);
    if (const auto cut = intersecting(state.x); !cut.empty())
      throw InputError("contact: surfaces cut each other at the start: " + cut +
                       "; the implicit solver keeps apart what is apart; hint: move the bodies or refine their meshes");
    keep();
  }

  static std::vector<std::uint8_t> moving(const Freedom& freedom) {
    std::vector<std::uint8_t> out(freedom.nodes());
    for (std::size_t i = 0; i < out.size(); ++i) out[i] = freedom.moves(i);
    return out;
  }

  /// Empty where no triangles cut each other, else which.
  std::string intersecting(const std::vector<Vec3>& at) {
    const Stopwatch watch(seconds[proof]);
    const auto cuts = contact::intersections(contact.sides(), contact.pairs(), at);
    if (cuts.empty()) return {};
    const auto& c = cuts.front();
    const auto& pair = contact.pairs()[std::size_t(c.pair)];
    const auto& side = contact.sides()[std::size_t(pair.a)];
    const Vec3 where = at[std::size_t(side.triangles[std::size_t(c.first)][0])];
    return fmt::format("{} and {}, facets {} and {} near ({:.1f}, {:.1f}, {:.1f}) mm, {}{} in all", side.name,
                       contact.sides()[std::size_t(pair.b)].name, c.first, c.second, 1e3 * where.x(), 1e3 * where.y(),
                       1e3 * where.z(), cuts.size(), cuts.size() < 20 ? "" : " or more");
  }

  // ---- the potential of a step ----

  std::vector<Vec3> loads_at(const std::vector<Vec3>& at, double t) {
    const Stopwatch watch(seconds[loads]);
    std::vector<Vec3> f(at.size(), Vec3::Zero());
    for (std::size_t l = 0; l < model.pressures.size(); ++l) {
      pressures[l] = model.pressures[l].pressure(t);
      if (pressures[l] != 0) fem::add_pressure_forces(model.pressures[l], pressures[l], at, f);
    }
    fem::add_body_forces(model, body_mass, t, f);
    return f;
  }

  /// Per mass: of drag and inertia.
  double inertia_factor() const {
    return (options.drag > 0 ? options.drag / dt : 0) + (options.inertia ? 1 / (dt * dt) : 0);
  }
  double hinge_factor(const fem::Hinge& h) const {
    return h.stiffness + h.damping / dt + (options.inertia ? h.inertia / (dt * dt) : 0);
  }

  double tether_part(const std::vector<Vec3>& at) const {
    double sum = 0;
    for (const auto& t : model.tethers) {
      const double out = t.direction.dot(at[t.node] - model.mesh.nodes[t.node]);
      sum += 0.5 * t.stiffness * out * out;
    }
    return sum;
  }

  double motion_part(const std::vector<Vec3>& at, const std::vector<double>& turned) const {
    double sum = parallel::sum_chunks(at.size(), unknown_chunk, [&](std::size_t begin, std::size_t end) {
      double part = 0;
      for (std::size_t i = begin; i < end; ++i) {
        const Vec3 d = at[i] - x0[i];
        part += 0.5 * mass[i] * options.drag / dt * d.squaredNorm();
        if (options.inertia) part += 0.5 * mass[i] / (dt * dt) * (d - dt * state.v[i]).squaredNorm();
      }
      return part;
    });
    for (std::size_t h = 0; h < model.hinges.size(); ++h) {
      const auto& hinge = model.hinges[h];
      const double d = turned[h] - angle0[h];
      sum += 0.5 * hinge.stiffness * turned[h] * turned[h] + 0.5 * hinge.damping / dt * d * d;
      if (options.inertia) sum += 0.5 * hinge.inertia * std::pow(d / dt - state.hinge_rate[h], 2);
    }
    return sum;
  }

  double potential(const std::vector<Vec3>& at, const std::vector<double>& turned) {
    const double free = elastic.energy(at) + tether_part(at) + motion_part(at, turned);
    return std::isfinite(free) ? free + contact.energy(at) + contact.friction_energy(at) : free;
  }

  /// dE/dx [N] of all that has a potential, per node.
  void gradient() {
    const Stopwatch watch(seconds[elements]);
    g.assign(x.size(), Vec3::Zero());
    elastic.add_gradient(x, g);
    for (const auto& t : model.tethers)
      g[t.node] += t.stiffness * t.direction.dot(x[t.node] - model.mesh.nodes[t.node]) * t.direction;
  }

  void add_contact_gradient() {
    const Stopwatch watch(seconds[contact_forces]);
    contact.add_gradient(x, g);
    contact.add_friction_gradient(x, g);
  }

  void add_motion_gradient() {
    for (std::size_t i = 0; i < x.size(); ++i) {
      const Vec3 d = x[i] - x0[i];
      g[i] += mass[i] * options.drag / dt * d;
      if (options.inertia) g[i] += mass[i] / (dt * dt) * (d - dt * state.v[i]);
    }
  }

  double hinge_moment(std::size_t h) const {
    const auto& hinge = model.hinges[h];
    const double d = angle[h] - angle0[h];
    return hinge.stiffness * angle[h] + hinge.damping / dt * d +
           (options.inertia ? hinge.inertia / dt * (d / dt - state.hinge_rate[h]) : 0);
  }

  // ---- its second derivatives ----

  void linearise() {
    const Stopwatch watch(seconds[assembly]);
    elastic.linearise(x);
    contact.linearise(x);
    diagonal.resize(x.size());
    elastic.diagonal(diagonal);
    contact.add_diagonal(diagonal);
    const double factor = inertia_factor();
    for (std::size_t i = 0; i < x.size(); ++i) diagonal[i].diagonal().array() += mass[i] * factor;
    for (const auto& t : model.tethers) diagonal[t.node] += t.stiffness * t.direction * t.direction.transpose();
    freedom.reduce_diagonal(diagonal, x, preconditioner);
    for (std::size_t h = 0; h < model.hinges.size(); ++h)
      preconditioner[freedom.nodes() + h](0, 0) += hinge_factor(model.hinges[h]);
    freedom.fill_blocked(preconditioner);
    for (Mat3& m : preconditioner) m = m.inverse().eval();
  }

  /// y = H u over the nodes.
  void multiply_nodes(const std::vector<Vec3>& v, std::vector<Vec3>& y) const {
    elastic.multiply(v, y);
    contact.add_product(v, y);
    const double factor = inertia_factor();
    parallel::for_chunks(v.size(), unknown_chunk, [&](std::size_t begin, std::size_t end, std::size_t) {
      for (std::size_t i = begin; i < end; ++i) y[i] += mass[i] * factor * v[i];
    });
    for (const auto& t : model.tethers) y[t.node] += t.stiffness * t.direction.dot(v[t.node]) * t.direction;
    for (std::size_t l = 0; l < model.pressures.size(); ++l)
      if (pressures[l] != 0) fem::add_pressure_stiffness(model.pressures[l], pressures[l], x, v, y);
  }

  void multiply(const Unknowns& q, Unknowns& y) const {
    freedom.expand(q, x, expanded);
    multiply_nodes(expanded, product);
    freedom.reduce(product, x, y);
    for (std::size_t h = 0; h < model.hinges.size(); ++h)
      y[freedom.nodes() + h].x() += hinge_factor(model.hinges[h]) * q[freedom.nodes() + h].x();
  }

  // ---- Newton ----

  /// Where the motions would have the nodes go from x; zero elsewhere. False where nothing is left to do.
  bool imposed_motion(std::vector<Vec3>& out) const {
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
  void solve_direction(const std::vector<Vec3>* given) {
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

  void move(double a, const std::vector<Vec3>* given, std::vector<Vec3>& to, std::vector<double>& turned) const {
    to = x, turned = angle;
    add_scaled(a, u, to);
    if (given) add_scaled(a, *given, to);
    for (std::size_t h = 0; h < model.hinges.size(); ++h) turned[h] += a * direction[freedom.nodes() + h].x();
    freedom.place(turned, to);
  }

  /// Goes along the direction as far as the potential, less the loads' work on the way, falls. Where motions are
  /// imposed it may rise: then as far as it is finite.
  Refusal search_line(const std::vector<Vec3>* given, double& a) {
    const Stopwatch watch(seconds[line_search]);
    const double before = potential(x, angle);
    const double slope = last.slope = -dot(residual, direction);
    std::vector<Vec3> next;
    std::vector<double> turned;
    a = last.clear = clear_way(given);
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
  double clear_way(const std::vector<Vec3>* given) {
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
  void extrapolate() {
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
  double work_between(const std::vector<Vec3>& next, const std::vector<Vec3>& new_load) const {
    double done = 0;
    for (std::size_t i = 0; i < x.size(); ++i) done += 0.5 * (load[i] + new_load[i]).dot(next[i] - x[i]);
    return done;
  }

  Refusal minimise() {
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
      if (!imposed && a * length <= options.newton_tolerance) return {};
    }
    return fmt::format("no convergence in {} Newton iterations", options.max_iterations);
  }

  // ---- a step ----

  Refusal step(double length) {
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
  bool too_long() {
    if (options.step_tolerance <= 0 || state.step == 0) return false;
    double error = 0;
    for (std::size_t i = 0; i < x.size(); ++i)
      error = std::max(error, 0.25 * (x[i] - x0[i] - dt * state.v[i]).squaredNorm());
    error = std::sqrt(error);
    growth = std::clamp(0.9 * std::sqrt(options.step_tolerance / std::max(error, 1e-12)), 0.3, 1.5);
    return error > options.step_tolerance && dt >= 2 * options.least_time_step;
  }

  void accept() {
    elastic.end_step(x);
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

  void advance_to(double time) {
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

  // ---- state that a checkpoint carries ----

  static constexpr std::size_t fixed_entries = 5;

  void keep() {
    state.rest_length = rest_length.rings();
    state.internal = {work.external, work.contact, work.damping, work.active, step_length};
    const auto history = elastic.save();
    state.internal.insert(state.internal.end(), history.begin(), history.end());
  }

  void restore(const fem::State& from) {
    if (from.x.size() != state.x.size() || from.v.size() != state.v.size() ||
        from.internal.size() != fixed_entries + elastic.history_size() ||
        from.rest_length.size() != state.rest_length.size() || from.hinge_angle.size() != state.hinge_angle.size())
      throw InputError(
          fmt::format("the state to restore is of another model or solver: {} nodes and {} internal values, "
                      "this one has {} and {}; hint: mesh and scenario must be those it was saved with",
                      from.x.size(), from.internal.size(), state.x.size(), fixed_entries + elastic.history_size()));
    state = from;
    const double* p = state.internal.data();
    work = {p[0], p[1], p[2], p[3]}, step_length = p[4];
    elastic.load(p + fixed_entries);
    rest_length.rings() = state.rest_length;
    if (rest_length.active()) elastic.set_rest_length(rest_length);
    load = loads_at(state.x, state.time);
  }

  Observables observe() {
    Observables o;
    o.pressures = pressures;
    if (options.inertia) {
      for (std::size_t i = 0; i < state.v.size(); ++i) o.kinetic += 0.5 * mass[i] * state.v[i].squaredNorm();
      for (std::size_t h = 0; h < model.hinges.size(); ++h)
        o.kinetic += 0.5 * model.hinges[h].inertia * state.hinge_rate[h] * state.hinge_rate[h];
    }
    o.internal = elastic.stored(state.x) + tether_part(state.x);
    for (std::size_t h = 0; h < model.hinges.size(); ++h)
      o.internal += 0.5 * model.hinges[h].stiffness * state.hinge_angle[h] * state.hinge_angle[h];
    o.external_work = work.external, o.contact_work = work.contact, o.damping_work = work.damping;
    o.active_work = work.active;
    const auto volumes = elastic.volumes(state.x);
    o.min_J = volumes.min_J, o.inverted = volumes.inverted;
    o.contact_force.assign(state.x.size(), Vec3::Zero());
    contact.add_gradient(state.x, o.contact_force);
    for (Vec3& f : o.contact_force) f = -f;
    o.least_gap = std::numeric_limits<double>::infinity();
    for (const auto& n : contact.nearest(state.x, options.barrier_distance))
      o.least_gap = std::min(o.least_gap, n.distance);
    o.reaction = reactions();
    o.hinge_angle = state.hinge_angle;
    o.rest_length_mean = rest_length.mean();
    return o;
  }

  /// What the elements of a node at rest would need on its held axes, less the loads.
  std::vector<Vec3> reactions() {
    x = state.x;
    gradient();
    contact.add_gradient(x, g);
    const auto axes = fem::constrained_axes(model);
    std::vector<Vec3> out(x.size(), Vec3::Zero());
    for (std::size_t i = 0; i < out.size(); ++i)
      for (int k = 0; k < 3; ++k)
        if ((axes[i] >> k) & 1) out[i][k] = g[i][k] - load[i][k];
    return out;
  }
};

Implicit::Implicit(const fem::Model& model, const ImplicitOptions& options)
    : impl_(std::make_unique<Impl>(model, options)) {}
Implicit::~Implicit() = default;

void Implicit::advance_to(double time) { impl_->advance_to(time); }
const fem::State& Implicit::state() const { return impl_->state; }
void Implicit::restore(const fem::State& state) { impl_->restore(state); }
Observables Implicit::observe() const { return impl_->observe(); }
ImplicitCounts Implicit::counts() const { return impl_->counts; }

std::vector<double> Implicit::least_distances(double reach) const {
  std::vector<double> out;
  for (const auto& n : impl_->contact.nearest(impl_->state.x, reach)) out.push_back(n.distance);
  return out;
}

std::vector<std::pair<std::string, double>> Implicit::timings() const {
  std::vector<std::pair<std::string, double>> out;
  for (int k = 0; k < stage_count; ++k) out.emplace_back(stage_names[k], impl_->seconds[k]);
  return out;
}

}  // namespace carus::solve
