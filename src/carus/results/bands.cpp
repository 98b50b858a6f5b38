// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "carus/core/units.hpp"
#include "carus/results/figures.hpp"

namespace carus::results {
namespace {

bool within(double v, double low, double high) { return v >= low && v <= high; }

std::string number(double v, const char* unit) { return fmt::format("{:.2f}{}", v, unit); }

/// Rests in which the head recedes by more than the noise of an output [mm].
auto receding(const Figures& f) {
  return std::count_if(f.recession.begin(), f.recession.end(), [](double r) { return r > 0.1; });
}

}  // namespace

bool has_literature_loads(const scenario::Loads& loads) {
  constexpr double slack = 1 + 1e-9;  // a value at the bound is read from text
  return (!loads.push.enabled || loads.push.amplitude <= 70 * units::mmHg * slack) &&
         (!loads.residual_tone.enabled || loads.residual_tone.pressure <= 12 * units::mmHg * slack);
}

std::vector<Band> bands_of(const Figures& f, const scenario::Loads& loads) {
  const labour::Contractions& c = loads.contractions;
  const bool physiological = has_literature_loads(loads);
  std::vector<Band> bands;
  const auto band = [&](int of, std::string what, std::string expected, std::string source, std::string obtained,
                        bool inside, bool asked = true) {
    bands.push_back({of, std::move(what), std::move(expected), std::move(source), std::move(obtained), inside, asked});
  };
  const bool born = f.birth_time.has_value();
  const double ratio = f.uterus_start > 0 ? f.uterus_end / f.uterus_start : 0;

  band(1, "contractions to birth", "6-10, born", "paper", born ? fmt::format("{}", f.contractions) : "not born",
       born && within(f.contractions, 6, 10));
  band(1, "time of birth", "15-60 min", "paper", born ? number(*f.birth_time / 60, " min") : "not born",
       born && within(*f.birth_time / 60, 15, 60));
  band(1, "mean head speed", "0.08-0.15 mm/s", "paper", number(f.speed.mean, " mm/s"),
       within(f.speed.mean, 0.08, 0.15));
  band(1, "rests in which the head recedes", ">= 3", "paper",
       fmt::format("{} of {}; before the widest part passed the spines {} of {}", receding(f), f.recession.size(),
                   f.recessions_before_spines, f.rests_before_spines),
       receding(f) >= 3);
  band(2, "head displacement z", "160-220 mm", "paper 184 mm", number(f.amplitude[2], " mm"),
       within(f.amplitude[2], 160, 220));
  band(2, "head displacement y", "40-90 mm", "paper 63.5 mm", number(f.amplitude[1], " mm"),
       within(f.amplitude[1], 40, 90));
  band(3, "uterus length end/start", "0.30-0.45", "paper 80/230", number(ratio, ""), within(ratio, 0.30, 0.45));
  band(3, "lateral uterine points", "opposite directions", "paper, Fig. 16",
       fmt::format("left {:.1f} mm, right {:.1f} mm", f.lateral_left, f.lateral_right),
       f.lateral_left * f.lateral_right < 0);
  band(4, "sacrum/coccyx angle, maximum", physiological ? "3-16 deg" : "1-16 deg", "paper, Fig. 17; Borges 2021",
       number(f.sacrum_max, " deg"), within(f.sacrum_max, physiological ? 3 : 1, 16));
  band(4, "sacrum/coccyx angle, peaks", "2", "paper, Fig. 17", fmt::format("{}", f.sacrum_peaks.size()),
       f.sacrum_peaks.size() == 2);
  band(4, "sacrum/coccyx angle, residual", "> 0", "paper", number(f.sacrum_end, " deg"), f.sacrum_end > 0);
  band(5, "moulding, occipitofrontal", physiological ? "+3...+10 mm" : "+1...+10 mm", "Bamberg 2017",
       number(f.moulding[0], " mm"), within(f.moulding[0], physiological ? 3 : 1, 10));
  band(5, "moulding, vertical", physiological ? "-9...-3 mm" : "-9...-1 mm", "Bamberg 2017",
       number(f.moulding[2], " mm"), within(f.moulding[2], -9, physiological ? -3 : -1));
  band(5, "skull volume change", "< 1 %", "targets", number(f.skull_volume_change_max, " %"),
       f.skull_volume_change_max < 1);
  const double base = c.base / units::mmHg, amplitude = c.amplitude / units::mmHg, with_push = f.contraction + f.push;
  band(6, "pressure: base", "8-12 mmHg (physiological)", "texts", number(base, " mmHg"), within(base, 8, 12),
       physiological);
  band(6, "pressure: contraction above base", "40-60 mmHg (physiological)", "texts", number(amplitude, " mmHg"),
       within(amplitude, 40, 60), physiological);
  band(6, "pressure: with push", "80-120 mmHg (physiological)", "texts", number(with_push, " mmHg"),
       within(with_push, 80, 120), physiological && loads.push.enabled);
  band(6, "force on the head", "50-130 N", "P x 70.9 cm2", number(f.expulsive_force, " N"),
       within(f.expulsive_force, 50, 130), physiological);
  band(7, "levator stretch", "2.0-3.5", "Lien 2004; BJOG 02321", number(f.levator_stretch, ""),
       within(f.levator_stretch, 2.0, 3.5), physiological);
  band(7, "perineal ring, transverse", "2.1-3.5", "pmid 22818534", number(f.vulva_ratio, ""),
       within(f.vulva_ratio, 2.1, 3.5), physiological);
  band(8, "inverted elements", "0", "numerics", fmt::format("{:.0f}", f.inverted), f.inverted == 0);
  band(8, "penetration", "<= 0.2 mm", "numerics",
       fmt::format("{:.2f} mm to flat facets, {:.2f} mm to the smooth surface", f.penetration, f.penetration_smooth),
       f.penetration_smooth <= 0.2);
  band(8, "kinetic/internal energy after 5 % of the run", "< 0.05", "numerics",
       fmt::format("{:.4f}", f.kinetic_over_internal), f.kinetic_over_internal < 0.05);
  band(10, "occiput at crowning", "0 +- 20 deg", "cardinal movements", number(f.occiput_at_crowning, " deg"),
       std::abs(f.occiput_at_crowning) <= 20);
  band(10, "internal rotation", "45-90 deg", "cardinal movements", number(std::abs(f.rotation_at_crowning), " deg"),
       within(std::abs(f.rotation_at_crowning), 45, 90));
  band(10, "extension until birth", ">= 10 deg", "cardinal movements", number(f.extension, " deg"), f.extension >= 10);
  band(10, "extension passes 10 deg", "occiput below the lower symphysis", "cardinal movements",
       number(f.occiput_at_extension, " mm below"), f.occiput_at_extension > 0);
  return bands;
}

std::vector<Band> validation_of(const Figures& f) {
  std::vector<Band> rows;
  const auto row = [&](std::string what, std::string expected, std::string section, std::string obtained, bool inside,
                       bool asked = true) {
    rows.push_back({0, std::move(what), std::move(expected), "paper, " + section, std::move(obtained), inside, asked});
  };
  const bool born = f.birth_time.has_value();
  row("duration to expulsion", "32 min; met within 15-60", "5, 5.1",
      born ? number(*f.birth_time / 60, " min") : "not born", born && within(*f.birth_time / 60, 15, 60));
  row("contractions to expulsion", "8; met within 6-10", "5", born ? fmt::format("{}", f.contractions) : "not born",
      born && within(f.contractions, 6, 10));
  row("head displacement X (left-right)", "51.5 mm", "5.1, Fig. 12", number(f.amplitude[0], " mm"),
      within(f.amplitude[0], 40, 65), false);  // needs an asymmetry that no symmetric anatomy has
  row("head displacement Y (antero-posterior)", "63.5 mm; met within 40-90", "5.1, Fig. 12",
      number(f.amplitude[1], " mm"), within(f.amplitude[1], 40, 90));
  row("head displacement Z (cranio-caudal)", "184 mm; met within 160-220", "5.1, Fig. 12",
      number(f.amplitude[2], " mm"), within(f.amplitude[2], 160, 220));
  row("mean head speed", "0.09 mm/s (statistics 0.11); met within 0.08-0.15", "5.1", number(f.speed.mean, " mm/s"),
      within(f.speed.mean, 0.08, 0.15));
  row("head velocity between contractions", "negative: the head recedes; met in 3 rests or more", "5.1, Fig. 13",
      fmt::format("least {:.2f} mm/s; recedes in {} of {} rests", f.speed.min, receding(f), f.recession.size()),
      receding(f) >= 3);
  const double ratio = f.uterus_start > 0 ? f.uterus_end / f.uterus_start : 0;
  row("uterus length at the exit", "230 -> 80 mm, about -2/3; met within 0.30-0.45 of the start", "5.2, Fig. 14",
      fmt::format("{:.0f} -> {:.0f} mm, {:.2f}", f.uterus_start, f.uterus_end, ratio), within(ratio, 0.30, 0.45));
  row("lateral points of the uterus", "opposite directions", "5.2, Fig. 16",
      fmt::format("left {:.1f} mm, right {:.1f} mm", f.lateral_left, f.lateral_right),
      f.lateral_left * f.lateral_right < 0);
  row("sacrum/coccyx angle, peaks", "2", "5.3, Fig. 17", fmt::format("{}", f.sacrum_peaks.size()),
      f.sacrum_peaks.size() == 2);
  row("sacrum/coccyx angle at the end", "does not return to its start", "5.3, Fig. 17", number(f.sacrum_end, " deg"),
      f.sacrum_end > 0);
  row("deformation of the head", "light crushing; met by 1-10 mm of length", "5.4, Fig. 18",
      number(f.moulding[0], " mm"), within(f.moulding[0], 1, 10));
  return rows;
}

}  // namespace carus::results
