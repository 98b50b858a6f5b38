// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <utility>
#include <vector>

#include "carus/scenario/scenario.hpp"

namespace carus::scenario {

/// The one place where the schema's paths meet the members of Scenario. A visitor either fills the members from
/// settings or collects settings from them; it has operator()(path, member) for values, choice(path, member, names) for
/// enumerations and list(path, vector, item(path, element)) for arrays.
template <class Visitor>
void bind_anatomy(Visitor& v, anatomy::Parameters& a) {
  auto& bones = a.bones_from;
  v("pelvis.from", bones.file);
  v("pelvis.labels.innominate_right", bones.right), v("pelvis.labels.innominate_left", bones.left);
  v("pelvis.labels.sacrum", bones.sacrum), v("pelvis.labels.coccyx", bones.coccyx);
  auto& surfaces = bones.surfaces;
  v("pelvis.surfaces.innominate_right", surfaces.right), v("pelvis.surfaces.innominate_left", surfaces.left);
  v("pelvis.surfaces.sacrum", surfaces.sacrum), v("pelvis.surfaces.coccyx", surfaces.coccyx);
  v("pelvis.surfaces.unit", surfaces.unit), v("pelvis.surfaces.frame", surfaces.frame);
  v.list("pelvis.landmarks", bones.landmarks, [&](const std::string& item, anatomy::GivenLandmark& l) {
    v(item + ".name", l.name);
    v(item + ".right", l.right), v(item + ".anterior", l.anterior), v(item + ".superior", l.superior);
  });
  v("pelvis.fit_canal", bones.fit_canal);
  auto& p = a.pelvis;
  v("pelvis.obstetric_conjugate", p.obstetric_conjugate), v("pelvis.transverse_inlet", p.transverse_inlet);
  v("pelvis.interspinous", p.interspinous), v("pelvis.intertuberous", p.intertuberous);
  v("pelvis.sagittal_outlet", p.sagittal_outlet), v("pelvis.pubic_arch_angle", p.pubic_arch_angle);
  v("pelvis.sacral_height", p.sacral_height), v("pelvis.sacral_depth", p.sacral_depth);
  v("pelvis.sacrococcygeal_angle", p.sacrococcygeal_angle), v("pelvis.symphysis_height", p.symphysis_height);
  v("pelvis.bone_thickness", p.bone_thickness), v("pelvis.spines_depth", p.spines_depth);
  auto& c = a.canal;
  v("canal.radius", c.radius), v("canal.bend_radius", c.bend_radius);
  v("canal.bend_start", c.bend_start), v("canal.bend_angle", c.bend_angle);
  v("canal.vulva_radius", c.vulva_radius), v("canal.taper_start", c.taper_start), v("canal.floor_top", c.floor_top);
  v("canal.taper_forward", c.taper_forward);
  auto& u = a.uterus;
  v("uterus.wall_fundus", u.wall_fundus), v("uterus.wall_body", u.wall_body);
  v("uterus.wall_lower_segment", u.wall_lower_segment), v("uterus.wall_canal", u.wall_canal), v("uterus.gap", u.gap);
  auto& b = a.abdomen;
  v("abdomen.wall", b.wall), v("abdomen.gap", b.gap), v("abdomen.levator_thickness", b.levator_thickness);
  v("abdomen.perineal_body_thickness", b.perineal_body_thickness);
  auto& f = a.fetus;
  v("fetus.biparietal", f.biparietal), v("fetus.occipitofrontal", f.occipitofrontal);
  v("fetus.suboccipitobregmatic", f.suboccipitobregmatic), v("fetus.shoulder_width", f.shoulder_width);
  v("fetus.length", f.length), v("fetus.skin_thickness", f.skin_thickness), v("fetus.flexion", f.flexion);
  v("fetus.head_start", f.head_start), v("fetus.asynclitism", f.asynclitism);
  using P = anatomy::Position;
  v.choice("fetus.position", f.position,
           {{"OA", P::OA},
            {"LOA", P::LOA},
            {"LOT", P::LOT},
            {"LOP", P::LOP},
            {"OP", P::OP},
            {"ROP", P::ROP},
            {"ROT", P::ROT},
            {"ROA", P::ROA}});
}

template <class Visitor>
void bind_material(Visitor& v, const std::string& path, material::Material& m) {
  using L = material::Law;
  v.choice(path + ".law", m.law,
           {{"neo_hooke", L::neo_hooke},
            {"mooney_rivlin", L::mooney_rivlin},
            {"hooke_corotated", L::hooke_corotated},
            {"hooke_small_strain", L::hooke_small_strain}});
  v(path + ".c10", m.c10), v(path + ".c01", m.c01), v(path + ".youngs_modulus", m.youngs_modulus);
  v(path + ".poisson", m.poisson), v(path + ".density", m.density);
  v(path + ".fibre.k1", m.fibre_k1), v(path + ".fibre.k2", m.fibre_k2);
  v.list(path + ".prony", m.prony, [&](const std::string& item, material::PronyTerm& term) {
    v(item + ".g", term.g), v(item + ".tau", term.tau);
  });
  v(path + ".average_nodal_pressure", m.average_nodal_pressure);
}

template <class Visitor>
void bind_loads(Visitor& v, Loads& loads) {
  auto& c = loads.contractions;
  v("loads.contractions.base", c.base), v("loads.contractions.amplitude", c.amplitude);
  v("loads.contractions.duration", c.duration), v("loads.contractions.rise", c.rise),
      v("loads.contractions.fall", c.fall);
  v("loads.contractions.period", c.period), v("loads.contractions.first", c.first);
  v("loads.contractions.region", loads.contractions_region);
  auto& p = loads.push;
  v("loads.push.enabled", p.enabled), v("loads.push.amplitude", p.amplitude), v("loads.push.directed", p.directed);
  v("loads.push.efforts", p.efforts), v("loads.push.effort_duration", p.effort_duration),
      v("loads.push.region", loads.push_region);
  auto& t = loads.residual_tone;
  v("loads.residual_tone.enabled", t.enabled), v("loads.residual_tone.pressure", t.pressure);
  v("loads.residual_tone.region", loads.residual_tone_region);
}

template <class Visitor>
void bind_numerics(Visitor& v, Scenario& s) {
  v.choice("solver.kind", s.solver,
           {{"explicit", SolverKind::explicit_dynamics}, {"implicit", SolverKind::implicit_dynamics}});
  auto& i = s.implicit;
  v("solver.implicit.time_step", i.time_step), v("solver.implicit.least_time_step", i.least_time_step);
  v("solver.implicit.step_tolerance", i.step_tolerance), v("solver.implicit.newton_tolerance", i.newton_tolerance);
  v("solver.implicit.max_iterations", i.max_iterations), v("solver.implicit.linear_tolerance", i.linear_tolerance);
  v("solver.implicit.barrier_distance", i.barrier_distance), v("solver.implicit.barrier_pressure", i.barrier_pressure);
  v("solver.implicit.friction_speed", i.friction_speed);
  auto& n = s.numerics;
  v("numerics.labour_duration", n.labour_duration), v("numerics.pseudo_duration", n.pseudo_duration);
  v("numerics.pseudo_time_factor", n.pseudo_time_factor), v("numerics.time_step", n.time_step),
      v("numerics.safety", n.safety);
  v("numerics.pace.kinetic_ratio", n.pace_kinetic_ratio), v("numerics.pace.slowest", n.pace_slowest);
  v("numerics.pace.fastest", n.pace_fastest);
  v("numerics.drag", n.drag), v("numerics.drag_factor", n.drag_factor), v("numerics.max_node_speed", n.max_node_speed);
  v("numerics.threads", n.threads);
  v("output.frames", s.output.frames), v("output.curve_interval", s.output.curve_interval);
  v("output.run_after_birth", s.output.run_after_birth);
}

template <class Visitor>
void bind_resolution(Visitor& v, Scenario& s) {
  v.choice("resolution", s.resolution,
           {{"coarse", Resolution::coarse}, {"paper", Resolution::paper}, {"fine", Resolution::fine}});
  v("numerics.mesh_factor", s.numerics.mesh_factor);
}

template <class Visitor>
void bind(Visitor& v, Scenario& s) {
  v("name", s.name), v("description", s.description);
  bind_resolution(v, s);
  v.list("calibrated", s.calibrated,
         [&](const std::string& item, Calibration& c) { v(item + ".key", c.key), v(item + ".to", c.to); });
  v("anatomy.from", s.anatomy_from);
  bind_anatomy(v, s.anatomy);
  for (const char* region : {"skull", "fetal_body", "neck", "fetal_skin", "uterine_fundus", "uterine_body",
                             "lower_segment", "vaginal_canal", "abdomen", "levator_ani", "perineal_body", "bone"})
    bind_material(v, std::string("materials.") + region, s.materials[region]);
  bind_loads(v, s.loads);
  auto& r = s.retraction;
  v("uterus.retraction.enabled", r.enabled);
  v.choice("uterus.retraction.kind", r.kind,
           {{"ratchet", fem::Retraction::Kind::ratchet}, {"imposed", fem::Retraction::Kind::imposed}});
  v("uterus.retraction.tau", r.tau), v("uterus.retraction.isometric_strain", r.isometric_strain),
      v("uterus.retraction.floor", r.floor), v("uterus.retraction.ring_width", r.ring_width);
  v("uterus.retraction.final", r.final), v("uterus.retraction.lower_segment_strength", r.lower_segment_strength);
  v("contact.friction", s.contact.friction), v("contact.search", s.contact.search);
  v("contact.correction_speed", s.contact.correction_speed), v("contact.sweeps", s.contact.sweeps);
  v.choice("coccyx.model", s.coccyx.model,
           {{"hinge", CoccyxModel::hinge}, {"elastic", CoccyxModel::elastic}, {"fixed", CoccyxModel::fixed}});
  v("coccyx.stiffness", s.coccyx.stiffness), v("coccyx.damping", s.coccyx.damping);
  v("attachments.lower_uterus_tie.axial", s.attachments.tie_axial),
      v("attachments.lower_uterus_tie.transverse", s.attachments.tie_transverse);
  v("attachments.canal_bed.posterior", s.attachments.bed_posterior),
      v("attachments.canal_bed.lateral", s.attachments.bed_lateral),
      v("attachments.canal_bed.depth", s.attachments.bed_depth);
  v("attachments.canal_blocked", s.attachments.canal_blocked);
  bind_numerics(v, s);
}

}  // namespace carus::scenario
