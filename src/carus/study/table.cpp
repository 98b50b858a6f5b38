// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>

#include "carus/study/study.hpp"

namespace carus::study {
namespace {

using Json = nlohmann::ordered_json;

Json number(double v) {
  if (!std::isfinite(v)) return nullptr;
  return std::strtod(fmt::format("{:.6g}", v).c_str(), nullptr);
}
Json number(const std::optional<double>& v) { return v ? number(*v) : Json(nullptr); }

/// A number for people; what was not measured is a dash.
std::string cell(double v, const char* format) { return std::isfinite(v) ? fmt::format(fmt::runtime(format), v) : "-"; }

std::string joined(const std::vector<std::string>& words, const char* between) {
  std::string out;
  for (const auto& word : words) out += (out.empty() ? "" : between) + word;
  return out;
}

std::string line(const Entry& e) {
  const Measures& m = e.measures;
  const std::string head = fmt::format("| {} | {} | {} ", e.name, joined(e.set, ", "), m.outcome);
  if (m.outcome == "refused") return head + "| | | | | | | | | | | | |\n";
  std::vector<std::string> peaks;
  for (const double p : m.peaks) peaks.push_back(cell(p, "{:.0f}"));
  return head + fmt::format("| {} | {} | {} | {} | {}/{} | {} | {} | {} | {} | {} | {} | {} |\n", m.contractions,
                            cell(m.birth_time.value_or(NAN) / 60, "{:.1f}"), cell(e.difference.value_or(NAN), "{:.1f}"),
                            cell(m.uterus_ratio, "{:.2f}"), m.recessions, m.rests, cell(m.rotation, "{:.0f}"),
                            cell(m.extension, "{:.0f}"), cell(m.penetration, "{:.2f}"),
                            cell(m.kinetic_over_internal, "{:.3f}"), cell(m.energy_imbalance, "{:.4f}"),
                            cell(m.wall, "{:.0f}"), joined(peaks, " "));
}

}  // namespace

std::string markdown(const Table& t) {
  std::string out = fmt::format(
      "# Study\n\n`{}`, variants `{}`, carus {} ({}).\n\n"
      "| row | set | outcome | contractions | birth min | differs % | uterus end/start | recessions | rotation deg | "
      "extension deg | penetration mm | kinetic/internal | energy imbalance | wall s | head at contraction peaks mm |\n"
      "|---|---|---|---|---|---|---|---|---|---|---|---|---|---|---|\n",
      t.scenario, t.variants, t.version, t.commit);
  for (const Entry& e : t.entries) out += line(e);
  out +=
      "\n*differs*: largest relative difference of the head's descent at a contraction peak before birth that both the "
      "row and the base have.\n";
  for (const Entry& e : t.entries) {
    const Measures& m = e.measures;
    if (!e.same_as.empty()) out += fmt::format("- {}: the same scenario as {}, computed once.\n", e.name, e.same_as);
    if (!m.reason.empty()) out += fmt::format("- {}: {}: {}\n", e.name, m.outcome, m.reason);
    if (m.commit != t.commit || m.version != t.version)
      out += fmt::format("- {}: kept from carus {} ({}).\n", e.name, m.version, m.commit);
  }
  if (t.interrupted) out += "- Interrupted: rows are missing; the same command goes on.\n";
  return out;
}

std::string json(const Table& t) {
  Json j{{"scenario", t.scenario},
         {"variants", t.variants},
         {"version", t.version},
         {"commit", t.commit},
         {"interrupted", t.interrupted}};
  j["rows"] = Json::array();
  for (const Entry& e : t.entries) {
    const Measures& m = e.measures;
    Json row{{"name", e.name}, {"set", e.set}, {"outcome", m.outcome}};
    if (!e.same_as.empty()) row["same_as"] = e.same_as;
    if (!m.reason.empty()) row["reason"] = m.reason;
    row["version"] = m.version, row["commit"] = m.commit;
    if (m.outcome != "refused") {
      row["contractions"] = m.contractions;
      row["birth_time_s"] = number(m.birth_time);
      row["head_at_contraction_peaks_mm"] = Json::array();
      for (const double p : m.peaks) row["head_at_contraction_peaks_mm"].push_back(number(p));
      row["difference_percent"] = number(e.difference);
      row["uterus_ratio"] = number(m.uterus_ratio);
      row["recessions"] = m.recessions, row["rests"] = m.rests;
      row["internal_rotation_deg"] = number(m.rotation);
      row["extension_deg"] = number(m.extension);
      row["max_penetration_mm"] = number(m.penetration);
      row["kinetic_over_internal_max"] = number(m.kinetic_over_internal);
      row["energy_balance_error"] = number(m.energy_imbalance);
      row["wall_s"] = number(m.wall);
    }
    j["rows"].push_back(row);
  }
  return j.dump(2) + "\n";
}

}  // namespace carus::study
