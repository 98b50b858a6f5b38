// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "carus/labour/labour.hpp"
#include "carus/observe/milestones.hpp"
#include "carus/scenario/scenario.hpp"

namespace carus::results {

struct Range {
  double mean = 0, min = 0, max = 0;
};

/// The figures of one birth, taken from its curves alone. "To birth" means up to the first output after it, or the end.
struct Figures {
  std::vector<observe::Milestone> milestones;
  std::optional<double> birth_time;      ///< [s]
  double end_time = 0;                   ///< [s]
  int contractions = 0;                  ///< begun to birth
  double amplitude[3] = {};              ///< [mm] max - min of the head's x, y, z to birth
  Range speed;                           ///< [mm/s] down -z to birth; mean: net
  std::vector<double> descent_at_peaks;  ///< [mm] -z at the end of each plateau to birth
  std::vector<double> travel_at_peaks;   ///< [mm] along the canal's axis
  std::vector<double> recession;  ///< [mm] deepest of each contraction less shallowest of the rest after it, to birth
  int recessions_before_spines = 0, rests_before_spines = 0;  ///< before the widest plane passes the interspinous plane
  double uterus_start = 0, uterus_end = 0;                    ///< [mm]
  double lateral_left = 0, lateral_right = 0;                 ///< [mm] x at the largest difference
  double sacrum_max = 0, sacrum_end = 0;                      ///< [deg]
  std::vector<double> sacrum_peaks;  ///< [deg] local maxima of the largest angle per contraction
  double moulding[3] = {};  ///< [mm] occipitofrontal, biparietal, vertical: largest in size to birth, with sign
  double skull_volume_change_max = 0;  ///< [%] in size
  double levator_stretch = 0, perineum_stretch = 0, hiatus_ratio = 0, vulva_ratio = 0;
  double expulsive_force = 0, head_force = 0, head_pressure_mean = 0;  ///< [N], [N], [kPa] maxima to birth
  double push = 0, contraction = 0, tone = 0;                          ///< [mmHg] maxima of the loads
  double min_J = 1, inverted = 0, penetration = 0, penetration_smooth = 0, kinetic_over_internal = 0, energy_error = 0;
  double occiput_at_crowning = 0;    ///< [deg] from anterior; at the end if it did not crown
  double rotation_at_crowning = 0;   ///< [deg] internal rotation
  double rotation_done_station = 0;  ///< [mm] station where 90 % of that rotation was there
  double extension = 0;             ///< [deg] of the head against the trunk, most until birth, from its deepest flexion
  double occiput_at_extension = 0;  ///< [mm] below the lower symphysis when the extension passes 10 deg; 0: it does not
  double external_rotation = 0;     ///< [deg] of the trunk after birth
};

/// `time` of the end of each plateau, where the head is deepest, and of each start, up to `end` [s].
std::vector<double> contraction_peaks(const labour::Contractions& c, double end);
std::vector<double> contraction_starts(const labour::Contractions& c, double end);

Figures figures_of(const observe::Table& table, const labour::Contractions& contractions);

/// One line of what a run is judged by. `asked` is false where its scenario does not claim it; `inside` is told all the
/// same.
struct Band {
  int number;  ///< of the band; 0 for a validation parameter of the paper
  std::string what, expected, source, obtained;
  bool inside;
  bool asked = true;
};
/// Whether all loads are within what the literature covers (push up to 70 mmHg, tone up to 12 mmHg): then a run is
/// judged by physiology. The reference keeps the paper's numbers and is not asked for pressures that the paper does not
/// have.
bool has_literature_loads(const scenario::Loads& loads);
/// Bands 1-8 and 10; 9 and 11 compare several runs.
std::vector<Band> bands_of(const Figures& figures, const scenario::Loads& loads);
/// The validation parameters of the paper's section 5: its value, and the band about it that counts as met.
std::vector<Band> validation_of(const Figures& figures);

}  // namespace carus::results
