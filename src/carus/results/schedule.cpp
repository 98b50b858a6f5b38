// SPDX-License-Identifier: Apache-2.0
#include "carus/results/schedule.hpp"

#include <algorithm>
#include <cmath>

#include "carus/results/figures.hpp"

namespace carus::results {

std::vector<Stop> schedule_of(const scenario::Scenario& s) {
  const double end = s.numerics.labour_duration;
  std::vector<Stop> outputs{{0, true, s.output.frames > 0}, {end, true, s.output.frames > 0}};
  for (double k = 1; k * s.output.curve_interval < end; ++k)
    outputs.push_back({k * s.output.curve_interval, true, false});
  for (int k = 1; k < s.output.frames; ++k) outputs.push_back({k * end / s.output.frames, true, true});
  for (const double t : contraction_starts(s.loads.contractions, end)) outputs.push_back({t, true, false});
  for (const double t : contraction_peaks(s.loads.contractions, end)) outputs.push_back({t, true, false});
  std::stable_sort(outputs.begin(), outputs.end(), [](const Stop& a, const Stop& b) { return a.time < b.time; });

  constexpr double same = 0.1, longest = 4;  // [s of labour]
  std::vector<Stop> stops{outputs.front()};
  for (std::size_t i = 1; i < outputs.size(); ++i) {
    const Stop& next = outputs[i];
    const double last = stops.back().time;
    if (next.time - last < same) {
      stops.back().frame |= next.frame;
      continue;
    }
    const int parts = std::max(1, int(std::ceil((next.time - last) / longest - 1e-9)));
    for (int k = 1; k < parts; ++k) stops.push_back({last + k * (next.time - last) / parts, false, false});
    stops.push_back(next);
  }
  return stops;
}

}  // namespace carus::results
