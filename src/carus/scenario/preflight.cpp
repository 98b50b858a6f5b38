// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "carus/core/units.hpp"
#include "carus/scenario/assemble.hpp"

namespace carus::scenario {

namespace {

using Findings = std::vector<std::string>;
constexpr double mm = units::mm;

/// The head's two presenting diameters against every passage of bone and of the canal. Moulding gives a few mm: a
/// warning.
void head_against_passage(const Scenario& s, Findings& findings) {
  const anatomy::Parameters& p = s.anatomy;
  const double narrow = std::min(p.fetus.biparietal, p.fetus.suboccipitobregmatic),
               wide = std::max(p.fetus.biparietal, p.fetus.suboccipitobregmatic);
  const double walls = 2 * p.uterus.wall_canal;
  struct Passage {
    const char* key;
    double room, head;
  };
  for (const auto& [key, room, head] : {Passage{"pelvis.obstetric_conjugate", p.pelvis.obstetric_conjugate, wide},
                                        Passage{"pelvis.transverse_inlet", p.pelvis.transverse_inlet, wide},
                                        Passage{"pelvis.interspinous", p.pelvis.interspinous, narrow},
                                        Passage{"pelvis.intertuberous", p.pelvis.intertuberous, narrow},
                                        Passage{"pelvis.sagittal_outlet", p.pelvis.sagittal_outlet, wide}})
    if (head + walls > room)
      findings.push_back(fmt::format(
          "warning: {}: {:.1f} mm leaves {:.1f} mm between the walls of the canal; the head is {:.1f} mm wide there; "
          "it can pass only if it moulds by {:.1f} mm",
          key, room / mm, (room - walls) / mm, head / mm, (head + walls - room) / mm));
  // The head stretches the canal by its mean presenting diameter over the canal's.
  const double stretch = (narrow + wide) / 2 / (2 * p.canal.radius);
  if (stretch > 1.25)
    findings.push_back(
        fmt::format("warning: canal.radius: {:.1f} mm is stretched {:.2f} times by the head ({:.1f} x {:.1f} mm); in "
                    "trials 1 to 1.5 mm "
                    "of radius decided between birth and stall",
                    p.canal.radius / mm, stretch, narrow / mm, wide / mm));
}

void bend(const Scenario& s, Findings& findings) {
  const anatomy::Parameters& p = s.anatomy;
  const double inner = p.canal.bend_radius - p.canal.radius - p.uterus.wall_canal;
  if (p.canal.bend_angle > 0 && inner <= 0)
    findings.push_back(
        fmt::format("error: canal.bend_radius: {:.1f} mm is not above canal.radius + uterus.wall_canal = {:.1f} mm; "
                    "the wall folds over itself",
                    p.canal.bend_radius / mm, (p.canal.radius + p.uterus.wall_canal) / mm));
}

/// Requested against measured on the mesh, by the same keys.
void measured(const anatomy::Anatomy& a, Findings& findings) {
  for (const auto& [key, wanted] : a.requested) {
    const auto it = a.measured.find(key);
    if (it == a.measured.end()) continue;
    const bool angle = key.find("angle") != std::string::npos;
    const double unit = angle ? units::deg : mm, limit = angle ? 2 * units::deg : 2 * mm;
    if (!(std::abs(it->second - wanted) <= limit))
      findings.push_back(fmt::format("warning: {}: {:.1f} {} on the mesh, {:.1f} requested; within 2 is good", key,
                                     it->second / unit, angle ? "deg" : "mm", wanted / unit));
  }
}

void elements(const anatomy::Body& body, Findings& findings) {
  if (body.mesh.tets.empty()) {
    findings.push_back(fmt::format("error: {}: has no elements", body.name));
    return;
  }
  std::size_t inverted = 0, first = 0, worst = 0;
  double least = 180;
  for (std::size_t e = 0; e < body.mesh.tets.size(); ++e) {
    if (!(mesh::volume(body.mesh, e) > 0)) {
      if (inverted++ == 0) first = e;
      continue;
    }
    const double angle = mesh::quality(body.mesh, e).min_dihedral_deg;
    if (angle < least) least = angle, worst = e;
  }
  if (inverted > 0)
    findings.push_back(fmt::format("error: {}: {} of {} elements have no positive volume, the first is {}", body.name,
                                   inverted, body.mesh.tets.size(), first));
  if (least < 5)
    findings.push_back(fmt::format(
        "warning: {}: element {} has a dihedral angle of {:.2f} deg; below 5 deg it slows and stiffens the run",
        body.name, worst, least));
}

const mesh::Triangles* find(const anatomy::Body& body, const char* name) {
  for (const mesh::NamedSurface& s : body.surfaces)
    if (s.name == name) return &s.triangles;
  return nullptr;
}

/// Bodies must start apart, and near enough for contact to find them.
void gap(const Scenario& s, const anatomy::Body& a, const char* surface_a, const anatomy::Body& b,
         const char* surface_b, Findings& findings) {
  const mesh::Triangles *ta = find(a, surface_a), *tb = find(b, surface_b);
  if (ta == nullptr || tb == nullptr) {
    const bool first = ta == nullptr;
    findings.push_back(
        fmt::format("error: {}: has no surface \"{}\"", first ? a.name : b.name, first ? surface_a : surface_b));
    return;
  }
  const double least = mesh::least_gap(a.mesh.nodes, *ta, b.mesh.nodes, *tb);
  const std::string where = fmt::format("{}.{} to {}.{}", a.name, surface_a, b.name, surface_b);
  if (least < 1e-5)
    findings.push_back(fmt::format(
        "error: {}: the least gap is {:.3f} mm; at least 0.01 mm; raise uterus.gap or abdomen.gap, or mesh finer",
        where, least / mm));
  else if (least > s.contact.search)
    findings.push_back(fmt::format(
        "warning: {}: the least gap is {:.2f} mm, over contact.search {:.2f} mm; they do not touch at the start", where,
        least / mm, s.contact.search / mm));
}

}  // namespace

std::vector<std::string> preflight(const Scenario& s, const anatomy::Anatomy& a) {
  Findings findings;
  head_against_passage(s, findings);
  bend(s, findings);
  measured(a, findings);
  for (const anatomy::Body* body : {&a.fetus, &a.uterus, &a.abdomen}) elements(*body, findings);
  gap(s, a.fetus, "skin", a.uterus, "inner", findings);
  gap(s, a.uterus, "outer", a.abdomen, "cavity", findings);
  for (const std::string& warning : a.warnings) findings.push_back("warning: anatomy: " + warning);
  return findings;
}

}  // namespace carus::scenario
