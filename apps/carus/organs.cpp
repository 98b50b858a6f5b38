// SPDX-License-Identifier: Apache-2.0
#include "organs.hpp"

#include <fmt/format.h>

#include <charconv>

#include "carus/anatomy/uterus.hpp"
#include "carus/core/error.hpp"
#include "carus/core/units.hpp"
#include "carus/imaging/extract_surface.hpp"
#include "carus/imaging/read_labels.hpp"
#include "carus/imaging/read_surface.hpp"
#include "carus/scenario/scenario.hpp"
#include "carus/scenario/units.hpp"

namespace carus::app {
namespace {

void tell(const std::string& name, const std::vector<std::string>& notes) {
  for (const auto& n : notes) fmt::print("{}: {}\n", name, n);
}

std::vector<std::int32_t> labels_of(const std::string& text) {
  std::vector<std::int32_t> labels;
  for (std::size_t at = 0; at <= text.size();) {
    const auto end = std::min(text.find('+', at), text.size());
    std::int32_t l = 0;
    const auto [rest, problem] = std::from_chars(text.data() + at, text.data() + end, l);
    if (problem != std::errc() || rest != text.data() + end || l < 1 || l > 65535)
      throw InputError(
          fmt::format("--label {}: allowed whole numbers from 1 to 65535, or several joined as in 1+2", text));
    labels.push_back(l);
    at = end + 1;
  }
  return labels;
}

imaging::ExtractOptions extract_options(const OrganOptions& o) {
  return {o.smoothing, o.spacing.empty() ? 0 : length(o.spacing, "--spacing", 1e-5, 0.02), o.largest};
}

Organ from_labels(const imaging::LabelVolume& v, std::int32_t label, const std::string& name, const std::string& file,
                  const imaging::ExtractOptions& options) {
  auto e = imaging::extract_surface(v, label, options, file);
  tell(name, e.notes);
  fmt::print("{}: {} nodes, {:.1f} ml of {:.1f} ml labelled ({:+.2f} %)\n", name, e.surface.nodes.size(),
             1e6 * e.volume, 1e6 * e.labelled_volume, 100 * (e.volume / e.labelled_volume - 1));
  return {name, std::move(e.surface), 0, ""};
}

void add_labelled(const OrganOptions& o, std::vector<Organ>& organs) {
  auto file = imaging::read_labels(o.labels);
  tell(o.labels, file.notes);
  auto which = o.which;
  if (which.empty())
    for (const auto& [l, n] : imaging::count_labels(file.volume)) which.push_back(std::to_string(l));
  if (which.empty()) throw InputError(fmt::format("{}: every voxel is 0: no label in it", o.labels));
  for (const auto& w : which) {
    const auto labels = labels_of(w);
    const auto* v = &file.volume;
    imaging::LabelVolume joined;
    if (labels.size() > 1) {
      joined = file.volume, v = &joined;
      for (auto& l : joined.labels) l = std::find(labels.begin(), labels.end(), l) != labels.end() ? labels[0] : 0;
    }
    organs.push_back(from_labels(*v, labels[0], "label " + w, o.labels, extract_options(o)));
  }
}

/// A generated organ, as finely as asked: its solid put on voxels of 0.7 of the surface's spacing and taken off again.
Organ generated(const scenario::Scenario& s, const std::string& name, const OrganOptions& o) {
  const anatomy::Fetus fetus(s.anatomy.fetus);
  const anatomy::Uterus uterus(s.anatomy, fetus);
  const bool is_fetus = name == "fetus";
  if (!is_fetus && name != "uterus") throw InputError(fmt::format("--organ {}: allowed fetus, uterus", name));
  auto options = extract_options(o);
  const double h = options.spacing > 0 ? options.spacing : 0.001;
  const auto land = fetus.landmarks();
  const double half = s.anatomy.fetus.shoulder_width / 2 + 0.03;
  const Vec3 end = uterus.axis().point(uterus.axis().vulva());
  const Vec3 low(-half, -half, is_fetus ? fetus.bottom_z() - 0.01 : end.z() - 0.06),
      high(half, is_fetus ? half : std::max(half, end.y() + 0.06), land.at("breech").z() + 0.03);
  imaging::LabelVolume v;
  v.axes = h * Mat3::Identity(), v.origin = low;
  for (int k = 0; k < 3; ++k) v.size[k] = static_cast<int>(std::ceil((high[k] - low[k]) / h));
  v.labels.resize(v.index(0, 0, v.size[2]));
  for (int k = 0; k < v.size[2]; ++k)
    for (int j = 0; j < v.size[1]; ++j)
      for (int i = 0; i < v.size[0]; ++i) {
        const Vec3 x = v.position({double(i), double(j), double(k)});
        v.labels[v.index(i, j, k)] = is_fetus ? fetus.distance(x) < 0 : uterus.label(x) != anatomy::outside;
      }
  options.spacing = h;
  auto organ = from_labels(v, 1, name, s.file, options);
  organ.d_organ = is_fetus ? s.anatomy.fetus.biparietal : s.anatomy.uterus.wall_body;
  organ.d_organ_is = is_fetus ? "diameter of the head (fetus.biparietal)" : "thickness of the wall (uterus.wall_body)";
  return organ;
}

}  // namespace

namespace {

/// A number with its unit, from low to high in the unit that messages use; returns it in SI.
double quantity(const std::string& text, const std::string& option, double low, double high, const char* unit,
                const char* what, const char* example) {
  const auto q = scenario::split_quantity(text);
  const auto *given = q ? scenario::find_unit(q->unit) : nullptr, *told = scenario::find_unit(unit);
  const double value = given != nullptr && given->dimension == told->dimension ? q->number * given->factor : -1;
  if (!(value >= low * told->factor && value <= high * told->factor))
    throw InputError(fmt::format("{} \"{}\"; allowed {} with its unit from {:.6g} {} to {:.6g} {}, as \"{}\"", option,
                                 text, what, low, unit, high, unit, example));
  return value;
}

}  // namespace

double length(const std::string& text, const std::string& option, double low, double high) {
  return quantity(text, option, low / units::mm, high / units::mm, "mm", "a length", "1 mm");
}

double angle(const std::string& text, const std::string& option, double low, double high) {
  return quantity(text, option, low / units::deg, high / units::deg, "deg", "an angle", "45 deg");
}

void add_organ_options(CLI::App& c, OrganOptions& o) {
  c.add_option("--labels", o.labels, "Label volume: NIfTI, NRRD or MetaImage");
  c.add_option("--label", o.which,
               "Label of an organ in it; several make several organs, 1+2 makes one of two; all if silent");
  c.add_option("--surface", o.surfaces, "Closed surface: STL, OBJ, PLY, VTP, glTF, GLB; several make several organs");
  c.add_option("--unit", o.unit, "Unit of the surfaces' files: m, cm, mm, um (glTF: m)");
  c.add_option("--frame", o.frame, "Where their +x, +y, +z point: RAS, LPS, LSA ... (glTF: LSA)");
  c.add_option("--part", o.part, "Only the node or mesh of this name in a glTF file");
  c.add_option("--scenario", o.scenario, "Scenario whose generated organs to take");
  c.add_option("--organ", o.organs, "Which of them: fetus, uterus")->capture_default_str();
  c.add_option("--smoothing", o.smoothing,
               "Standard deviation of the Gaussian that takes the voxels' steps away [voxels]")
      ->capture_default_str();
  c.add_option("--spacing", o.spacing, "Length of the grid that a label's surface is drawn on; a voxel if silent");
  c.add_flag("--largest-part", o.largest, "Keep only the largest connected part of each label");
}

std::vector<Organ> organs(const OrganOptions& o) {
  std::vector<Organ> found;
  if (!o.labels.empty()) add_labelled(o, found);
  for (const auto& file : o.surfaces) {
    auto closed = imaging::read_surface({file, o.unit, o.frame, o.part});
    tell(file, closed.repairs);
    const auto name = std::filesystem::path(file).stem().string();
    fmt::print("{}: {} nodes, {:.1f} ml\n", name, closed.surface.nodes.size(), 1e6 * mesh::volume(closed.surface));
    found.push_back({name, std::move(closed.surface), 0, ""});
  }
  if (!o.scenario.empty()) {
    const auto s = scenario::load(o.scenario);
    for (const auto& name : o.organs) found.push_back(generated(s, name, o));
  }
  if (found.empty()) throw InputError("no organ: give --labels FILE, --surface FILE or --scenario FILE");
  return found;
}

}  // namespace carus::app
