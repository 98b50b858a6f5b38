// SPDX-License-Identifier: Apache-2.0
// Contact on flat and curved surfaces, by the explicit solver.
#include <Eigen/LU>
#include <algorithm>
#include <cmath>

#include "carus/observe/penetration.hpp"
#include "carus/solve/mass.hpp"
#include "carus/verify/closed_forms.hpp"
#include "carus/verify/contact_scenes.hpp"
#include "carus/verify/suite.hpp"

namespace carus::verify {
namespace {

constexpr double shear = 20e3;  // [Pa]

/// Slider on the inside of a rigid circular track about the y axis: a physical pendulum of length r about the track's
/// axis.
struct Slider {
  static constexpr double track = 0.1, half_length = 0.006, height = 0.008, width = 0.008, g = 10,
                          start = 50 * pi / 180;
  static double r() { return std::sqrt(track * track - half_length * half_length) - height / 2; }
  /// r^2 + k^2 with k the radius of gyration of the block.
  static double inertia() { return r() * r() + (4 * half_length * half_length + height * height) / 12; }
  static double speed_at_bottom() { return r() * std::sqrt(2 * g * r() * (1 - std::cos(start)) / inertia()); }
  /// Quarter of a period: K(sin(start/2))/omega, by the arithmetic-geometric mean.
  static double time_to_bottom() {
    double a = 1, b = std::cos(start / 2);
    for (int i = 0; i < 20; ++i) {
      const double mean = 0.5 * (a + b);
      b = std::sqrt(a * b), a = mean;
    }
    return pi / 2 / a / std::sqrt(g * r() / inertia());
  }
};

fem::Model slider_on_track() {
  const auto stiff = soft(material::Law::neo_hooke, 10 * shear, 0.3);
  // Rests on its lower edges at the angle `start`, a hair above the track.
  auto block_mesh =
      mesh::shapes::box({-Slider::half_length, -Slider::width / 2, -Slider::r() - Slider::height / 2 + 1e-5},
                        {2 * Slider::half_length, Slider::width, Slider::height}, 3, 2, 2, 0);
  const Mat3 R = Eigen::AngleAxisd(Slider::start, Vec3::UnitY()).toRotationMatrix();
  for (Vec3& x : block_mesh.nodes) x = R * x;
  const auto arc = mesh::shapes::grid(
      120, 1, 1,
      [](const Vec3& u) {
        const double angle = (2 * u.x() - 1) * 75 * pi / 180, radius = Slider::track + 0.01 * (1 - u.z());
        return Vec3(radius * std::sin(angle), 0.04 * (u.y() - 0.5), -radius * std::cos(angle));
      },
      1);
  auto m = of(mesh::shapes::join(block_mesh, arc), {stiff, stiff});
  m.regions[1].rigid = true;
  fem::ContactSurface under{"slider", {}}, inside{"track", {}};
  for (const auto& t : mesh::boundary(m.mesh, [](int l) { return l == 0; })) {
    const auto low = [&](auto n) {
      return (R.transpose() * m.mesh.nodes[n]).z() < -Slider::r() - 0.49 * Slider::height;
    };
    if (std::all_of(t.begin(), t.end(), low)) under.triangles.push_back(t);
  }
  for (const auto& t : mesh::boundary(m.mesh, [](int l) { return l == 1; })) {
    const auto near = [&](auto n) {
      const Vec3& X = m.mesh.nodes[n];
      return on(std::hypot(X.x(), X.z()), Slider::track);
    };
    if (std::all_of(t.begin(), t.end(), near)) inside.triangles.push_back(t);
  }
  m.contact_surfaces = {under, inside};
  m.contact_pairs = {{0, 1, 0}};
  m.body_forces = {{"gravity", {}, [](double) { return Vec3(0, 0, -Slider::g); }}};
  return m;
}

}  // namespace

std::vector<Check> contact_patch() {
  constexpr double a = 0.06, h = 0.03, pressure = 2e3;
  const auto material = soft(material::Law::neo_hooke, shear, 0.3);
  auto m = of(mesh::shapes::join(mesh::shapes::box({0, 0, 0}, {a, a, h}, 5, 5, 3, 0),
                                 mesh::shapes::box({0, 0, h}, {a, a, h}, 7, 6, 3, 1)),
              {material, material});
  block(m, fem::x, [](const Vec3& X) { return on(X.x(), 0); });
  block(m, fem::y, [](const Vec3& X) { return on(X.y(), 0); });
  block(m, fem::z, [](const Vec3& X) { return on(X.z(), 0); });
  m.contact_surfaces = {flat_face(m.mesh, "lower", 0, h), flat_face(m.mesh, "upper", 1, h)};
  m.contact_pairs = {{0, 1, 0}};
  m.pressures = {press(m.mesh, 2 * h, pressure, 0.1)};
  solve::Explicit s(m, real_time(1, 1e-4, 60));
  s.advance_to(0.9);
  s.advance_to(1);  // the force is the mean over this stretch
  double worst = 0;
  for (std::size_t e = 0; e < m.mesh.tets.size(); ++e) {
    // First Piola stress is the dead load per rest area; here: Cauchy times the area's growth.
    const Mat3 F = deformation_gradient(m.mesh, e, s.state().x);
    const double P = (F.determinant() * neo_hooke_stress(m, e, s.state().x) * F.inverse().transpose())(2, 2);
    const double stress = -P / (F(0, 0) * F(1, 1));
    if (std::abs(stress - pressure) > std::abs(worst - pressure) || worst == 0) worst = stress;
  }
  const auto exact = observe::PenetrationCheck(m, 1e-3).check(s.state().x)[0];
  const Vec3 corner = s.state().x.back();  // the loaded face has grown sideways
  const double load = pressure * corner.x() * corner.y();
  // Node-to-facet both ways is over-determined: each node carries its own share, not that of its facets.
  return {{"stress, worst element", "Pa", "explicit", pressure, worst, 0.04},
          {"force passed on", "N", "explicit", load, force_on(m, s.observe(), 1).z(), 0.002},
          {"least gap, exact search", "m", "explicit", 0, std::min(0.0, exact.least_gap), 1e-5, 1}};
}

std::vector<Check> curved_slide() {
  const auto m = slider_on_track();
  const auto solid = [&](std::size_t i) { return m.blocked[i] != fem::all && i < 4 * 3 * 3; };
  auto o = real_time(1.2 * Slider::time_to_bottom(), 2e-5);
  o.contact_search = 0.002;
  solve::Explicit s(m, o);
  const auto mass = solve::scaled_masses(m, s.step_report().time_step, o.safety).scaled;
  double time = NAN, speed = NAN, before = 0, before_t = 0;
  for (int k = 1; k <= 240; ++k) {
    s.advance_to(k * o.labour_duration / 240);
    Vec3 x = Vec3::Zero(), v = x;
    double sum = 0;
    for (std::size_t i = 0; i < mass.size(); ++i) {
      if (solid(i)) x += mass[i] * s.state().x[i], v += mass[i] * s.state().v[i], sum += mass[i];
    }
    x /= sum, v /= sum;
    if (std::isnan(time) && x.x() >= 0) {
      time = before_t + (s.state().time - before_t) * -before / (x.x() - before);
      speed = v.norm();
    }
    before = x.x(), before_t = s.state().time;
  }
  // Facets of 2 mm under edges 12 mm apart; the block's ringing.
  return {{"speed of the centre at the bottom", "m/s", "explicit", Slider::speed_at_bottom(), speed, 0.005},
          {"time to the bottom", "s", "explicit", Slider::time_to_bottom(), time, 0.005}};
}

}  // namespace carus::verify
