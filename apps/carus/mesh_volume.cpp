// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include <charconv>

#include "app.hpp"
#include "carus/core/error.hpp"
#include "carus/core/units.hpp"
#include "carus/imaging/read_labels.hpp"
#include "carus/imaging/smooth_labels.hpp"
#include "carus/results/mesh_files.hpp"
#include "organs.hpp"
#ifdef CARUS_WITH_MESHING
#include "carus/meshing/closed_solid.hpp"
#include "carus/meshing/labelled_solid.hpp"
#include "carus/meshing/quality_report.hpp"
#include "carus/meshing/raise_altitudes.hpp"
#endif

namespace carus::app {
namespace {

struct VolumeArguments {
  OrganOptions source;
  std::vector<std::string> out, size_of;
  std::string size = "8 mm", feature_angle;
};

#ifdef CARUS_WITH_MESHING

/// Organs as one labelled solid, with what to compare the mesh with.
struct Solid {
  meshing::LabelFunction label;
  Vec3 low, high;
  std::map<std::int32_t, std::string> names;
  std::map<std::int32_t, double> volumes;          ///< [m^3]
  std::map<std::int32_t, mesh::Surface> surfaces;  ///< of organs that come as surfaces
};

Solid from_labels(const OrganOptions& o) {
  const auto file = imaging::read_labels(o.labels);
  for (const auto& n : file.notes) fmt::print("{}\n", n);
  const auto counts = imaging::count_labels(file.volume);
  std::vector<std::int32_t> labels;
  for (const auto& w : o.which) {
    std::int32_t l = 0;
    if (std::from_chars(w.data(), w.data() + w.size(), l).ptr != w.data() + w.size())
      throw InputError(fmt::format("--label {}; for a volume each label is an organ of its own: a whole number", w));
    labels.push_back(l);
  }
  if (labels.empty())
    for (const auto& [l, n] : counts) labels.push_back(l);
  if (labels.empty()) throw InputError(fmt::format("{}: every voxel is 0: no label in it", o.labels));
  const auto smooth = std::make_shared<imaging::SmoothLabels>(file.volume, labels, o.smoothing, o.labels);
  Solid s{[smooth](const Vec3& x) { return smooth->label(x); }, smooth->box().low, smooth->box().high, {}, {}, {}};
  for (const auto l : labels) s.volumes[l] = double(counts.at(l)) * file.volume.voxel_volume();
  return s;
}

/// Where two surfaces overlap the one given first has it.
Solid from_surfaces(const OrganOptions& o) {
  auto solids = std::make_shared<std::vector<meshing::ClosedSolid>>();
  Solid s{{}, Vec3::Constant(1e9), Vec3::Constant(-1e9), {}, {}, {}};
  std::int32_t label = 0;
  for (const auto& organ : organs(o)) {
    meshing::require_no_self_intersection(organ.surface, organ.name);
    solids->emplace_back(organ.surface);
    const auto box = mesh::box(organ.surface);
    s.low = s.low.cwiseMin(box.min()), s.high = s.high.cwiseMax(box.max());
    s.names[++label] = organ.name, s.volumes[label] = mesh::volume(organ.surface), s.surfaces[label] = organ.surface;
  }
  s.label = [solids](const Vec3& x) {
    for (std::size_t i = 0; i < solids->size(); ++i)
      if ((*solids)[i].contains(x)) return static_cast<std::int32_t>(i + 1);
    return 0;
  };
  return s;
}

/// Edge lengths: the general one, and those of organs that have their own ("3=2 mm", or by name).
std::map<std::int32_t, double> sizes(const VolumeArguments& a, const Solid& s) {
  std::map<std::int32_t, double> h;
  for (const auto& [l, v] : s.volumes) h[l] = length(a.size, "--size", 2e-4, 0.1);
  for (const auto& text : a.size_of) {
    const auto sign = text.find('=');
    const auto key = text.substr(0, sign);
    const auto it = std::find_if(h.begin(), h.end(), [&](const auto& entry) {
      const auto name = s.names.find(entry.first);
      return key == std::to_string(entry.first) || (name != s.names.end() && key == name->second);
    });
    if (sign == std::string::npos || it == h.end())
      throw InputError(fmt::format("--size-of {}; allowed LABEL=LENGTH for a label or organ that there is", text));
    it->second = length(text.substr(sign + 1), "--size-of " + key, 2e-4, 0.1);
  }
  return h;
}

/// What the mesh keeps of the surfaces' edges.
std::vector<mesh::FeatureLine> features(const VolumeArguments& a, const Solid& s,
                                        const std::map<std::int32_t, double>& h) {
  if (a.feature_angle.empty()) return {};
  if (s.surfaces.empty())
    throw InputError("--feature-angle is of --surface: the surfaces of labels are smooth; leave it out");
  std::vector<mesh::Featured> from;
  for (const auto& [l, surface] : s.surfaces) from.push_back({&surface, h.at(l)});
  auto lines = mesh::feature_lines(from, angle(a.feature_angle, "--feature-angle", 30 * units::deg, 150 * units::deg));
  double whole = 0;
  for (const auto& line : lines) whole += mesh::length(line);
  fmt::print("{} feature lines, {:.1f} mm\n", lines.size(), 1e3 * whole);
  return lines;
}

mesh::TetMesh tetrahedra(const Solid& s, const std::map<std::int32_t, double>& h,
                         const std::vector<mesh::FeatureLine>& lines) {
  // A facet serves the finer of its two sides.
  const auto facet = [h](const Vec3&, std::int32_t a, std::int32_t b) {
    const auto at = [&](std::int32_t l) { return h.contains(l) ? h.at(l) : 1.0; };
    return std::min(at(a), at(b));
  };
  double finest = 1;
  for (const auto& [l, size] : h) finest = std::min(finest, size);
  const Vec3 centre = (s.low + s.high) / 2;
  auto m = meshing::mesh_labelled_solid(
      s.label, {centre, (s.high - s.low).norm() / 2 + finest},
      {.facet = facet,
       .distance = [facet](const Vec3& x, std::int32_t a, std::int32_t b) { return 0.1 * facet(x, a, b); },
       .cell = [h](const Vec3&, std::int32_t l) { return 1.3 * (h.contains(l) ? h.at(l) : 1.0); },
       .seed_spacing = std::max(0.6 * finest, (s.high - s.low).maxCoeff() / 400),
       .features = lines});
  if (lines.empty())
    meshing::raise_altitudes(m, 0.25 * finest);
  else
    meshing::raise_altitudes(m, 0.25 * finest, 0);  // lines and planes stay what they are
  return m;
}

int volume(const VolumeArguments& a) {
  if (a.source.labels.empty() == a.source.surfaces.empty())
    throw InputError("give either --labels FILE or --surface FILE (again for each organ)");
  const auto solid = a.source.labels.empty() ? from_surfaces(a.source) : from_labels(a.source);
  const auto h = sizes(a, solid);
  const auto m = tetrahedra(solid, h, features(a, solid, h));
  fmt::print("{:<20}{:>9}{:>12}{:>11}{:>10}{:>10}{:>13}{:>9}\n", "", "tets", "volume ml", "of source", "min deg",
             "max deg", "altitude mm", "aspect");
  int missing = 0;
  const auto report = meshing::quality_report(m);
  for (const auto& [l, wanted] : solid.volumes) {
    const auto name = solid.names.contains(l) ? solid.names.at(l) : fmt::format("label {}", l);
    const auto it = report.find(l);
    if (it == report.end()) {
      fmt::print("{:<20} no tetrahedron: it is smaller than --size, or lies within an organ given before it\n", name);
      ++missing;
      continue;
    }
    const auto& q = it->second;
    fmt::print("{:<20}{:>9}{:>12.2f}{:>10.1f}%{:>10.1f}{:>10.1f}{:>13.2f}{:>9.1f}\n", name, q.tets, 1e6 * q.volume,
               100 * q.volume / wanted, q.min_dihedral_deg, q.max_dihedral_deg, 1e3 * q.min_altitude, q.max_aspect);
  }
  if (missing > 0) throw InputError(fmt::format("{} organs have no tetrahedron; nothing is written", missing));
  for (const auto& file : a.out) results::write_mesh(m, solid.names, file);
  fmt::print("{} nodes, {} tetrahedra in {}\n", m.nodes.size(), m.tets.size(), fmt::join(a.out, ", "));
  return done;
}
#else
int volume(const VolumeArguments&) {
  throw InputError("this build has no meshing (CARUS_MESHING=OFF): configure with -DCARUS_MESHING=ON");
}
#endif

}  // namespace

void add_mesh_volume(CLI::App& mesh, int& status) {
  auto a = std::make_shared<VolumeArguments>();
  auto* c =
      mesh.add_subcommand("volume", "Tetrahedra of labels or closed surfaces; organs that touch share their nodes");
  add_organ_options(*c, a->source);
  c->add_option("--size", a->size, "Length of an edge")->capture_default_str();
  c->add_option("--size-of", a->size_of, "The same for one organ: LABEL=LENGTH or NAME=LENGTH");
  c->add_option("--feature-angle", a->feature_angle,
                "Keep the surfaces' edges across which they turn by more than this, as \"45 deg\"; none if silent");
  c->add_option("--out", a->out, "File: .vtu, .msh, .inp or .stl, in RAS and mm; may be given again")->required();
  c->footer(
      "Examples:\n  carus mesh volume --labels pelvis.nii.gz --size \"6 mm\" --size-of 4=\"2 mm\" --out pelvis.vtu "
      "pelvis.msh\n"
      "  carus mesh volume --surface sacrum.stl coccyx.stl --unit mm --frame LSA --out back.inp\n"
      "  carus mesh volume --surface implant.stl --unit mm --frame RAS --feature-angle \"45 deg\" --out implant.vtu");
  c->callback([a, &status] { status = volume(*a); });
}

}  // namespace carus::app
