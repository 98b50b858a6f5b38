// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "carus/core/units.hpp"
#include "carus/results/figures.hpp"

namespace carus::results {
namespace {

bool within(double v, double low, double high) { return v >= low && v <= high; }

}  // namespace

std::vector<Band> bands_of(const Figures& f, const labour::Contractions& c) {
  std::vector<Band> bands;
  const auto band = [&](int number, std::string what, std::string expected, std::string source, std::string obtained,
                        bool inside) {
    bands.push_back({number, std::move(what), std::move(expected), std::move(source), std::move(obtained), inside});
  };
  const auto number = [](double v, const char* unit) { return fmt::format("{:.2f}{}", v, unit); };
  const bool born = f.birth_time.has_value();
  const double ratio = f.uterus_start > 0 ? f.uterus_end / f.uterus_start : 0;
  const auto receding = std::count_if(f.recession.begin(), f.recession.end(), [](double r) { return r > 0.1; });

  band(1, "contractions to birth", "6-10, born", "paper", born ? fmt::format("{}", f.contractions) : "not born",
       born && within(f.contractions, 6, 10));
  band(1, "time of birth", "15-60 min", "paper", born ? number(*f.birth_time / 60, " min") : "not born",
       born && within(*f.birth_time / 60, 15, 60));
  band(1, "mean head speed", "0.08-0.15 mm/s", "paper", number(f.speed.mean, " mm/s"),
       within(f.speed.mean, 0.08, 0.15));
  band(1, "rests in which the head recedes", ">= 3", "paper",
       fmt::format("{} of {}; before the widest part passed the spines {} of {}", receding, f.recession.size(),
                   f.recessions_before_spines, f.rests_before_spines),
       receding >= 3);
  band(2, "head displacement z", "160-220 mm", "paper 184 mm", number(f.amplitude[2], " mm"),
       within(f.amplitude[2], 160, 220));
  band(2, "head displacement y", "40-90 mm", "paper 63.5 mm", number(f.amplitude[1], " mm"),
       within(f.amplitude[1], 40, 90));
  band(3, "uterus length end/start", "0.30-0.45", "paper 80/230", number(ratio, ""), within(ratio, 0.30, 0.45));
  band(3, "lateral uterine points", "opposite directions", "paper, Fig. 16",
       fmt::format("left {:.1f} mm, right {:.1f} mm", f.lateral_left, f.lateral_right),
       f.lateral_left * f.lateral_right < 0);
  band(4, "sacrum/coccyx angle, maximum", "1-16 deg", "paper, Fig. 17; Borges 2021", number(f.sacrum_max, " deg"),
       within(f.sacrum_max, 1, 16));
  band(4, "sacrum/coccyx angle, peaks", "2", "paper, Fig. 17", fmt::format("{}", f.sacrum_peaks.size()),
       f.sacrum_peaks.size() == 2);
  band(4, "sacrum/coccyx angle, residual", "> 0", "paper", number(f.sacrum_end, " deg"), f.sacrum_end > 0);
  band(5, "moulding, occipitofrontal", "+1...+10 mm", "Bamberg 2017", number(f.moulding[0], " mm"),
       within(f.moulding[0], 1, 10));
  band(5, "moulding, vertical", "-9...-1 mm", "Bamberg 2017", number(f.moulding[2], " mm"),
       within(f.moulding[2], -9, -1));
  band(5, "skull volume change", "< 1 %", "targets", number(f.skull_volume_change_max, " %"),
       f.skull_volume_change_max < 1);
  const double base = c.base / units::mmHg, amplitude = c.amplitude / units::mmHg, with_push = f.contraction + f.push;
  band(6, "pressure: base", "8-12 mmHg (physiological)", "texts", number(base, " mmHg"), within(base, 8, 12));
  band(6, "pressure: contraction above base", "40-60 mmHg (physiological)", "texts", number(amplitude, " mmHg"),
       within(amplitude, 40, 60));
  band(6, "pressure: with push", "80-120 mmHg (physiological)", "texts", number(with_push, " mmHg"),
       within(with_push, 80, 120));
  band(6, "force on the head", "50-130 N", "P x 70.9 cm2", number(f.expulsive_force, " N"),
       within(f.expulsive_force, 50, 130));
  band(7, "levator stretch", "2.0-3.5", "Lien 2004; BJOG 02321", number(f.levator_stretch, ""),
       within(f.levator_stretch, 2.0, 3.5));
  band(7, "perineal ring, transverse", "2.1-3.5", "pmid 22818534", number(f.vulva_ratio, ""),
       within(f.vulva_ratio, 2.1, 3.5));
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

}  // namespace carus::results
