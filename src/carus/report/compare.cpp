// SPDX-License-Identifier: Apache-2.0
#include "carus/report/compare.hpp"

#include <cmath>
#include <functional>

#include "carus/results/figures.hpp"

namespace carus::report {

std::vector<ComparisonRow> compare(const std::vector<const Folder*>& runs) {
  using results::Figures;
  struct Figure {
    const char *what, *unit;
    std::function<std::optional<double>(const Figures&)> of;
  };
  const auto last = [](const std::vector<double>& v) { return v.empty() ? std::optional<double>() : v.back(); };
  const std::vector<Figure> figures = {
      {"time of birth", "min",
       [](const Figures& f) { return f.birth_time ? std::optional(*f.birth_time / 60) : std::nullopt; }},
      {"contractions", "", [](const Figures& f) { return f.contractions; }},
      {"head displacement X", "mm", [](const Figures& f) { return f.amplitude[0]; }},
      {"head displacement Y", "mm", [](const Figures& f) { return f.amplitude[1]; }},
      {"head displacement Z", "mm", [](const Figures& f) { return f.amplitude[2]; }},
      {"descent at the last contraction's peak", "mm", [=](const Figures& f) { return last(f.descent_at_peaks); }},
      {"mean head speed", "mm/s", [](const Figures& f) { return f.speed.mean; }},
      {"fastest down", "mm/s", [](const Figures& f) { return f.speed.max; }},
      {"fastest receding", "mm/s", [](const Figures& f) { return f.speed.min; }},
      {"uterus length at the start", "mm", [](const Figures& f) { return f.uterus_start; }},
      {"uterus length at the exit", "mm", [](const Figures& f) { return f.uterus_end; }},
      {"sacrum angle, largest", "deg", [](const Figures& f) { return f.sacrum_max; }},
      {"sacrum angle at the end", "deg", [](const Figures& f) { return f.sacrum_end; }},
      {"moulding, occipitofrontal", "mm", [](const Figures& f) { return f.moulding[0]; }},
      {"moulding, biparietal", "mm", [](const Figures& f) { return f.moulding[1]; }},
      {"moulding, vertical", "mm", [](const Figures& f) { return f.moulding[2]; }},
      {"expulsive force, largest", "N", [](const Figures& f) { return f.expulsive_force; }},
      {"contact force on the head, largest", "N", [](const Figures& f) { return f.head_force; }},
      {"pressure on the head, largest mean", "kPa", [](const Figures& f) { return f.head_pressure_mean; }},
      {"levator stretch, largest", "", [](const Figures& f) { return f.levator_stretch; }},
      {"hiatus, perimeter", "", [](const Figures& f) { return f.hiatus_ratio; }},
      {"perineum stretch, largest", "", [](const Figures& f) { return f.perineum_stretch; }},
      {"vulva, transverse", "", [](const Figures& f) { return f.vulva_ratio; }},
      {"internal rotation at crowning", "deg", [](const Figures& f) { return f.rotation_at_crowning; }},
      {"occiput at crowning", "deg", [](const Figures& f) { return f.occiput_at_crowning; }},
      {"extension", "deg", [](const Figures& f) { return f.extension; }},
      {"least volume ratio", "", [](const Figures& f) { return f.min_J; }},
      {"penetration, largest", "mm", [](const Figures& f) { return f.penetration_smooth; }},
      {"kinetic over internal energy, largest", "", [](const Figures& f) { return f.kinetic_over_internal; }},
  };
  std::vector<std::optional<Figures>> all;
  for (const auto* run : runs) {
    all.push_back(run->scenario ? std::optional(results::figures_of(run->curves, run->scenario->loads.contractions))
                                : std::nullopt);
  }
  std::vector<ComparisonRow> rows;
  for (const auto& figure : figures) {
    ComparisonRow row{figure.what, figure.unit, {}};
    for (const auto& f : all) {
      auto v = f ? figure.of(*f) : std::nullopt;
      if (v && !std::isfinite(*v)) v.reset();
      row.values.push_back(v);
    }
    rows.push_back(std::move(row));
  }
  return rows;
}

}  // namespace carus::report
