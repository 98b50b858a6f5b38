// SPDX-License-Identifier: Apache-2.0
// Waves, relaxation and impact, by the explicit solver.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "carus/fem/constraints.hpp"
#include "carus/verify/contact_scenes.hpp"
#include "carus/verify/suite.hpp"

namespace carus::verify {
namespace {

constexpr double shear = 20e3, side = 0.1;  // [Pa], [m]

/// Two bars that cannot move sideways; the lower one runs into the upper.
struct Bars {
  static constexpr double length = 0.1, width = 0.01, gap = 1e-4, speed = 0.2;
  static constexpr int cells = 40;
  fem::Model model;
  std::size_t nodes_of_one;
  Bars() {
    const auto material = soft(material::Law::neo_hooke, shear, 0.3);
    const auto one = mesh::shapes::box({0, 0, -length - gap}, {width, width, length}, 2, 2, cells, 0);
    nodes_of_one = one.nodes.size();
    model = of(mesh::shapes::join(one, mesh::shapes::box({0, 0, 0}, {width, width, length}, 2, 2, cells, 1)),
               {material, material});
    block(model, fem::x | fem::y, [](const Vec3&) { return true; });
    model.contact_surfaces = {flat_face(model.mesh, "lower", 0, -gap), flat_face(model.mesh, "upper", 1, 0)};
    model.contact_pairs = {{0, 1, 0}};
  }
};

}  // namespace

std::vector<Check> wave() {
  constexpr double length = 0.4;
  constexpr int cells = 100;
  auto m = of(mesh::shapes::box(Vec3::Zero(), {0.008, 0.008, length}, 2, 2, cells),
              {soft(material::Law::neo_hooke, shear, 0.3)});
  block(m, fem::x | fem::y, [](const Vec3&) { return true; });
  block(m, fem::z, [](const Vec3& X) { return on(X.z(), length); });
  const double c = wave_speed(m.regions[0].material);
  solve::Explicit s(m, real_time(0.06, 5e-5));
  // A Gauss pulse that travels one way: u = A g(z - c t), 12 cells wide, so that dispersion stays below 1 %.
  constexpr double width = 0.024, start = 0.1, height = 1e-4, travel = 0.2;
  const auto pulse = [](double z) { return height * std::exp(-std::pow((z - start) / width, 2)); };
  const double late = s.step_report().time_step / 2;  // velocities live half a step before positions
  set(s, [&](fem::State& st) {
    for (std::size_t i = 0; i < st.x.size(); ++i) {
      const double z = m.mesh.nodes[i].z(), back = z + c * late;
      st.x[i].z() += pulse(z);
      st.v[i].z() = 2 * c * (back - start) / (width * width) * pulse(back);
    }
  });
  s.advance_to(travel / c);
  double moment = 0, sum_u2 = 0;
  for (std::size_t i = 0; i < s.state().x.size(); ++i) {
    const double u = s.state().x[i].z() - m.mesh.nodes[i].z();
    moment += u * u * m.mesh.nodes[i].z(), sum_u2 += u * u;
  }
  // Lumped linear elements are late by (k h)^2/24, 0.2 % at six cells per half width.
  return {{"speed", "m/s", "explicit", c, (moment / sum_u2 - start) / s.state().time, 0.01}};
}

std::vector<Check> prony_relaxation() {
  auto material = soft(material::Law::neo_hooke, shear, 0.45);
  material.prony = {{0.3, 5.0}, {0.4, 40.0}};
  auto m = of(mesh::shapes::box(Vec3::Zero(), Vec3::Constant(side), 3, 3, 3), {material});
  constexpr double gamma = 0.3, jump = 0.1;  // [s of the run]
  for (const double height : {0.0, side / 3, 2 * side / 3, side}) {
    fem::Motion shift;
    shift.nodes = nodes_where(m.mesh, [=](const Vec3& X) { return on(X.y(), height); });
    shift.displacement = [=](double t) { return Vec3(gamma * height * std::min(1.0, t / jump), 0, 0); };
    m.motions.push_back(shift);
  }
  auto o = real_time(1, 2e-4);
  o.labour_duration = 100, o.max_node_speed = 1e6;
  solve::Explicit s(m, o);
  std::vector<Check> checks;
  for (const double t : {1.0, 10.0, 50.0, 100.0}) {
    s.advance_to(t);
    const auto reaction = s.observe().reaction;
    double stress = 0;  // sum f_x y = P_xy V
    for (std::size_t i = 0; i < reaction.size(); ++i)
      stress += reaction[i].x() * m.mesh.nodes[i].y() / std::pow(side, 3);
    double left = 1;
    // The jump is a ramp of 0.1 s.
    for (const auto& p : material.prony)
      left -= p.g * (1 - std::exp(-t / p.tau) * std::expm1(jump / p.tau) / (jump / p.tau));
    // Single precision; the reaction is that of the step before.
    checks.push_back({fmt::format("stress after {:g} s", t), "Pa", "explicit", shear * gamma * left, stress, 2e-3});
  }
  return checks;
}

std::vector<Check> prony_creep() {
  // One branch: strain = F/G0/(1 - g) (1 - g exp(-t (1 - g)/tau)).
  constexpr double g = 0.5, tau = 4, stress = 0.02 * shear;
  auto material = soft(material::Law::neo_hooke, shear, 0.3);
  material.prony = {{g, tau}};
  auto m = of(mesh::shapes::box(Vec3::Zero(), Vec3::Constant(side), 4, 4, 4), {material});
  block(m, fem::all, [](const Vec3& X) { return on(X.y(), 0); });
  block(m, fem::y | fem::z, [](const Vec3&) { return true; });
  fem::PressureLoad pull;
  pull.surface = facets(m.mesh, [](const Vec3& X) { return on(X.y(), side); });
  pull.pressure = [](double) { return -stress; };
  pull.directed = true, pull.direction = Vec3(1, 1, 0).normalized();  // normal y: half of p goes sideways
  m.pressures = {pull};
  auto o = real_time(4, 4e-4, 0);
  o.labour_duration = 40, o.drag = 10 * 60;
  solve::Explicit s(m, o);
  std::vector<Check> checks;
  for (const double t : {4.0, 8.0, 20.0, 40.0}) {
    s.advance_to(t);
    double slide = 0;
    const auto top = nodes_where(m.mesh, [](const Vec3& X) { return on(X.y(), side); });
    for (const auto i : top) slide += (s.state().x[i].x() - m.mesh.nodes[i].x()) / double(top.size()) / side;
    const double strain = 0.5 * stress / shear / (1 - g) * (1 - g * std::exp(-t * (1 - g) / tau));
    // Drag lets the load's jump arrive some tenths of a second late.
    checks.push_back({fmt::format("shear strain after {:g} s", t), "-", "explicit", strain, slide, 0.02});
  }
  return checks;
}

std::vector<Check> elastic_impact() {
  const Bars bars;
  const auto& m = bars.model;
  const double c = wave_speed(m.regions[0].material), touch = Bars::gap / Bars::speed, contact = 2 * Bars::length / c;
  solve::Explicit s(m, real_time(touch + 2 * contact, 2e-5));
  set(s, [&](fem::State& st) {
    for (std::size_t i = 0; i < bars.nodes_of_one; ++i) st.v[i] = Vec3(0, 0, Bars::speed);
  });
  const auto one = fem::lumped_mass(m, {0}), two = fem::lumped_mass(m, {1});
  double mass = 0, first = 0, last = 0;
  for (const double k : one) mass += k;
  const double before = 0.5 * mass * Bars::speed * Bars::speed;
  double energy = 0, momentum[2] = {0, 0};
  constexpr int stops = 400;
  for (int k = 1; k <= stops; ++k) {
    s.advance_to(k * (touch + 2 * contact) / stops);
    const auto o = s.observe();
    const double force = std::abs(force_on(m, o, 0).z());
    // A tenth of the plateau rho c v A/2 tells contact from what rings.
    if (force > 0.1 * 0.5 * 1000 * c * Bars::speed * Bars::width * Bars::width) {
      if (first == 0) first = s.state().time;
      last = s.state().time;
    }
    if (k == stops) energy = o.kinetic + o.internal;
  }
  for (std::size_t i = 0; i < one.size(); ++i) {
    momentum[0] += one[i] * s.state().v[i].z(), momentum[1] += two[i] * s.state().v[i].z();
  }
  const double p = mass * Bars::speed;
  // A front of some cells' width arrives where theory has a jump: rings behind it, a front that leaves late.
  return {{"momentum", "N s", "explicit", p, momentum[0] + momentum[1], 1e-5},
          {"energy", "J", "explicit", before, energy, 0.03},
          {"momentum passed on", "N s", "explicit", p, momentum[1], 0.03},
          {"time of contact, 2 L/c", "s", "explicit", contact, last - first, 0.08}};
}

}  // namespace carus::verify
