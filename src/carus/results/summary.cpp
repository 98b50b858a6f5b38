// SPDX-License-Identifier: Apache-2.0
#include "carus/results/summary.hpp"

#include <fmt/format.h>

#include <cmath>
#include <cstdlib>
#include <nlohmann/json.hpp>

#include "carus/core/units.hpp"

namespace carus::results {
namespace {

using Json = nlohmann::ordered_json;

/// Six significant digits are more than is measured, and keep the file readable; NaN becomes null.
Json number(double v) {
  if (!std::isfinite(v)) return nullptr;
  return std::strtod(fmt::format("{:.6g}", v).c_str(), nullptr);
}

Json numbers(const std::vector<double>& values) {
  Json list = Json::array();
  for (const double v : values) list.push_back(number(v));
  return list;
}

Json numerics_of(const Figures& f, const RunFacts& r) {
  return {{"elements", r.elements},
          {"nodes", r.nodes},
          {"surface_nodes", r.surface_nodes},
          {"steps", r.steps},
          {"min_J", number(f.min_J)},
          {"inverted", int(f.inverted)},
          {"max_penetration_mm", number(f.penetration)},
          {"max_penetration_smooth_mm", number(f.penetration_smooth)},
          {"kinetic_over_internal_max", number(f.kinetic_over_internal)},
          {"energy_balance_error", number(f.energy_error)},
          {"time_scaling", number(r.time_scaling)},
          {"time_step_s", number(r.time_step)},
          {"unscaled_critical_step_s", number(r.unscaled_critical_step)},
          {"mass_scaled_fraction", number(r.mass_scaled_fraction)},
          {"limiting_region", r.limiting_region}};
}

/// What of each tissue's stiffness relaxes, and in what time: "vaginal_canal 0.75 in 300 s".
std::string relaxation(const scenario::Scenario& s) {
  std::string text;
  for (const auto& [region, material] : s.materials)
    for (const auto& term : material.prony)
      text += fmt::format("{}{} {:g} in {:g} s", text.empty() ? "" : "; ", region, term.g, term.tau);
  return text.empty() ? "none" : text;
}

/// How the uterine wall keeps what contractions won; the paper's wall is passive.
std::string retraction_law(const scenario::Retraction& r) {
  if (!r.enabled) return "none";
  if (r.kind == fem::Retraction::Kind::imposed) return fmt::format("imposed, to {:g} of the length", r.final);
  return fmt::format("ratchet, {:g} s, isometric strain {:g}", r.tau, r.isometric_strain);
}

/// How the time scaling follows the labour.
std::string pace(const solve::PaceOptions& o) {
  if (o.slowest == o.fastest) return "even";
  return fmt::format("{:g} to {:g} times the mean, for kinetic/internal energy of {:g}", o.slowest, o.fastest,
                     o.kinetic_ratio);
}

Json declared(const scenario::Scenario& s) {
  const auto o = scenario::explicit_options(s);
  return {{"resolution", scenario::name_of(s.resolution)},
          {"labour_duration_s", number(o.labour_duration)},
          {"pseudo_duration_s", number(o.pseudo_duration)},
          {"pace", pace(o.pace)},
          {"drag_per_s", number(o.drag)},
          {"safety", number(o.safety)},
          {"max_node_speed_m_s", number(o.max_node_speed)},
          {"contact_sweeps", o.contact_sweeps},
          {"contact_search_mm", number(1e3 * o.contact_search)},
          {"contact_correction_m_s", number(o.contact_correction)},
          {"canal_radius_mm", number(1e3 * s.anatomy.canal.radius)},
          {"canal_bed_posterior_kpa_mm", number(1e-6 * s.attachments.bed_posterior)},
          {"canal_bed_lateral_kpa_mm", number(1e-6 * s.attachments.bed_lateral)},
          {"retraction", s.retraction.enabled},
          {"retraction_law", retraction_law(s.retraction)},
          {"relaxation", relaxation(s)}};
}

Json movements(const Figures& f) {
  return {{"occiput_at_crowning_deg", number(f.occiput_at_crowning)},
          {"internal_rotation_deg", number(f.rotation_at_crowning)},
          {"rotation_done_at_station_mm", number(f.rotation_done_station)},
          {"extension_deg", number(f.extension)},
          {"occiput_below_symphysis_at_extension_mm", number(f.occiput_at_extension)},
          {"external_rotation_deg", number(f.external_rotation)}};
}

}  // namespace

std::string summary_json(const Figures& f, const scenario::Scenario& s, const RunFacts& r) {
  Json j;
  j["scenario"] = s.name;
  j["outcome"] = r.outcome;
  if (!r.reason.empty()) j["reason"] = r.reason;
  j["birth_time_s"] = f.birth_time ? number(*f.birth_time) : Json(nullptr);
  j["end_time_s"] = number(f.end_time);
  j["contractions"] = f.contractions;
  j["head_displacement_mm"] = {
      {"x", number(f.amplitude[0])}, {"y", number(f.amplitude[1])}, {"z", number(f.amplitude[2])}};
  j["head_speed_mm_s"] = {{"mean", number(f.speed.mean)}, {"min", number(f.speed.min)}, {"max", number(f.speed.max)}};
  j["recession_per_rest_mm"] = numbers(f.recession);
  j["head_at_contraction_peaks_mm"] = numbers(f.descent_at_peaks);
  j["head_travel_at_contraction_peaks_mm"] = numbers(f.travel_at_peaks);
  j["uterus_length_mm"] = {{"start", number(f.uterus_start)}, {"end", number(f.uterus_end)}};
  j["uterus_lateral_mm"] = {{"left", number(f.lateral_left)}, {"right", number(f.lateral_right)}};
  j["sacrum_angle_deg"] = {
      {"max", number(f.sacrum_max)}, {"end", number(f.sacrum_end)}, {"peaks", f.sacrum_peaks.size()}};
  j["moulding_mm"] = {{"occipitofrontal", number(f.moulding[0])},
                      {"biparietal", number(f.moulding[1])},
                      {"vertical", number(f.moulding[2])}};
  j["skull_volume_change_max_percent"] = number(f.skull_volume_change_max);
  j["levator_stretch_max"] = number(f.levator_stretch);
  j["hiatus_perimeter_ratio_max"] = number(f.hiatus_ratio);
  j["perineum_stretch_max"] = number(f.perineum_stretch);
  j["vulva_transverse_ratio_max"] = number(f.vulva_ratio);
  j["expulsive_force_n"] = {{"max", number(f.expulsive_force)}};
  j["head_contact_force_n"] = {{"max", number(f.head_force)}};
  j["head_pressure_kpa"] = {{"mean_max", number(f.head_pressure_mean)}};
  j["pressure_mmhg"] = {{"base", number(s.loads.contractions.base / units::mmHg)},
                        {"contraction", number(f.contraction)},
                        {"push", number(f.push)},
                        {"tone", number(f.tone)}};
  j["movements"] = movements(f);
  j["milestones_s"] = Json::object();
  for (const auto& m : f.milestones) j["milestones_s"][m.name] = number(m.time);
  j["numerics"] = numerics_of(f, r);
  j["declared"] = declared(s);
  j["calibrated"] = Json::array();
  for (const auto& c : s.calibrated) j["calibrated"].push_back({{"key", c.key}, {"to", c.to}});
  const auto judged = [](const Band& b) -> Json {
    return {{"what", b.what},         {"expected", b.expected}, {"source", b.source},
            {"obtained", b.obtained}, {"inside", b.inside},     {"asked", b.asked}};
  };
  j["validation"] = Json::array();
  for (const auto& b : validation_of(f)) j["validation"].push_back(judged(b));
  j["bands"] = Json::array();
  for (const auto& b : bands_of(f, s.loads)) {
    Json line = {{"band", b.number}};
    line.update(judged(b));
    j["bands"].push_back(std::move(line));
  }
  j["wall_s"] = {{"total", number(r.wall_meshing + r.wall_solving + r.wall_output)},
                 {"meshing", number(r.wall_meshing)},
                 {"solving", number(r.wall_solving)},
                 {"output", number(r.wall_output)}};
  j["solver_stages_s"] = Json::object();
  for (const auto& [stage, seconds] : r.stages) j["solver_stages_s"][stage] = number(seconds);
  j["threads"] = r.threads;
  j["machine"] = r.machine;
  j["version"] = r.version;
  j["commit"] = r.commit;
  j["seed"] = 0;  // nothing is random: the mesher's generator always starts from 0, the solver has none
  return j.dump(2) + "\n";
}

}  // namespace carus::results
