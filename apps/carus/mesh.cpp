// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>
#include <tbb/parallel_for.h>

#include <fstream>

#include "app.hpp"
#include "carus/core/atomic_file.hpp"
#include "carus/core/units.hpp"
#include "carus/imaging/write_surface.hpp"
#include "organs.hpp"
#ifdef CARUS_WITH_MESHING
#include "carus/meshing/closed_solid.hpp"
#include "carus/meshing/precision.hpp"
#include "carus/meshing/simplify.hpp"
#endif

namespace carus::app {
namespace {

#ifndef CARUS_WITH_MESHING
[[noreturn]] void needs_meshing() {
  throw InputError("this build has no meshing (CARUS_MESHING=OFF): configure with -DCARUS_MESHING=ON");
}
#endif

struct SurfaceArguments {
  OrganOptions source;
  std::string out, error;
  std::size_t nodes = 0;
  double reduction = -1;
};

mesh::Surface simplified(const Organ& organ, const SurfaceArguments& a) {
  const int ways = (a.nodes > 0) + (a.reduction >= 0) + !a.error.empty();
  if (ways > 1) throw InputError("--nodes, --reduction, --error: at most one of them");
  if (ways == 0) return organ.surface;
#ifdef CARUS_WITH_MESHING
  if (!a.error.empty()) return meshing::simplify_within(organ.surface, length(a.error, "--error", 1e-6, 0.1));
  if (a.reduction >= 100) throw InputError(fmt::format("--reduction {}; allowed 0 to below 100 %", a.reduction));
  const auto n =
      a.nodes > 0 ? a.nodes : static_cast<std::size_t>((1 - a.reduction / 100) * double(organ.surface.nodes.size()));
  if (n > organ.surface.nodes.size())
    throw InputError(fmt::format("--nodes {}; {} has {}: draw its surface finer with --spacing", n, organ.name,
                                 organ.surface.nodes.size()));
  return meshing::simplify_soundly(organ.surface, n);
#else
  needs_meshing();
#endif
}

/// The file of one of several organs: its name goes before the extension.
std::filesystem::path file_of(const std::filesystem::path& out, const std::string& organ, bool several) {
  if (!several) return out;
  std::string tag = organ;
  std::replace_if(
      tag.begin(), tag.end(), [](char c) { return !std::isalnum(static_cast<unsigned char>(c)); }, '_');
  auto file = out;
  return file.replace_filename(out.stem().string() + "_" + tag + out.extension().string());
}

int surface(const SurfaceArguments& a) {
  const auto list = organs(a.source);
  for (const auto& organ : list) {
    const auto s = simplified(organ, a);
    const auto file = file_of(a.out, organ.name, list.size() > 1);
    imaging::write_surface(s, file);
    fmt::print("{}: {} nodes, {:.1f} ml ({:+.2f} %), in {}\n", organ.name, s.nodes.size(), 1e6 * mesh::volume(s),
               100 * (mesh::volume(s) / mesh::volume(organ.surface) - 1), file.string());
#ifdef CARUS_WITH_MESHING
    if (s.nodes.size() < organ.surface.nodes.size()) {
      const auto d = meshing::compare(meshing::Distances(organ.surface), s);
      fmt::print("{}: {:.3f} mm from the surface before simplification in the mean, {:.3f} mm at most\n", organ.name,
                 d.mean() / units::mm, d.largest() / units::mm);
    }
#endif
  }
  return done;
}

struct PrecisionArguments {
  OrganOptions source;
  std::string out, d_organ;
  std::vector<double> reductions{10, 20, 30, 40, 50, 60, 70, 80, 85, 90, 95, 98};
  double map_at = 90;
  std::size_t samples = 100000;
};

#ifdef CARUS_WITH_MESHING
void find_d_organ(Organ& organ, const meshing::Distances& d, const std::string& wanted) {
  if (wanted == "iliac_wing") {
    organ.d_organ = meshing::iliac_wing_thickness(d).median;
    organ.d_organ_is = "thickness of the iliac wing, measured";
  } else if (wanted == "thin_part" || (wanted.empty() && organ.d_organ == 0)) {
    organ.d_organ = meshing::thin_part_thickness(d).median;
    organ.d_organ_is = "thickness of its thin parts, measured";
  } else if (!wanted.empty()) {
    organ.d_organ = length(wanted, "--d-organ", 1e-4, 1);
    organ.d_organ_is = "given";
  }
}

void write_map(const meshing::Distances& original, const mesh::Surface& simplified, const std::filesystem::path& file) {
  auto d = meshing::Distances(simplified).to(original.surface().nodes);
  for (auto& x : d) x /= units::mm;
  imaging::write_surface(original.surface(), file, {{"distance_mm", std::move(d)}});
}

std::string csv_rows(const Organ& organ, const meshing::Precision& p) {
  std::string text;
  for (const auto& r : p.rows) {
    const auto &f = r.deviation.forward, &b = r.deviation.backward;
    text += fmt::format("{:.6g},{},{:.6g},{:.6g},{:.6g},", 100 * r.reduction, r.nodes, r.deviation.mean() / units::mm,
                        r.deviation.largest() / units::mm, r.alpha(organ.d_organ));
    for (const auto* d : {&f, &b})
      text += fmt::format("{:.6g},{:.6g},{:.6g},{:.6g},", d->mean / units::mm, d->rms / units::mm,
                          d->percentile_95 / units::mm, d->largest / units::mm);
    text += fmt::format("{:.6g},{},{}\n", organ.d_organ / units::mm, organ.surface.nodes.size(), organ.name);
  }
  return text;
}

constexpr const char* csv_head =
    "reduction_percent,nodes,d_mean_mm,d_max_mm,alpha_percent,forward_mean_mm,forward_rms_mm,forward_p95_mm,forward_"
    "max_mm,"
    "backward_mean_mm,backward_rms_mm,backward_p95_mm,backward_max_mm,d_organ_mm,nodes_before,organ\n";

/// What is told of an organ, and its rows of the CSV.
struct Measured {
  std::string told, csv;
};

Measured measure(Organ& organ, const PrecisionArguments& a, bool several) {
  const meshing::Distances original(organ.surface);
  find_d_organ(organ, original, a.d_organ);
  std::vector<double> reductions;
  for (const double r : a.reductions) {
    if (!(r >= 0 && r < 100)) throw InputError(fmt::format("--reductions {}; allowed 0 to below 100 %", r));
    reductions.push_back(r / 100);
  }
  const auto p = meshing::precision(original, reductions, a.samples);
  auto told = fmt::format("\n{}: {} nodes, d_organ {:.2f} mm: {}\n{:>12}{:>10}{:>12}{:>12}{:>12}\n", organ.name,
                          organ.surface.nodes.size(), organ.d_organ / units::mm, organ.d_organ_is, "reduction %",
                          "nodes", "d_mean mm", "d_max mm", "alpha %");
  std::size_t nearest = 0;
  for (std::size_t i = 0; i < p.rows.size(); ++i) {
    const auto& r = p.rows[i];
    told += fmt::format("{:>12.6g}{:>10}{:>12.4f}{:>12.4f}{:>12.2f}\n", 100 * r.reduction, r.nodes,
                        r.deviation.mean() / units::mm, r.deviation.largest() / units::mm, r.alpha(organ.d_organ));
    if (std::abs(r.reduction - a.map_at / 100) < std::abs(p.rows[nearest].reduction - a.map_at / 100)) nearest = i;
  }
  if (a.map_at > 0) {
    auto file = file_of(a.out, organ.name, several);
    file.replace_extension(".vtp");
    write_map(original, p.surfaces[nearest], file);
    told += fmt::format("distance map at {:.6g} % in {}\n", 100 * p.rows[nearest].reduction, file.string());
  }
  return {told, csv_rows(organ, p)};
}

int precision(const PrecisionArguments& a) {
  if (a.reductions.empty()) throw InputError("--reductions: at least one");
  if (a.samples < 1000 || a.samples > 100000000)
    throw InputError(fmt::format("--samples {}; allowed 1000 to 100000000", a.samples));
  std::string csv = csv_head;
  auto list = organs(a.source);
  std::vector<Measured> measured(list.size());
  // Collapsing edges is the work of one thread: organs side by side, each a task of its own, for they differ in size.
  tbb::parallel_for(
      std::size_t(0), list.size(), [&](std::size_t i) { measured[i] = measure(list[i], a, list.size() > 1); },
      tbb::simple_partitioner());
  for (const auto& m : measured) fmt::print("{}", m.told), csv += m.csv;
  write_atomically(a.out, csv);
  fmt::print("{} in {}\n", list.size() == 1 ? "curve" : "curves", a.out);
  return done;
}
#else
int precision(const PrecisionArguments&) { needs_meshing(); }
#endif

void add_surface(CLI::App& mesh, int& status) {
  auto a = std::make_shared<SurfaceArguments>();
  auto* c =
      mesh.add_subcommand("surface", "A smooth closed surface of a label that keeps its volume, simplified if asked");
  add_organ_options(*c, a->source);
  c->add_option("--out", a->out, "File: .stl, .ply or .vtp, in RAS and mm; of several organs, each has its name in it")
      ->required();
  c->add_option("--nodes", a->nodes, "Simplify to so many nodes");
  c->add_option("--reduction", a->reduction, "Simplify: take so many per cent of the nodes away");
  c->add_option("--error", a->error, "Simplify as far as the distance, both ways, stays within this length");
  c->footer(
      "Examples:\n  carus mesh surface --labels pelvis.nii.gz --label 3 --out sacrum.stl --nodes 2000\n"
      "  carus mesh surface --labels pelvis.nii.gz --label 1+2 --out bones.vtp --error \"0.5 mm\"");
  c->callback([a, &status] { status = surface(*a); });
}

void add_precision(CLI::App& mesh, int& status) {
  auto a = std::make_shared<PrecisionArguments>();
  auto* c = mesh.add_subcommand("precision",
                                "What simplification costs: the paper's Figs. 2 and 3 and Table 1, as CSV and VTP");
  add_organ_options(*c, a->source);
  c->add_option("--out", a->out, "CSV; the distance map goes beside it as .vtp")->required();
  c->add_option("--reductions", a->reductions, "Parts of the nodes to take away [%]")
      ->delimiter(',')
      ->capture_default_str();
  c->add_option(
      "--d-organ", a->d_organ,
      "Length for alpha: a length with its unit, iliac_wing or thin_part (both measured); silent: thin_part, of "
      "generated organs the paper's");
  c->add_option("--map-at", a->map_at, "Reduction of the distance map [%]; 0: none")->capture_default_str();
  c->add_option("--samples", a->samples, "Points on each surface at which it is measured")->capture_default_str();
  c->footer(
      "Examples:\n  carus mesh precision --labels pelvis.nii.gz --label 1 --d-organ iliac_wing --out wing.csv\n"
      "  carus mesh precision --scenario scenarios/reference.yaml --organ fetus uterus --out organs.csv");
  c->callback([a, &status] { status = precision(*a); });
}

}  // namespace

void add_mesh(CLI::App& app, int& status) {
  auto* mesh = app.add_subcommand("mesh", "From images and surfaces to meshes: surface, precision, volume");
  mesh->require_subcommand(1);
  add_surface(*mesh, status);
  add_precision(*mesh, status);
  add_mesh_volume(*mesh, status);
}

}  // namespace carus::app
