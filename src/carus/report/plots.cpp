// SPDX-License-Identifier: Apache-2.0
#include "carus/report/plots.hpp"

#include <algorithm>
#include <array>
#include <limits>

#include "carus/core/error.hpp"
#include "carus/report/trajectory.hpp"
#include "carus/results/figures.hpp"

namespace carus::report {
namespace {

Mark value(double v, std::string label, std::string source) { return {v, v, std::move(label), std::move(source)}; }
Mark band(std::optional<double> low, std::optional<double> high, std::string label, std::string source) {
  return {low, high, std::move(label), std::move(source)};
}

/// All plots that there can be, in the order of the page.
std::vector<Plot> all_plots(const Folder& folder) {
  const double length = folder.curves.at(0, "uterus_length_mm");
  const bool literature = folder.scenario && results::has_literature_loads(folder.scenario->loads);
  const char* const ours = literature ? "band, physiological" : "band, reference";
  return {
      {"loads",
       "Contraction, push and residual tone",
       "Fig. 9",
       "mmHg",
       {{"pressure_contraction_mmhg", "contraction"},
        {"pressure_push_mmhg", "push"},
        {"pressure_tone_mmhg", "residual tone"}},
       {band(40 + 10, 60 + 10, "contraction 40–60 above base", "obstetric texts"),
        band(8, 12, "base 8–12", "obstetric texts")},
       {}},
      {"head_x",
       "Head, left–right (X)",
       "Fig. 12",
       "mm",
       {{"head_x_mm", "X"}},
       {value(51.5, "paper's amplitude 51.5 mm", "paper 5.1")},
       {}},
      {"head_y",
       "Head, antero-posterior (Y)",
       "Fig. 12",
       "mm",
       {{"head_y_mm", "Y"}},
       {band(40, 90, "40–90 mm", "band 2"), value(63.5, "paper's amplitude 63.5 mm", "paper 5.1")},
       {}},
      {"head_z",
       "Head, cranio-caudal (Z)",
       "Fig. 12",
       "mm",
       {{"head_z_mm", "Z"}},
       {band(-220, -160, "160–220 mm down", "band 2"), value(-184, "paper's amplitude 184 mm", "paper 5.1")},
       {}},
      {"head_speed",
       "Head's velocity down Z",
       "Fig. 13",
       "mm/s",
       {{"head_speed_mm_s", "down"}},
       {band(0.08, 0.15, "mean 0.08–0.15 mm/s", "band 1"), value(0, "below: the head recedes", "paper 5.1")},
       {}},
      {"uterus_length",
       "Length of the uterus",
       "Fig. 14",
       "mm",
       {{"uterus_length_mm", "fundus to lower segment"}},
       {band(0.30 * length, 0.45 * length, "end: 0.30–0.45 of the start", "band 3"),
        value(230, "paper: 230 mm at the start", "paper 5.2"), value(80, "paper: 80 mm at the exit", "paper 5.2")},
       {}},
      {"lateral",
       "Lateral points of the uterus",
       "Fig. 16",
       "mm",
       {{"uterus_left_x_mm", "left"}, {"uterus_right_x_mm", "right"}},
       {},
       {}},
      {"sacrum",
       "Sacrum and coccyx, angle",
       "Fig. 17",
       "deg",
       {{"sacrum_angle_deg", "backwards"}},
       {band(literature ? 3 : 1, 16, literature ? "maximum 3–16°" : "maximum 1–16°", "band 4; Borges 2021")},
       {}},
      {"moulding",
       "Moulding of the head",
       "Fig. 18",
       "mm",
       {{"moulding_occipitofrontal_mm", "occipitofrontal"},
        {"moulding_biparietal_mm", "biparietal"},
        {"moulding_vertical_mm", "vertical"}},
       {band(literature ? 3 : 1, 10, "occipitofrontal, largest", ours),
        band(-9, literature ? -3 : -1, "vertical, largest", ours)},
       {}},
      {"trajectory",
       "Trajectory beside the imposed one",
       "Fig. 20",
       "mm",
       {{axis_column, "computed, along start–end"}},
       {},
       {}},
      {"station",
       "Station",
       "",
       "mm",
       {{"station_mm", "leading point below the spines"},
        {"widest_station_mm", "centre of the skull below the spines"}},
       {value(0, "interspinous plane", "")},
       {}},
      {"cardinal",
       "Cardinal movements",
       "",
       "deg",
       {{"internal_rotation_deg", "internal rotation"},
        {"occiput_deg", "occiput from anterior"},
        {"flexion_to_canal_deg", "flexion to canal"},
        {"flexion_to_trunk_deg", "flexion to trunk"},
        {"trunk_rotation_deg", "trunk"},
        {"lateral_tilt_deg", "lateral tilt"}},
       {band(-20, 20, "occiput at crowning ±20°", "band 10")},
       {}},
      {"force",
       "Expulsive and contact force",
       "",
       "N",
       {{"expulsive_force_n", "expulsive"},
        {"axial_contact_force_n", "along the axis, net"},
        {"head_contact_force_n", "contact on the head"}},
       {band(50, 130, "largest expulsive 50–130 N", "band 6")},
       {}},
      {"head_pressure",
       "Pressure between head and canal",
       "",
       "kPa",
       {{"head_pressure_mean_kpa", "mean"}, {"head_pressure_max_kpa", "largest"}},
       {band(5, 52, "measured 5–52 kPa", "Svenningsen"), value(21, "mean 21 kPa", "Svenningsen")},
       {}},
      {"levator",
       "Stretch of the levator",
       "",
       "",
       {{"levator_stretch_ratio", "largest"},
        {"levator_stretch_p95_ratio", "95th percentile"},
        {"hiatus_perimeter_ratio", "hiatus, perimeter"}},
       {band(2.0, 3.5, "largest 2.0–3.5", "band 7; Lien 2004")},
       {}},
      {"perineum",
       "Stretch of the perineum",
       "",
       "",
       {{"perineum_stretch_ratio", "largest"},
        {"perineum_stretch_p95_ratio", "95th percentile"},
        {"vulva_transverse_ratio", "vulva, transverse"}},
       {band(2.1, 3.5, "transverse 2.1–3.5", "band 7; pmid 22818534")},
       {}},
      {"energy",
       "Energies and work",
       "",
       "J",
       {{"energy_kinetic_j", "kinetic"},
        {"energy_internal_j", "internal"},
        {"energy_external_work_j", "loads"},
        {"energy_contact_work_j", "contact"},
        {"energy_damping_work_j", "damping"},
        {"energy_active_work_j", "muscle"},
        {"energy_relaxation_work_j", "relaxation"},
        {"energy_imbalance_j", "imbalance"}},
       {},
       {}},
      {"retraction", "Rest length of the uterine muscle", "", "", {{"rest_length_ratio", "mean"}}, {}, {}},
      {"penetration",
       "Penetration",
       "",
       "mm",
       {{"penetration_smooth_mm", "to the smooth surface"}, {"penetration_mm", "to flat facets"}},
       {band({}, 0.2, "at most 0.2 mm", "band 8")},
       {}},
      {"volume_ratio",
       "Least volume ratio J of any element",
       "",
       "",
       {{"min_J_ratio", "least"}},
       {band({}, 0, "inverted", "band 8")},
       {}},
  };
}

void add_axis(const Folder& folder, observe::Table& curves, std::vector<Plot>& plots) {
  const auto plot = std::find_if(plots.begin(), plots.end(), [](const Plot& p) { return p.id == "trajectory"; });
  Motion motion;
  std::vector<double> s;
  try {
    motion = motion_of(folder);
    s = along(motion, Axis::chord);
  } catch (const InputError&) {
    return;  // no pose, no trajectory: its plot goes as its column is missing
  }
  curves.names.push_back(axis_column);
  for (std::size_t i = 0; i < curves.rows.size(); ++i)
    curves.rows[i].push_back(i < s.size() ? s[i] : std::numeric_limits<double>::quiet_NaN());
  const double duration = motion.time.back(), amplitude = s.back();
  const auto add = [&](const char* label, const Reference& r) {
    plot->references.push_back(
        {label, "shape of BirthSIM's in the paper's 5.5; amplitude and times of this run", r.time, r.value});
  };
  add("imposed, linear", imposed_linear(duration, amplitude));
  if (folder.scenario)
    add("imposed, cyclic", imposed_cyclic(duration, amplitude, folder.scenario->loads.contractions, imposed_recession));
}

}  // namespace

std::vector<Plot> plots_of(const Folder& folder, observe::Table& curves) {
  auto plots = all_plots(folder);
  add_axis(folder, curves, plots);
  for (auto& p : plots) std::erase_if(p.lines, [&](const Line& l) { return !curves.find(l.column); });
  std::erase_if(plots, [](const Plot& p) { return p.lines.empty(); });
  return plots;
}

std::string unit_of(const std::string& column) {
  constexpr std::array<std::pair<const char*, const char*>, 11> units = {{{"_mm_s", "mm/s"},
                                                                          {"_mm", "mm"},
                                                                          {"_s", "s"},
                                                                          {"_deg", "deg"},
                                                                          {"_n", "N"},
                                                                          {"_kpa", "kPa"},
                                                                          {"_mmhg", "mmHg"},
                                                                          {"_j", "J"},
                                                                          {"_ml", "ml"},
                                                                          {"_percent", "%"},
                                                                          {"_m", "m"}}};
  for (const auto& [ending, unit] : units) {
    if (column.ends_with(ending)) return unit;
  }
  return "";
}

}  // namespace carus::report
