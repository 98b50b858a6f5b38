// SPDX-License-Identifier: Apache-2.0
#include "carus/results/figures.hpp"

#include <algorithm>
#include <cmath>

namespace carus::results {
namespace {

using observe::Table;
using observe::Values;

/// Columns of a table as they are asked for; an absent one reads as zeros.
class Columns {
 public:
  explicit Columns(const Table& table) : table_(table) {}
  [[nodiscard]] Values operator()(const std::string& name) const {
    auto v = table_.column(name);
    if (v.empty()) v.assign(table_.rows.size(), 0.0);
    return v;
  }

 private:
  const Table& table_;
};

constexpr double extended = 10;  // [deg] less is the give of the neck in a push

double largest(const Values& v, std::size_t n) {
  return n == 0 ? 0 : *std::max_element(v.begin(), v.begin() + std::ptrdiff_t(n));
}
double smallest(const Values& v, std::size_t n) {
  return n == 0 ? 0 : *std::min_element(v.begin(), v.begin() + std::ptrdiff_t(n));
}
double largest_in_size(const Values& v, std::size_t n) {
  const double hi = largest(v, n), lo = smallest(v, n);
  return hi >= -lo ? hi : lo;
}

/// Index of the first output at or after t, within half a millisecond.
std::size_t row_at(const Values& time, double t) {
  return std::size_t(std::lower_bound(time.begin(), time.end(), t - 0.05) - time.begin());
}

const observe::Milestone* find(const std::vector<observe::Milestone>& list, const std::string& name) {
  for (const auto& m : list) {
    if (m.name == name) return &m;
  }
  return nullptr;
}

void head_figures(Figures& f, const Columns& column, std::size_t n) {
  const auto time = column("time_s"), z = column("head_z_mm"), speed = column("head_speed_mm_s");
  for (int k = 0; k < 3; ++k) {
    const auto v = column(std::string("head_") + "xyz"[k] + "_mm");
    f.amplitude[k] = largest(v, n) - smallest(v, n);
  }
  const double span = time[n - 1] - time[0];
  f.speed = {span > 0 ? (z[0] - z[n - 1]) / span : 0, smallest(speed, n), largest(speed, n)};
}

void contraction_figures(Figures& f, const Columns& column, std::size_t n, const labour::Contractions& c) {
  const auto time = column("time_s"), z = column("head_z_mm"), travel = column("head_travel_mm");
  const double end = time[n - 1];
  f.contractions = labour::contractions_begun(c, f.birth_time.value_or(end));
  for (const double t : contraction_peaks(c, end)) {
    const auto i = row_at(time, t);
    if (i >= n) break;
    f.descent_at_peaks.push_back(-z[i]);
    f.travel_at_peaks.push_back(travel[i]);
  }
  const auto* spines = find(f.milestones, "widest_at_spines");
  const auto starts = contraction_starts(c, end);
  for (std::size_t k = 0; k + 1 < starts.size(); ++k) {
    const auto begin = row_at(time, starts[k]), next = row_at(time, starts[k + 1]);
    if (next >= n) break;
    const auto deepest = std::min_element(z.begin() + std::ptrdiff_t(begin), z.begin() + std::ptrdiff_t(next) + 1);
    const auto shallowest = std::max_element(deepest, z.begin() + std::ptrdiff_t(next) + 1);
    f.recession.push_back(*shallowest - *deepest);
    if (!spines || time[next] <= spines->time) {
      ++f.rests_before_spines;
      f.recessions_before_spines += f.recession.back() > 0.1;  // mm: less is the noise of an output
    }
  }
}

/// Rises of the sacrum over the labour: the largest angle of each contraction's period, then its local maxima by 5 % at
/// least.
void sacrum_figures(Figures& f, const Columns& column, const labour::Contractions& c) {
  const auto time = column("time_s"), angle = column("sacrum_angle_deg");
  f.sacrum_max = largest(angle, angle.size()), f.sacrum_end = angle.back();
  std::vector<double> envelope;
  for (const double start : contraction_starts(c, time.back())) {
    double top = 0;
    for (std::size_t i = 0; i < time.size(); ++i) {
      if (time[i] >= start && time[i] < start + c.period) top = std::max(top, angle[i]);
    }
    envelope.push_back(top);
  }
  const double prominence = 0.05 * f.sacrum_max;
  double low = 0, high = 0;
  bool rising = true;
  for (const double a : envelope) {
    if (rising) {
      high = std::max(high, a);
      if (a < high - prominence) f.sacrum_peaks.push_back(high), rising = false, low = a;
    } else {
      low = std::min(low, a);
      if (a > low + prominence) rising = true, high = a;
    }
  }
  if (rising && high > prominence && high > 0) f.sacrum_peaks.push_back(high);
}

void rotation_figures(Figures& f, const Columns& column, std::size_t n) {
  const auto occiput = column("occiput_deg"), turn = column("internal_rotation_deg"),
             flexion = column("flexion_to_trunk_deg"), occiput_low = column("occiput_below_symphysis_mm"),
             trunk = column("trunk_rotation_deg"), station = column("station_mm");
  const auto* crowning = find(f.milestones, "crowning");
  const auto at = crowning ? std::min(crowning->row, occiput.size() - 1) : occiput.size() - 1;
  f.occiput_at_crowning = occiput[at], f.rotation_at_crowning = turn[at];
  for (std::size_t i = 0; i <= at; ++i) {
    if (std::abs(turn[i]) < 0.9 * std::abs(turn[at])) continue;
    f.rotation_done_station = station[i];
    break;
  }
  for (std::size_t i = 0; i < n; ++i) {
    const double extension = largest(flexion, i + 1) - flexion[i];
    if (extension > extended && f.extension <= extended) f.occiput_at_extension = occiput_low[i];
    f.extension = std::max(f.extension, extension);
  }
  if (f.birth_time) f.external_rotation = trunk.back() - trunk[n - 1];
}

void numeric_figures(Figures& f, const Columns& column) {
  const auto time = column("time_s"), kinetic = column("energy_kinetic_j"), internal = column("energy_internal_j"),
             imbalance = column("energy_imbalance_j"), external = column("energy_external_work_j");
  const auto all = time.size();
  f.min_J = smallest(column("min_J_ratio"), all);
  f.inverted = largest(column("inverted_count"), all);
  f.penetration = largest(column("penetration_mm"), all);
  f.penetration_smooth = largest(column("penetration_smooth_mm"), all);
  for (std::size_t i = 0; i < all; ++i) {
    if (time[i] > 0.05 * time.back() && internal[i] > 0)
      f.kinetic_over_internal = std::max(f.kinetic_over_internal, kinetic[i] / internal[i]);
  }
  const double work = std::abs(largest_in_size(external, all));
  f.energy_error = work > 0 ? std::abs(largest_in_size(imbalance, all)) / work : 0;
}

}  // namespace

std::vector<double> contraction_starts(const labour::Contractions& c, double end) {
  std::vector<double> t;
  for (double s = c.first; s <= end; s += c.period) t.push_back(s);
  return t;
}

std::vector<double> contraction_peaks(const labour::Contractions& c, double end) {
  std::vector<double> t;
  for (const double s : contraction_starts(c, end)) {
    if (s + c.duration - c.fall <= end) t.push_back(s + c.duration - c.fall);
  }
  return t;
}

Figures figures_of(const Table& table, const labour::Contractions& contractions) {
  Figures f;
  if (table.rows.empty()) return f;
  const Columns column(table);
  f.milestones = observe::milestones(table);
  const auto* birth = find(f.milestones, "birth");
  if (birth) f.birth_time = birth->time;
  const auto all = table.rows.size(), n = birth ? birth->row + 1 : all;
  f.end_time = column("time_s").back();
  head_figures(f, column, n);
  contraction_figures(f, column, n, contractions);
  const auto length = column("uterus_length_mm");
  f.uterus_start = length.front(), f.uterus_end = length[n - 1];
  const auto left = column("uterus_left_x_mm"), right = column("uterus_right_x_mm");
  for (std::size_t i = 0; i < all; ++i) {
    if (std::abs(left[i] - right[i]) > std::abs(f.lateral_left - f.lateral_right))
      f.lateral_left = left[i], f.lateral_right = right[i];
  }
  sacrum_figures(f, column, contractions);
  int k = 0;
  for (const char* name : {"occipitofrontal", "biparietal", "vertical"}) {
    f.moulding[k++] = largest_in_size(column(std::string("moulding_") + name + "_mm"), n);
  }
  f.skull_volume_change_max = std::abs(largest_in_size(column("skull_volume_change_percent"), n));
  f.levator_stretch = largest(column("levator_stretch_ratio"), all),
  f.perineum_stretch = largest(column("perineum_stretch_ratio"), all);
  f.hiatus_ratio = largest(column("hiatus_perimeter_ratio"), all),
  f.vulva_ratio = largest(column("vulva_transverse_ratio"), all);
  f.expulsive_force = largest(column("expulsive_force_n"), n),
  f.head_force = largest(column("head_contact_force_n"), n);
  f.head_pressure_mean = largest(column("head_pressure_mean_kpa"), n);
  f.push = largest(column("pressure_push_mmhg"), all),
  f.contraction = largest(column("pressure_contraction_mmhg"), all);
  f.tone = largest(column("pressure_tone_mmhg"), all);
  rotation_figures(f, column, n);
  numeric_figures(f, column);
  return f;
}

}  // namespace carus::results
