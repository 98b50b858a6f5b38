// SPDX-License-Identifier: Apache-2.0
#include "carus/report/verdict.hpp"

#include <fmt/format.h>

#include <algorithm>

namespace carus::report {
namespace {

std::string in_words(const Folder& folder, const Verdict& v) {
  const int asked = v.inside + v.outside;
  std::string text = v.outside == 0 ? fmt::format("all {} asked parameters are inside", asked)
                                    : fmt::format("{} of {} asked parameters are outside", v.outside, asked);
  if (v.not_asked > 0) text += fmt::format(", {} not asked", v.not_asked);
  if (folder.status == RunStatus::in_progress)
    text +=
        fmt::format("; the run has not ended, judged as it stands at {:.1f} min", folder.curves.rows.back()[0] / 60);
  if (folder.status == RunStatus::failed) text += "; the run failed";
  return (v.met ? "MET: " : "NOT MET: ") + text;
}

/// Width on a terminal: code points, not bytes.
std::size_t width(const std::string& s) {
  return std::size_t(std::count_if(s.begin(), s.end(), [](char c) { return (c & 0xC0) != 0x80; }));
}
std::string padded(const std::string& s, std::size_t to) { return s + std::string(to - std::min(to, width(s)), ' '); }

}  // namespace

Verdict judge(const Folder& folder) {
  Verdict v;
  if (!folder.scenario) {
    v.line = "NOT JUDGED: " + (folder.path / "scenario.resolved.yaml").string() +
             " cannot be read, and says what the loads were; run the birth again with this version";
    return v;
  }
  const auto& loads = folder.scenario->loads;
  const auto figures = results::figures_of(folder.curves, loads.contractions);
  v.rows = results::validation_of(figures);
  for (auto& band : results::bands_of(figures, loads)) v.rows.push_back(std::move(band));
  for (const auto& row : v.rows) ++(!row.asked ? v.not_asked : row.inside ? v.inside : v.outside);
  v.met = v.outside == 0 && folder.status == RunStatus::finished;
  v.line = in_words(folder, v);
  return v;
}

std::string as_text(const Folder& folder, const Verdict& verdict) {
  std::string out = fmt::format("{} ({}, {})\n", folder.path.string(), folder.name(), name_of(folder.status));
  for (const auto& note : folder.notes) out += fmt::format("note: {}\n", note);
  std::size_t what = 0, expected = 0, obtained = 0;
  for (const auto& r : verdict.rows) {
    what = std::max(what, width(r.what)), expected = std::max(expected, width(r.expected)),
    obtained = std::max(obtained, width(r.obtained));
  }
  for (const auto& r : verdict.rows) {
    out += fmt::format("{:7} {}  {}  {}  {:9}  {}\n", r.number > 0 ? fmt::format("band {}", r.number) : "paper",
                       padded(r.what, what), padded(r.expected, expected), padded(r.obtained, obtained),
                       !r.asked   ? "not asked"
                       : r.inside ? "inside"
                                  : "OUTSIDE",
                       r.source);
  }
  return out + verdict.line + "\n";
}

}  // namespace carus::report
