// SPDX-License-Identifier: Apache-2.0
#include "carus/scenario/consistency.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "carus/scenario/units.hpp"

namespace carus::scenario {

namespace {

class Check {
 public:
  Check(const Scenario& s, const Settings& settings) : s_(s), settings_(settings) {}

  void times() {
    const labour::Contractions& c = s_.loads.contractions;
    if (c.rise + c.fall > c.duration)
      refuse("loads.contractions.duration", seconds(c.duration), fmt::format("at least {}", seconds(c.rise + c.fall)),
             "rise and fall must fit in: shorten loads.contractions.rise or fall");
    if (c.duration > c.period)
      refuse("loads.contractions.period", seconds(c.period), fmt::format("at least {}", seconds(c.duration)),
             "contractions must not overlap: shorten loads.contractions.duration");
    const labour::Push& p = s_.loads.push;
    if (p.efforts > 1 && p.efforts * p.effort_duration > c.duration)
      refuse("loads.push.effort_duration", seconds(p.effort_duration),
             fmt::format("at most {}", seconds(c.duration / p.efforts)),
             fmt::format("{} efforts must fit in one contraction: ask for fewer loads.push.efforts", p.efforts));
    if (s_.output.curve_interval > s_.numerics.labour_duration)
      refuse("output.curve_interval", seconds(s_.output.curve_interval),
             fmt::format("at most {}", seconds(s_.numerics.labour_duration)),
             "no row would be written: raise numerics.labour_duration");
  }

  void fetus() {
    const anatomy::FetusParameters& f = s_.anatomy.fetus;
    for (const auto& [path, value] :
         {std::pair{"fetus.biparietal", f.biparietal}, std::pair{"fetus.suboccipitobregmatic", f.suboccipitobregmatic}})
      if (value > f.occipitofrontal)
        refuse(path, format_quantity(value, "mm"), fmt::format("at most {}", format_quantity(f.occipitofrontal, "mm")),
               "the occipitofrontal diameter is the longest of the three: raise fetus.occipitofrontal");
  }

  void canal() {
    const anatomy::CanalParameters& c = s_.anatomy.canal;
    if (c.vulva_radius > c.radius)
      refuse("canal.vulva_radius", format_quantity(c.vulva_radius, "mm"),
             fmt::format("at most {}", format_quantity(c.radius, "mm")),
             "the canal narrows towards the vulva: raise canal.radius");
    const double vulva = anatomy::CanalAxis(c).vulva();
    for (const auto& [path, value] :
         {std::pair{"canal.taper_start", c.taper_start}, std::pair{"canal.floor_top", c.floor_top}})
      if (value >= vulva)
        refuse(path, format_quantity(value, "mm"), fmt::format("below {}", format_quantity(vulva, "mm")),
               "it lies before the vulva, whose depth canal.bend_start, bend_radius and bend_angle set");
  }

  void material(const std::string& region, const material::Material& m) {
    const std::string path = "materials." + region;
    const bool hooke = m.law == material::Law::hooke_corotated || m.law == material::Law::hooke_small_strain;
    if (hooke && m.youngs_modulus <= 0)
      refuse(path + ".youngs_modulus", "0 kPa", "above 0 kPa", "Hooke's law needs it");
    if (!hooke && m.c10 + m.c01 <= 0)
      refuse(path + ".c10", "0 kPa", "above 0 kPa", "neo-Hooke and Mooney-Rivlin need it");
    if (m.c01 > 0 && m.law != material::Law::mooney_rivlin)
      refuse(path + ".c01", format_quantity(m.c01, "kPa"), "0 kPa",
             "only the law mooney_rivlin has it: set " + path + ".law");
    double share = 0;
    for (const material::PronyTerm& term : m.prony) share += term.g;
    if (share >= 1)
      refuse(path + ".prony", "sum of g " + format_number(share), "below 1",
             "something must remain when all has relaxed");
    static constexpr std::array uterine{"uterine_fundus", "uterine_body", "lower_segment", "vaginal_canal"};
    if (m.fibre_k1 > 0 && std::find(uterine.begin(), uterine.end(), region) == uterine.end())
      refuse(path + ".fibre.k1", format_quantity(m.fibre_k1, "kPa"), "0 kPa", "only the uterus has a field of fibres");
  }

  void calibrated() {
    std::vector<std::string> known;
    for (const Leaf& leaf : leaves(schema())) known.push_back(leaf.path);
    for (std::size_t i = 0; i < s_.calibrated.size(); ++i) {
      const std::string& key = s_.calibrated[i].key;
      if (std::find(known.begin(), known.end(), key) == known.end())
        refuse(fmt::format("calibrated[{}].key", i), fmt::format("\"{}\"", key), "a key of the schema",
               "did you mean " + nearest_key(key) + "?");
    }
  }

  void landmarks() {
    const auto& from = s_.anatomy.bones_from;
    if (!from.given() && !from.landmarks.empty())
      refuse("pelvis.landmarks", fmt::format("a list of {}", from.landmarks.size()), "an empty list",
             "without pelvis.from or pelvis.surfaces there is nothing in which they could have been seen");
    for (auto l = from.landmarks.begin(); l != from.landmarks.end(); ++l)
      if (std::any_of(from.landmarks.begin(), l, [&](const auto& other) { return other.name == l->name; }))
        refuse(fmt::format("pelvis.landmarks[{}].name", l - from.landmarks.begin()), "\"" + l->name + "\"",
               "each name once", "one of the two must go");
  }

  void solver() {
    if (s_.implicit.least_time_step > s_.implicit.time_step)
      refuse("solver.implicit.least_time_step", seconds(s_.implicit.least_time_step),
             "at most " + seconds(s_.implicit.time_step), "it must not exceed solver.implicit.time_step");
  }

  Problems problems;

 private:
  static std::string seconds(double t) { return format_quantity(t, "s"); }

  void refuse(const std::string& path, const std::string& value, const std::string& allowed_values,
              const std::string& hint) {
    const auto it = settings_.files.find(path);
    const std::string& file = it == settings_.files.end() ? s_.file : it->second;
    problems.push_back(
        fmt::format("{}: {}: {} contradicts other keys; allowed {}; {}", file, path, value, allowed_values, hint));
  }

  const Scenario& s_;
  const Settings& settings_;
};

}  // namespace

Problems inconsistencies(const Scenario& s, const Settings& settings) {
  Check check(s, settings);
  check.times();
  check.fetus();
  check.canal();
  for (const auto& [region, material] : s.materials) check.material(region, material);
  check.calibrated();
  check.landmarks();
  check.solver();
  return std::move(check.problems);
}

}  // namespace carus::scenario
