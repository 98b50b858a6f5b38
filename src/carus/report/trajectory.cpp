// SPDX-License-Identifier: Apache-2.0
#include "carus/report/trajectory.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>

#include "carus/core/error.hpp"
#include "carus/core/parallel.hpp"
#include "carus/core/units.hpp"
#include "carus/results/figures.hpp"

namespace carus::report {
namespace {

constexpr double most_rows = 5e6;

double over(double value, double limit) { return std::abs(value) / limit; }

/// The rotation vectors that differ from `r` by whole turns are r (1 + 360 k/|r|): the one nearest to `before`.
Vec3 unwrapped(const Vec3& r, const Vec3& before) {
  const double angle = r.norm();
  if (angle < 1e-9) return r;
  Vec3 best = r;
  for (const int k : {-2, -1, 1, 2}) {
    const Vec3 other = r * (1 + 360.0 * k / angle);
    if ((other - before).norm() < (best - before).norm()) best = other;
  }
  return best;
}

/// A cubic through each component.
class VectorCubic {
 public:
  VectorCubic(const std::vector<double>& t, const std::vector<Vec3>& v)
      : x_(t, component(v, 0)), y_(t, component(v, 1)), z_(t, component(v, 2)) {}
  [[nodiscard]] Vec3 value(double t) const { return {x_.value(t), y_.value(t), z_.value(t)}; }
  [[nodiscard]] Vec3 slope(double t) const { return {x_.slope(t), y_.slope(t), z_.slope(t)}; }

 private:
  static std::vector<double> component(const std::vector<Vec3>& v, int k) {
    std::vector<double> out;
    for (const auto& e : v) out.push_back(e[k]);
    return out;
  }
  MonotoneCubic x_, y_, z_;
};

Eigen::Quaterniond quaternion(const Vec3& rotation_deg) {
  const double angle = rotation_deg.norm() * units::deg;
  return angle < 1e-12 ? Eigen::Quaterniond::Identity()
                       : Eigen::Quaterniond(Eigen::AngleAxisd(angle, rotation_deg.normalized()));
}

/// Angular velocity of a rotation vector r that changes at the rate dr:
///   w = dr + (1 - cos a)/a² r × dr + (a - sin a)/a³ r × (r × dr),  a = |r|
Vec3 angular_velocity(const Vec3& r, const Vec3& dr) {
  const double a = r.norm();
  const double first = a < 1e-4 ? 0.5 : (1 - std::cos(a)) / (a * a);
  const double second = a < 1e-3 ? 1.0 / 6 : (a - std::sin(a)) / (a * a * a);
  return dr + first * r.cross(dr) + second * r.cross(r.cross(dr));
}

/// How much slower it must go for its limits; throws if it may not, or if that cures nothing.
double needed_stretch(const Motion& m, const MonotoneCubic& s, const std::vector<double>& points,
                      const TrajectoryOptions& o) {
  const auto fast = s.steepest(), curved = s.most_curved();
  const auto [low, high] = std::minmax_element(points.begin(), points.end());
  std::vector<std::string> problems;
  double stretch = 1;
  // In time stretched by k speeds are 1/k, accelerations 1/k² of what they were.
  if (o.limits.speed && over(fast.value, *o.limits.speed) > 1) {
    stretch = std::max(stretch, over(fast.value, *o.limits.speed));
    problems.push_back(fmt::format("speed along the axis: {:.4g} mm/s at {:.1f} s; allowed {:.4g} mm/s", fast.value,
                                   fast.time, *o.limits.speed));
  }
  if (o.limits.acceleration && over(curved.value, *o.limits.acceleration) > 1) {
    stretch = std::max(stretch, std::sqrt(over(curved.value, *o.limits.acceleration)));
    problems.push_back(fmt::format("acceleration along the axis: {:.4g} mm/s2 at {:.1f} s; allowed {:.4g} mm/s2",
                                   curved.value, curved.time, *o.limits.acceleration));
  }
  for (auto& p : problems) p += fmt::format("; --slow-down stretches time by {:.4g}", stretch);
  if (o.slow_down) problems.clear();
  if (o.limits.stroke && *high - *low > *o.limits.stroke) {
    problems.push_back(
        fmt::format("stroke along the axis: {:.2f} mm, from {:.2f} at {:.1f} s to {:.2f} at {:.1f} s; allowed {:.4g} "
                    "mm; slowing down "
                    "does not shorten it, another --axis may",
                    *high - *low, *low, m.time[std::size_t(low - points.begin())], *high,
                    m.time[std::size_t(high - points.begin())], *o.limits.stroke));
  }
  if (!problems.empty()) throw InputError(problems);
  return stretch * (stretch > 1 ? 1 + 1e-9 : 1);  // not over by the last digit
}

void name_columns(Trajectory& t) {
  t.columns = {"time_s",          "labour_time_s",   "head_x_mm",       "head_y_mm",       "head_z_mm",
               "turn_x_deg",      "turn_y_deg",      "turn_z_deg",      "quaternion_w",    "quaternion_x",
               "quaternion_y",    "quaternion_z",    "velocity_x_mm_s", "velocity_y_mm_s", "velocity_z_mm_s",
               "angular_x_deg_s", "angular_y_deg_s", "angular_z_deg_s"};
  if (t.has_wrench)
    t.columns.insert(t.columns.end(),
                     {"force_x_n", "force_y_n", "force_z_n", "moment_x_nm", "moment_y_nm", "moment_z_nm"});
  t.columns.insert(t.columns.end(), {"axis_mm", "axis_speed_mm_s", "axis_acceleration_mm_s2", "imposed_linear_mm"});
  if (t.has_cyclic) t.columns.push_back("imposed_cyclic_mm");
}

void append(std::vector<double>& row, const Vec3& v) { row.insert(row.end(), {v[0], v[1], v[2]}); }

}  // namespace

Motion motion_of(const Folder& folder, bool to_end) {
  const auto& table = folder.curves;
  const auto column = [&](const std::string& name) {
    auto v = table.column(name);
    if (v.empty())
      throw InputError(fmt::format("{}: has no column {}; run the birth again with this version of carus",
                                   (folder.path / "curves.csv").string(), name));
    return v;
  };
  std::size_t n = table.rows.size();
  if (!to_end) {
    for (const auto& m : observe::milestones(table)) {
      if (m.name == "birth") n = std::min(n, m.row + 1);
    }
  }
  Motion m;
  const auto time = column("time_s"), travel = column("head_travel_mm");
  std::vector<observe::Values> parts;
  for (const char* name :
       {"head_x_mm", "head_y_mm", "head_z_mm", "head_turn_x_deg", "head_turn_y_deg", "head_turn_z_deg"})
    parts.push_back(column(name));
  for (std::size_t i = 0; i < n; ++i) {
    const Vec3 u(parts[0][i], parts[1][i], parts[2][i]), r(parts[3][i], parts[4][i], parts[5][i]);
    if (!u.allFinite() || !r.allFinite() || !std::isfinite(travel[i]))
      throw InputError(fmt::format("{}: line {}: the head's pose is not finite; run the birth again",
                                   (folder.path / "curves.csv").string(), i + 2));
    m.time.push_back(time[i]), m.displacement.push_back(u), m.travel.push_back(travel[i]);
    m.rotation.push_back(m.rotation.empty() ? r : unwrapped(r, m.rotation.back()));
  }
  if (n < 2)
    throw InputError(fmt::format("{}: one output is no trajectory; wait for the run, or run the birth again",
                                 (folder.path / "curves.csv").string()));
  return m;
}

void add_wrench(Motion& motion, const Folder& folder, std::vector<std::string>& notes) {
  try {
    const auto entries = read_frame_index(folder.path / "frames.pvd");
    if (entries.empty()) throw InputError((folder.path / "frames.pvd").string() + ": names no frames");
    const auto mesh = read_frame_mesh(entries.front().file);
    const Head head(mesh, entries.front().file.string());
    std::vector<std::optional<Wrench>> wrench(entries.size());
    std::vector<std::string> problems(entries.size());
    parallel::for_chunks(entries.size(), 8, [&](std::size_t begin, std::size_t end, std::size_t) {
      for (std::size_t k = begin; k < end; ++k) {
        try {
          wrench[k] = head.contact(read_frame_state(entries[k].file, mesh.nodes.size(), mesh.tets.size()));
        } catch (const InputError& e) {
          problems[k] = e.what();
        }
      }
    });
    for (std::size_t k = 0; k < entries.size(); ++k) {
      if (wrench[k]) {
        motion.wrench_time.push_back(entries[k].time), motion.wrench.push_back(*wrench[k]);
      } else {
        notes.push_back(fmt::format("wrench at {:.1f} s left out: {}", entries[k].time, problems[k]));
      }
    }
    motion.start = 1e3 * head.rest_centre();
  } catch (const InputError& e) {
    notes.push_back(fmt::format("no wrench: {}", e.what()));
  }
}

const char* name_of(Axis axis) {
  switch (axis) {
    case Axis::chord:
      return "chord";
    case Axis::z:
      return "z";
    case Axis::path:
      return "path";
  }
  CARUS_ASSERT(false);
}

Vec3 direction(const Motion& m, Axis axis) {
  if (axis == Axis::path) return Vec3::Zero();
  const Vec3 chord = m.displacement.back() - m.displacement.front();
  if (axis == Axis::z || chord.norm() < 1e-9) return -Vec3::UnitZ();
  return chord.normalized();
}

std::vector<double> along(const Motion& m, Axis axis) {
  const Vec3 a = direction(m, axis);
  std::vector<double> s;
  for (std::size_t i = 0; i < m.time.size(); ++i) {
    s.push_back(axis == Axis::path ? m.travel[i] - m.travel[0] : a.dot(m.displacement[i] - m.displacement[0]));
  }
  return s;
}

double Reference::at(double t) const {
  if (t <= time.front()) return value.front();
  if (t >= time.back()) return value.back();
  const auto i = std::size_t(std::upper_bound(time.begin(), time.end(), t) - time.begin());
  return value[i - 1] + (value[i] - value[i - 1]) * (t - time[i - 1]) / (time[i] - time[i - 1]);
}

Reference imposed_linear(double duration, double amplitude) { return {{0, duration}, {0, amplitude}}; }

Reference imposed_cyclic(double duration, double amplitude, const labour::Contractions& c, double recession) {
  std::vector<double> starts = results::contraction_starts(c, duration);
  while (!starts.empty() && starts.back() >= duration) starts.pop_back();
  if (starts.empty()) return imposed_linear(duration, amplitude);
  const auto n = double(starts.size());
  // n advances less n - 1 recessions make the amplitude.
  const double advance = amplitude / (n - (n - 1) * recession);
  Reference r{{0}, {0}};
  const auto add = [&](double t, double v) {
    if (t > r.time.back()) {
      r.time.push_back(t), r.value.push_back(v);
    } else {
      r.value.back() = v;
    }
  };
  double at = 0;
  for (std::size_t k = 0; k < starts.size(); ++k) {
    add(starts[k], at);
    add(std::min(starts[k] + c.duration - c.fall, duration), at += advance);
    if (k + 1 < starts.size()) at -= recession * advance;
  }
  add(duration, amplitude);
  return r;
}

Trajectory resample(const Motion& m, const std::optional<labour::Contractions>& contractions,
                    const TrajectoryOptions& o) {
  Trajectory t;
  t.options = o;
  const auto points = along(m, o.axis);
  const MonotoneCubic axis(m.time, points);
  const double k = t.time_stretch = needed_stretch(m, axis, points, o);
  t.speed = axis.steepest(), t.acceleration = axis.most_curved();
  t.speed = {t.speed.time * k, t.speed.value / k},
  t.acceleration = {t.acceleration.time * k, t.acceleration.value / (k * k)};
  const auto [low, high] = std::minmax_element(points.begin(), points.end());
  t.stroke_low = *low, t.stroke_high = *high;
  t.axis_direction = direction(m, o.axis), t.start = m.start;
  t.has_wrench = !m.wrench.empty(), t.has_cyclic = contractions.has_value();
  name_columns(t);

  const double begin = m.time.front(), duration = m.time.back() - begin;
  if (duration * k * o.rate > most_rows)
    throw InputError(fmt::format("{:.0f} s at {:g} Hz are {:.2g} rows; allowed {:.0e}; lower --rate", duration * k,
                                 o.rate, duration * k * o.rate, most_rows));
  const VectorCubic displacement(m.time, m.displacement), rotation(m.time, m.rotation);
  std::vector<Vec3> forces, moments;
  for (const auto& w : m.wrench) forces.push_back(w.force), moments.push_back(w.moment);
  std::optional<VectorCubic> force, moment;
  if (t.has_wrench) force.emplace(m.wrench_time, forces), moment.emplace(m.wrench_time, moments);
  const auto linear = imposed_linear(m.time.back(), points.back());
  const auto cyclic =
      contractions ? imposed_cyclic(m.time.back(), points.back(), *contractions, imposed_recession) : linear;

  // The last row is the end itself, whatever the rate.
  const auto steps = std::size_t(std::ceil(duration * k * o.rate - 1e-9));
  for (std::size_t i = 0; i <= steps; ++i) {
    const double now = std::min(double(i) / o.rate, duration * k), then = i == steps ? m.time.back() : begin + now / k;
    std::vector<double> row = {now, then};
    const Vec3 r = rotation.value(then);
    append(row, displacement.value(then)), append(row, r);
    Eigen::Quaterniond q = quaternion(r);
    if (q.w() < 0) q.coeffs() *= -1;
    row.insert(row.end(), {q.w(), q.x(), q.y(), q.z()});
    append(row, displacement.slope(then) / k);
    append(row, angular_velocity(r * units::deg, rotation.slope(then) / k));
    if (force) append(row, force->value(then)), append(row, moment->value(then));
    row.insert(row.end(), {axis.value(then), axis.slope(then) / k, axis.curvature(then) / (k * k), linear.at(then)});
    if (t.has_cyclic) row.push_back(cyclic.at(then));
    t.rows.push_back(std::move(row));
  }
  return t;
}

std::string as_csv(const Trajectory& t) {
  std::string out;
  for (const auto& name : t.columns) out += (out.empty() ? "" : ",") + name;
  out += '\n';
  for (const auto& row : t.rows) {
    for (std::size_t c = 0; c < row.size(); ++c)
      fmt::format_to(std::back_inserter(out), "{}{:.9g}", c == 0 ? "" : ",", row[c]);
    out += '\n';
  }
  return out;
}

std::string as_json(const Trajectory& t, const Folder& folder) {
  using Json = nlohmann::ordered_json;
  const auto vec = [](const Vec3& v) { return Json::array({v[0], v[1], v[2]}); };
  const auto limit = [](const std::optional<double>& v) { return v ? Json(*v) : Json(nullptr); };
  Json j;
  j["format"] = "carus-trajectory-1";
  j["source"] = {{"scenario", folder.name()}, {"folder", folder.path.string()}, {"status", name_of(folder.status)}};
  j["frame"] = {
      {"axes", "RAS: x to the mother's right, y anterior, z cranial"},
      {"origin", "centre of the pelvic inlet"},
      {"head_centre_at_start_mm", t.has_wrench ? vec(t.start) : Json(nullptr)},
      {"position", "displacement of the skull's centre from its start"},
      {"rotation", "from the start: turn is axis times angle; quaternion w, x, y, z; fixed axes"},
      {"wrench", t.has_wrench ? Json("contact forces of the mother's tissues on the head, moment about its centre")
                              : Json(nullptr)}};
  j["units"] = {{"time", "s"},  {"length", "mm"},  {"angle", "deg"},
                {"force", "N"}, {"moment", "N m"}, {"speed", "mm/s, deg/s"}};
  j["rate_hz"] = t.options.rate;
  j["time_stretch"] = t.time_stretch;
  j["interpolation"] = {{"kind", "monotone cubic (Fritsch and Butland), continuous velocity"}, {"overshoot_mm", 0}};
  j["axis"] = {{"kind", name_of(t.options.axis)},
               {"direction", t.options.axis == Axis::path ? Json(nullptr) : vec(t.axis_direction)},
               {"low_mm", t.stroke_low},
               {"high_mm", t.stroke_high},
               {"largest_speed", {{"time_s", t.speed.time}, {"mm_s", t.speed.value}}},
               {"largest_acceleration", {{"time_s", t.acceleration.time}, {"mm_s2", t.acceleration.value}}}};
  j["limits"] = {{"speed_mm_s", limit(t.options.limits.speed)},
                 {"acceleration_mm_s2", limit(t.options.limits.acceleration)},
                 {"stroke_mm", limit(t.options.limits.stroke)}};
  j["imposed"] = {
      {"linear", "constant speed over the same time to the same place"},
      {"cyclic", t.has_cyclic ? Json(fmt::format("straight down in each contraction, back by {:g} of that in each rest",
                                                 imposed_recession))
                              : Json(nullptr)}};
  j["columns"] = t.columns;
  std::string head = j.dump(1, ' ', false, Json::error_handler_t::replace);
  head.erase(head.find_last_of('}'));
  while (head.back() == '\n' || head.back() == ' ') head.pop_back();
  std::string out = head + ",\n \"rows\": [";
  for (std::size_t i = 0; i < t.rows.size(); ++i) {
    out += i == 0 ? "\n  [" : ",\n  [";
    for (std::size_t c = 0; c < t.rows[i].size(); ++c)
      fmt::format_to(std::back_inserter(out), "{}{:.9g}", c == 0 ? "" : ",", t.rows[i][c]);
    out += ']';
  }
  return out + "\n ]\n}\n";
}

}  // namespace carus::report
