// SPDX-License-Identifier: Apache-2.0
#include "carus/study/measures.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>

#include "carus/core/error.hpp"
#include "carus/results/checkpoint.hpp"
#include "carus/results/figures.hpp"
#include "carus/results/files.hpp"

namespace carus::study {
namespace {

namespace fs = std::filesystem;
using Json = nlohmann::json;

/// Numbers that could not be measured are null in a summary.
double number(const Json& j) { return j.is_null() ? NAN : j.get<double>(); }

std::vector<double> numbers(const Json& list) {
  std::vector<double> out;
  for (const Json& j : list) out.push_back(number(j));
  return out;
}

bool belongs(const fs::path& folder, const scenario::Scenario& scenario) {
  const fs::path resolved = folder / "scenario.resolved.yaml";
  if (!fs::exists(resolved)) return false;
  try {
    return results::hash_of(scenario::load(resolved)) == results::hash_of(scenario);
  } catch (const InputError&) {
    return false;  // of a version with other keys
  }
}

}  // namespace

Measures read_measures(const fs::path& folder, const scenario::Scenario& scenario) {
  const fs::path file = folder / "summary.json";
  try {
    const Json j = Json::parse(results::read_text(file));
    Measures m;
    m.outcome = j.at("outcome"), m.reason = j.value("reason", "");
    if (!j.at("birth_time_s").is_null()) m.birth_time = j.at("birth_time_s").get<double>();
    m.contractions = j.at("contractions");
    m.peaks = numbers(j.at("head_at_contraction_peaks_mm"));
    // The summary's list may hold one peak more: an output just after birth.
    const auto times = results::contraction_peaks(scenario.loads.contractions, number(j.at("end_time_s")));
    while (m.birth_time && !m.peaks.empty() && m.peaks.size() <= times.size() &&
           times[m.peaks.size() - 1] > *m.birth_time)
      m.peaks.pop_back();
    m.uterus_ratio = number(j.at("uterus_length_mm").at("end")) / number(j.at("uterus_length_mm").at("start"));
    const auto recession = numbers(j.at("recession_per_rest_mm"));
    m.rests = int(recession.size());
    m.recessions = int(std::count_if(recession.begin(), recession.end(), [](double r) { return r > 0.1; }));
    m.rotation = number(j.at("movements").at("internal_rotation_deg"));
    m.extension = number(j.at("movements").at("extension_deg"));
    const Json& numerics = j.at("numerics");
    m.penetration = number(numerics.at("max_penetration_mm"));
    m.kinetic_over_internal = number(numerics.at("kinetic_over_internal_max"));
    m.energy_imbalance = number(numerics.at("energy_balance_error"));
    m.wall = number(j.at("wall_s").at("total"));
    m.version = j.at("version"), m.commit = j.at("commit");
    return m;
  } catch (const Json::exception& error) {
    throw InputError(fmt::format("{}: not a summary of this version: {}; remove the folder to run it again",
                                 file.string(), error.what()));
  }
}

bool is_complete(const fs::path& folder, const scenario::Scenario& scenario) {
  return fs::exists(folder / "summary.json") && belongs(folder, scenario);
}

bool is_resumable(const fs::path& folder, const scenario::Scenario& scenario, const std::string& first_line) {
  return fs::exists(folder / "checkpoint.h5") && belongs(folder, scenario) &&
         results::read_text(folder / "scenario.resolved.yaml").starts_with(first_line);
}

std::optional<double> largest_difference_percent(const std::vector<double>& base, const std::vector<double>& peaks) {
  std::optional<double> largest;
  for (std::size_t k = 0; k < std::min(base.size(), peaks.size()); ++k) {
    const double difference = 100 * std::abs(peaks[k] - base[k]) / std::abs(base[k]);
    if (std::abs(base[k]) >= 1 && std::isfinite(difference)) largest = std::max(largest.value_or(0), difference);
  }
  return largest;
}

}  // namespace carus::study
