// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "carus/scenario/scenario.hpp"

namespace carus::study {

/// What the table of a study tells of one birth, from its results folder.
struct Measures {
  std::string outcome;               ///< "born", "not_born", "failed"; "refused" if it could not be begun
  std::string reason;                ///< of a failure or refusal
  std::optional<double> birth_time;  ///< [s of labour]
  int contractions = 0;              ///< begun until birth, or the end
  std::vector<double> peaks;         ///< [mm] head_at_contraction_peaks_mm, those before birth
  double uterus_ratio = 0;           ///< length at the end over that at the start
  int recessions = 0, rests = 0;     ///< rests in which the head recedes by more than 0.1 mm, of all
  double rotation = 0;               ///< [deg] internal, at crowning
  double extension = 0;              ///< [deg]
  double penetration = 0;            ///< [mm] deepest
  double kinetic_over_internal = 0;  ///< largest
  double energy_imbalance = 0;       ///< largest, over the external work
  double wall = 0;                   ///< [s]
  std::string version, commit;       ///< of the carus that computed it
};

/// Reads summary.json. Throws InputError naming file and member if it is not one.
Measures read_measures(const std::filesystem::path& folder, const scenario::Scenario& scenario);

/// True if the folder holds the whole results of this very scenario (the number of threads does not matter).
bool is_complete(const std::filesystem::path& folder, const scenario::Scenario& scenario);

/// True if the folder holds a checkpoint of this very scenario by this very build, which `first_line` of
/// scenario.resolved.yaml names.
bool is_resumable(const std::filesystem::path& folder, const scenario::Scenario& scenario,
                  const std::string& first_line);

/// max_k |d_k - b_k| / |b_k| over the contraction peaks k that both have [%]. Peaks at which the base has moved by less
/// than 1 mm do not count: there is nothing to be relative to. Empty if none is left.
std::optional<double> largest_difference_percent(const std::vector<double>& base, const std::vector<double>& peaks);

}  // namespace carus::study
