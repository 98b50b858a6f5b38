// SPDX-License-Identifier: Apache-2.0
#include "carus/scenario/assemble.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <map>
#include <set>

#include "carus/core/error.hpp"
#include "carus/core/units.hpp"

namespace carus::scenario {
namespace {

using anatomy::Label;
using Cell = Eigen::Vector3i;

/// Cubic cells of edge h from `origin`, each of six tets, where `label` is not outside.
mesh::TetMesh cells(const Vec3& origin, double h, const Cell& n,
                    const std::function<std::int32_t(const Cell&)>& label) {
  mesh::TetMesh m;
  std::map<std::array<int, 3>, std::int32_t> known;
  const auto node = [&](const Cell& at) {
    const auto [it, is_new] = known.try_emplace({at.x(), at.y(), at.z()}, static_cast<std::int32_t>(m.nodes.size()));
    if (is_new) m.nodes.push_back(origin + h * at.cast<double>());
    return it->second;
  };
  std::array<int, 3> order{0, 1, 2};
  for (int k = 0; k < n.z(); ++k)
    for (int j = 0; j < n.y(); ++j)
      for (int i = 0; i < n.x(); ++i) {
        const Cell at(i, j, k);
        const std::int32_t l = label(at);
        if (l == Label::outside) continue;
        std::sort(order.begin(), order.end());
        do {  // Kuhn: one tet per way from corner to corner
          Cell walk = at;
          mesh::Tet tet{node(walk)};
          for (int s = 0; s < 3; ++s) {
            walk[order[s]] += 1;
            tet[s + 1] = node(walk);
          }
          m.tets.push_back(tet);
          m.labels.push_back(l);
          if (mesh::volume(m, m.tets.size() - 1) < 0) std::swap(m.tets.back()[0], m.tets.back()[1]);
        } while (std::next_permutation(order.begin(), order.end()));
      }
  return m;
}

mesh::Triangles where(const mesh::TetMesh& m, const mesh::Triangles& triangles,
                      const std::function<bool(const Vec3&)>& keep) {
  mesh::Triangles out;
  for (const auto& t : triangles)
    if (keep((m.nodes[t[0]] + m.nodes[t[1]] + m.nodes[t[2]]) / 3)) out.push_back(t);
  return out;
}
std::vector<std::int32_t> nodes_where(const mesh::TetMesh& m, const std::function<bool(const Vec3&)>& keep) {
  std::vector<std::int32_t> out;
  for (std::size_t n = 0; n < m.nodes.size(); ++n)
    if (keep(m.nodes[n])) out.push_back(static_cast<std::int32_t>(n));
  return out;
}

constexpr double h = 0.02;

/// A column in a closed box in a box with a hole: fetus, uterus, abdomen, with every name that the model needs.
anatomy::Anatomy small_anatomy() {
  anatomy::Anatomy a;
  a.fetus.name = "fetus", a.uterus.name = "uterus", a.abdomen.name = "abdomen";
  // Fetus: 1 x 1 x 10 thin cells inside the uterus' cavity of 1 x 1 x 5 cells of h.
  a.fetus.mesh = cells({-0.0095, -0.0095, -0.0495}, 0.0095, {2, 2, 10}, [](const Cell& c) {
    return c.z() < 3 ? Label::skull : c.z() < 9 ? Label::fetal_body : Label::fetal_skin;
  });
  a.fetus.surfaces = {{"skin", mesh::boundary(a.fetus.mesh)}};
  a.landmarks = {{"head_centre", {0, 0, -0.035}},
                 {"neck", {0, 0, -0.015}},
                 {"shoulder_right", {0.01, 0, 0.01}},
                 {"shoulder_left", {-0.01, 0, 0.01}},
                 {"coccyx_hinge", {0, -0.07, -0.01}}};
  const auto layer = [](const Cell& c) {
    return c.z() < 2   ? Label::vaginal_canal
           : c.z() < 3 ? Label::lower_segment
           : c.z() < 5 ? Label::uterine_body
                       : Label::uterine_fundus;
  };
  a.uterus.mesh = cells({-1.5 * h, -1.5 * h, -3.5 * h}, h, {3, 3, 7}, [&](const Cell& c) {
    return c.x() == 1 && c.y() == 1 && c.z() > 0 && c.z() < 6 ? Label::outside : layer(c);
  });
  const auto& um = a.uterus.mesh;
  const auto inside = [](const Vec3& x) {
    return x.head<2>().cwiseAbs().maxCoeff() < 0.51 * h && std::abs(x.z()) < 2.51 * h;
  };
  const mesh::Triangles wall = mesh::boundary(um);
  const mesh::Triangles outer = where(um, wall, [&](const Vec3& x) { return !inside(x); });
  a.uterus.surfaces = {{"inner", where(um, wall, inside)},
                       {"outer", outer},
                       {"contraction", outer},
                       {"tone", outer},
                       {"push", where(um, outer, [](const Vec3& x) { return x.z() > 0.06; })}};
  a.uterus.nodes = {{"vaginal_canal", nodes_where(um, [](const Vec3& x) { return x.z() < -0.03; })},
                    {"bed", nodes_where(um, [&](const Vec3& x) { return x.z() < -0.03 && !inside(x); })},
                    {"lower_uterus_tie", nodes_where(um, [](const Vec3& x) { return std::abs(x.z() + 0.01) < 1e-9; })}};
  a.uterine_wall.assign(um.tets.size(), {Vec3::UnitZ(), Vec3::UnitX(), 0.01, 0.0});

  // Abdomen: a box round the uterus with one layer of tissue; behind it sacrum over coccyx, innominates at the sides.
  a.abdomen.mesh = cells({-3.75 * h, -3.75 * h, -3.5 * h}, 1.5 * h, {5, 5, 4}, [](const Cell& c) {
    if (c.x() > 0 && c.x() < 4 && c.y() > 0 && c.y() < 4) return Label::outside;
    if (c.y() == 0 && c.x() == 2) return c.z() < 2 ? Label::coccyx : Label::sacrum;
    if (c.z() == 1 && c.x() == 0) return Label::innominate_left;
    if (c.z() == 1 && c.x() == 4) return Label::innominate_right;
    return c.z() == 0 ? Label::levator_ani : Label::abdomen;
  });
  const auto& am = a.abdomen.mesh;
  a.abdomen.surfaces = {{"cavity", where(am, mesh::boundary(am),
                                         [](const Vec3& x) { return x.head<2>().cwiseAbs().maxCoeff() < 2.26 * h; })}};
  a.abdomen.nodes = {{"back", nodes_where(am, [](const Vec3& x) { return x.y() < -0.07 && x.z() > 0.04; })},
                     {"thighs", nodes_where(am, [](const Vec3& x) { return std::abs(x.x()) > 0.07 && x.y() > 0.07; })},
                     {"canal", nodes_where(am, [](const Vec3& x) {
                        return x.y() > 0.04 && std::abs(x.x()) < 0.04 && x.z() < -0.03;
                      })}};
  return a;
}

Scenario scenario(const std::vector<std::string>& overrides = {}) { return parse("", "s.yaml", overrides); }

const fem::Region* region(const fem::Model& m, const std::string& name) {
  for (const fem::Region& r : m.regions)
    if (r.name == name) return &r;
  return nullptr;
}
const fem::Region& region_of(const fem::Model& m, std::size_t tet) { return m.regions[m.mesh.labels[tet]]; }
std::set<std::int32_t> nodes_of_region(const fem::Model& m, const std::string& name) {
  std::set<std::int32_t> out;
  for (std::size_t e = 0; e < m.mesh.tets.size(); ++e)
    if (region_of(m, e).name == name) out.insert(m.mesh.tets[e].begin(), m.mesh.tets[e].end());
  return out;
}

TEST(Assemble, BodiesFollowOneAnotherAndKeepTheirShape) {
  const anatomy::Anatomy a = small_anatomy();
  const Assembly out = assemble(scenario(), a);
  const fem::Model& m = out.model;
  ASSERT_EQ(m.mesh.nodes.size(), a.fetus.mesh.nodes.size() + a.uterus.mesh.nodes.size() + a.abdomen.mesh.nodes.size());
  ASSERT_EQ(m.mesh.tets.size(), m.mesh.labels.size());
  ASSERT_EQ(m.blocked.size(), m.mesh.nodes.size());
  for (const anatomy::Body* body : {&a.fetus, &a.uterus, &a.abdomen}) {
    const BodyRange& r = out.bodies.at(body->name);
    ASSERT_EQ(r.tet_end - r.tet_begin, static_cast<std::int32_t>(body->mesh.tets.size()));
    for (std::size_t e = 0; e < body->mesh.tets.size(); ++e) {
      EXPECT_EQ(mesh::volume(m.mesh, r.tet_begin + e), mesh::volume(body->mesh, e));
      EXPECT_EQ(region_of(m, r.tet_begin + e).organ, body->name);
      for (const std::int32_t n : m.mesh.tets[r.tet_begin + e]) EXPECT_TRUE(n >= r.node_begin && n < r.node_end);
    }
    for (const mesh::NamedSurface& s : body->surfaces)
      for (const auto& t : out.surfaces.at(body->name + "." + s.name))
        for (const std::int32_t n : t) EXPECT_TRUE(n >= r.node_begin && n < r.node_end);
  }
  const std::int32_t neck = out.nodes.at("fetus.neck");
  EXPECT_LT((m.mesh.nodes[neck] - a.landmarks.at("neck")).norm(), 0.01);
}

TEST(Assemble, RegionsHaveTheirMaterials) {
  const Assembly out =
      assemble(scenario({"materials.neck.c10=10 kPa", "materials.levator_ani.c10=7 kPa"}), small_anatomy());
  EXPECT_DOUBLE_EQ(region(out.model, "skull")->material.c10, 75e3);
  EXPECT_DOUBLE_EQ(region(out.model, "fetal_body")->material.c10, 70e3);
  EXPECT_DOUBLE_EQ(region(out.model, "neck")->material.c10, 10e3);
  EXPECT_DOUBLE_EQ(region(out.model, "levator_ani")->material.c10, 7e3);
  EXPECT_DOUBLE_EQ(region(out.model, "sacrum")->material.youngs_modulus, 23e6);
  EXPECT_TRUE(region(out.model, "innominate_left")->rigid && region(out.model, "sacrum")->rigid &&
              region(out.model, "coccyx")->rigid);
  EXPECT_FALSE(region(out.model, "abdomen")->rigid || region(out.model, "skull")->rigid);
  // The neck is body within half the way to the shoulders (12.5 mm) of the head's upper end, and never skull.
  for (std::size_t e = 0; e < out.model.mesh.tets.size(); ++e) {
    if (region_of(out.model, e).name != "neck") continue;
    for (const std::int32_t n : out.model.mesh.tets[e])
      EXPECT_NEAR(out.model.mesh.nodes[n].z(), -0.015, 0.0125 + 0.0095);
  }
}

TEST(Assemble, BonesAndAttachmentsAreBlocked) {
  const Assembly out = assemble(scenario(), small_anatomy());
  const fem::Model& m = out.model;
  for (const char* bone : {"sacrum", "innominate_left", "innominate_right"})
    for (const std::int32_t n : nodes_of_region(m, bone)) EXPECT_EQ(m.blocked[n], fem::Blocked::all) << bone;
  for (const char* set : {"abdomen.back", "abdomen.thighs"})
    for (const std::int32_t n : out.node_sets.at(set)) EXPECT_EQ(m.blocked[n], fem::Blocked::all) << set;
  // The canal across its axis: straight down above the bend, turned with the axis below.
  const anatomy::CanalAxis axis(small_anatomy().parameters.canal);
  ASSERT_EQ(m.blocked_direction.size(), m.mesh.nodes.size());
  for (const char* set : {"uterus.vaginal_canal", "abdomen.canal"})
    for (const std::int32_t n : out.node_sets.at(set)) {
      const Vec3 across =
          axis.inside_bend(m.mesh.nodes[n]) ? Vec3::Zero() : axis.tangent(axis.nearest(m.mesh.nodes[n]));
      EXPECT_EQ(m.blocked_direction[n], across) << set;
      if (m.mesh.nodes[n].z() > -0.045) {
        EXPECT_EQ(m.blocked_direction[n], -Vec3::UnitZ()) << set;
      }
    }
  const BodyRange& fetus = out.bodies.at("fetus");
  for (std::int32_t n = fetus.node_begin; n < fetus.node_end; ++n) {  // nothing imposed on the fetus
    EXPECT_EQ(m.blocked[n], fem::Blocked::none);
    EXPECT_EQ(m.blocked_direction[n], Vec3::Zero());
  }

  const Assembly open = assemble(scenario({"attachments.canal_blocked=false"}), small_anatomy());
  EXPECT_TRUE(open.model.blocked_direction.empty());
}

TEST(Assemble, CoccyxHingesBendsOrIsFixed) {
  const anatomy::Anatomy a = small_anatomy();
  const Assembly hinged = assemble(scenario({"coccyx.stiffness=33 N m/rad", "coccyx.damping=5 N m s/rad"}), a);
  ASSERT_EQ(hinged.model.hinges.size(), 1u);
  const fem::Hinge& hinge = hinged.model.hinges[0];
  const auto sacrum = nodes_of_region(hinged.model, "sacrum"), coccyx = nodes_of_region(hinged.model, "coccyx");
  EXPECT_FALSE(hinge.nodes.empty());
  EXPECT_LT(hinge.nodes.size(), coccyx.size());
  for (const std::int32_t n : hinge.nodes) {
    EXPECT_TRUE(coccyx.contains(n) && !sacrum.contains(n));
    EXPECT_EQ(hinged.model.blocked[n], fem::Blocked::none);
  }
  EXPECT_EQ(hinge.axis, Vec3::UnitX());
  EXPECT_EQ(hinge.point, a.landmarks.at("coccyx_hinge"));
  EXPECT_EQ(hinge.stiffness, 33);
  EXPECT_EQ(hinge.damping, 5);
  // Lumping at the nodes of a regular grid adds h^2/6 per direction to the solid's inertia: a box b x b x 2b about the
  // hinge.
  const double b = 1.5 * h, mass = 1000 * 2 * b * b * b;
  const Vec3 centre(0, -3.25 * h + 0.25 * b, -3.5 * h + b);
  const double solid = mass * ((b * b + 4 * b * b) / 12 + (centre - hinge.point).tail<2>().squaredNorm());
  EXPECT_GT(hinge.inertia, solid);
  EXPECT_LT(hinge.inertia, solid + mass * 2 * b * b / 3);

  const Assembly elastic = assemble(scenario({"coccyx.model=elastic"}), a);
  EXPECT_TRUE(elastic.model.hinges.empty());
  EXPECT_FALSE(region(elastic.model, "coccyx")->rigid);
  EXPECT_EQ(region(elastic.model, "coccyx")->material.law, material::Law::hooke_corotated);
  for (const std::int32_t n : nodes_of_region(elastic.model, "coccyx"))
    if (sacrum.contains(n))
      EXPECT_EQ(elastic.model.blocked[n], fem::Blocked::all);
    else
      EXPECT_NE(elastic.model.blocked[n] & fem::Blocked::x, fem::Blocked::x);

  const Assembly fixed = assemble(scenario({"coccyx.model=fixed"}), a);
  EXPECT_TRUE(region(fixed.model, "coccyx")->rigid && fixed.model.hinges.empty());
  for (const std::int32_t n : nodes_of_region(fixed.model, "coccyx"))
    EXPECT_EQ(fixed.model.blocked[n], fem::Blocked::all);
}

TEST(Assemble, TiesShareOutTheTotalStiffness) {
  const Assembly out =
      assemble(scenario({"attachments.lower_uterus_tie.axial=12 kN/m", "attachments.lower_uterus_tie.transverse=3 N/mm",
                         "attachments.canal_bed.posterior=0 Pa/m", "attachments.canal_bed.lateral=0 Pa/m"}),
               small_anatomy());
  Vec3 sum = Vec3::Zero();
  for (const fem::Tether& t : out.model.tethers) {
    EXPECT_GT(t.stiffness, 0);
    sum += t.stiffness * t.direction;
  }
  EXPECT_EQ(out.model.tethers.size(), 3 * out.node_sets.at("uterus.lower_uterus_tie").size());
  EXPECT_NEAR(sum.x(), 3000, 1e-9);
  EXPECT_NEAR(sum.y(), 3000, 1e-9);
  EXPECT_NEAR(sum.z(), 12000, 1e-9);
}

TEST(Assemble, LoadsActOnTheirSurfacesByTheTimetable) {
  const Assembly out = assemble(scenario(), small_anatomy());
  ASSERT_EQ(out.model.pressures.size(), 3u);
  const auto &contraction = out.model.pressures[0], &push = out.model.pressures[1], &tone = out.model.pressures[2];
  EXPECT_EQ(contraction.name, "contraction");
  EXPECT_EQ(push.name, "push");
  EXPECT_EQ(tone.name, "tone");
  EXPECT_EQ(push.surface, out.surfaces.at("uterus.push"));
  EXPECT_TRUE(push.directed && !contraction.directed && !tone.directed);
  EXPECT_EQ(push.direction, -Vec3::UnitZ());
  const double plateau = 30 + 45;  // first at 30 s, plateau from 30 to 60 s of it
  EXPECT_NEAR(contraction.pressure(plateau), 60 * units::mmHg, 1e-6);
  EXPECT_NEAR(contraction.pressure(200), 10 * units::mmHg, 1e-6);
  EXPECT_NEAR(push.pressure(plateau), 200 * units::mmHg, 1e-6);
  EXPECT_NEAR(push.pressure(200), 0, 1e-6);
  EXPECT_EQ(tone.pressure(0), 9500);
  // Outward orientation: a pressure on a closed surface pushes inward everywhere, so the enclosed volume is positive.
  double volume = 0;
  for (const auto& t : contraction.surface) {
    const auto& x = out.model.mesh.nodes;
    volume += x[t[0]].dot(x[t[1]].cross(x[t[2]])) / 6;
  }
  EXPECT_NEAR(volume, 3 * 3 * 7 * h * h * h, 1e-12);

  const Assembly off = assemble(
      scenario({"loads.push.enabled=false", "loads.residual_tone.enabled=false", "loads.push.region=contraction"}),
      small_anatomy());
  EXPECT_EQ(off.model.pressures[1].pressure(plateau), 0);
  EXPECT_EQ(off.model.pressures[2].pressure(plateau), 0);
  EXPECT_EQ(off.model.pressures[1].surface, off.surfaces.at("uterus.contraction"));
}

TEST(Assemble, ContactPairsAreThePapersAndTheFold) {
  const Assembly out = assemble(scenario({"contact.friction=0.05"}), small_anatomy());
  const auto& surfaces = out.model.contact_surfaces;
  std::set<std::string> pairs;
  for (const fem::ContactPair& p : out.model.contact_pairs) {
    pairs.insert(surfaces.at(p.a).name + "-" + surfaces.at(p.b).name);
    EXPECT_EQ(p.friction, 0.05);
  }
  EXPECT_EQ(pairs, (std::set<std::string>{"skin-uterus", "uterus-abdomen", "wall-wall", "skin-abdomen"}));
  // No facet of the abdomen is there twice.
  std::set<mesh::Triangle> seen;
  for (const auto& s : surfaces)
    if (s.name == "abdomen")
      for (mesh::Triangle t : s.triangles) {
        std::sort(t.begin(), t.end());
        EXPECT_TRUE(seen.insert(t).second);
      }
  EXPECT_FALSE(seen.empty());
}

TEST(Assemble, RetractionActsByRegion) {
  const anatomy::Anatomy a = small_anatomy();
  const Assembly out =
      assemble(scenario({"uterus.retraction.lower_segment_strength=0.4", "uterus.retraction.final=0.3"}), a);
  const fem::Retraction& r = out.model.retraction;
  EXPECT_EQ(r.kind, fem::Retraction::Kind::ratchet);
  ASSERT_EQ(r.elements.size(), r.strength.size());
  ASSERT_EQ(r.elements.size(), r.meridian.size());
  std::map<std::string, std::size_t> count;
  for (std::size_t i = 0; i < r.elements.size(); ++i) {
    const std::string& name = region_of(out.model, r.elements[i]).name;
    ++count[name];
    EXPECT_EQ(r.strength[i], name == "lower_segment" ? 0.4 : 1.0);
  }
  EXPECT_EQ(count.size(), 3u);  // fundus, body, lower segment; not the canal
  EXPECT_EQ(r.activity(200), 0);
  EXPECT_NEAR(r.activity(75), 1, 1e-12);
  EXPECT_NEAR(r.imposed(960), 0.65, 1e-12);
  EXPECT_NEAR(r.imposed(1e5), 0.3, 1e-12);
  EXPECT_EQ(assemble(scenario({"uterus.retraction.enabled=false"}), a).model.retraction.kind,
            fem::Retraction::Kind::off);
}

TEST(Assemble, FibresRunAlongTheMeridians) {
  const Assembly none = assemble(scenario(), small_anatomy());
  EXPECT_TRUE(none.model.fibre.empty());
  const Assembly out = assemble(scenario({"materials.uterine_body.fibre.k1=10 kPa"}), small_anatomy());
  ASSERT_EQ(out.model.fibre.size(), out.model.mesh.tets.size());
  EXPECT_TRUE(region(out.model, "uterine_body")->fibres && !region(out.model, "uterine_fundus")->fibres);
  EXPECT_EQ(out.model.fibre[out.bodies.at("uterus").tet_begin], Vec3::UnitZ());
}

TEST(Assemble, EverythingMissingIsNamedAtOnce) {
  anatomy::Anatomy a = small_anatomy();
  a.uterus.surfaces.erase(a.uterus.surfaces.begin());
  a.abdomen.nodes.erase(a.abdomen.nodes.begin());
  a.landmarks.erase("coccyx_hinge");
  a.uterine_wall.clear();
  try {
    assemble(scenario(), a);
    FAIL();
  } catch (const InputError& error) {
    ASSERT_EQ(error.problems().size(), 4u) << error.what();
    EXPECT_EQ(error.problems()[0], "anatomy: uterus.inner: no such surface, or it is empty; the model needs it");
    EXPECT_EQ(error.problems()[1], "anatomy: abdomen.back: no such set of nodes, or it is empty; the model needs it");
    EXPECT_EQ(
        error.problems()[2],
        "anatomy: coccyx_hinge: no such landmark; coccyx.model hinge needs it; set coccyx.model to elastic or fixed");
    EXPECT_EQ(error.problems()[3].find("anatomy: uterine_wall: 0 frames; allowed one per element of the uterus, "), 0u);
  }
}

TEST(Assemble, WhatOnlySomeScenariosNeedIsNamed) {
  const auto message = [](const Scenario& s, const anatomy::Anatomy& a) -> std::string {
    try {
      assemble(s, a);
      return "";
    } catch (const InputError& error) {
      return error.what();
    }
  };
  anatomy::Anatomy a = small_anatomy();
  a.fetus.mesh.labels[0] = 77;
  EXPECT_EQ(message(scenario(), a), "anatomy: fetus: label 77 has no material; allowed the regions of materials");
  a = small_anatomy();
  a.uterine_wall.clear();
  const std::string passive = "uterus.retraction.enabled=false";
  EXPECT_EQ(message(scenario({passive}), a), "");
  EXPECT_EQ(message(scenario({passive, "materials.uterine_body.fibre.k1=10 kPa"}), a),
            "anatomy: uterine_wall: no frames; materials with fibres need one per element of the uterus");
}

TEST(Preflight, GoodAnatomyPassesAndBadOnesAreTold) {
  const auto any = [](const std::vector<std::string>& findings, const std::string& text) {
    return std::any_of(findings.begin(), findings.end(),
                       [&](const std::string& f) { return f.find(text) != std::string::npos; });
  };
  anatomy::Anatomy a = small_anatomy();
  const auto good = preflight(scenario(), a);
  EXPECT_FALSE(any(good, "error: ")) << good.front();

  EXPECT_TRUE(any(preflight(scenario({"pelvis.interspinous=90 mm"}), a),
                  "warning: pelvis.interspinous: 90.0 mm leaves 80.6 mm between the walls of the canal; the head is "
                  "93.5 mm wide there; it can pass only if it "
                  "moulds by 12.9 mm"));
  EXPECT_TRUE(
      any(preflight(scenario({"canal.radius=35 mm"}), a), "warning: canal.radius: 35.0 mm is stretched 1.35 times"));
  EXPECT_TRUE(
      any(preflight(scenario({"canal.bend_radius=50 mm"}), a), "error: canal.bend_radius: 50.0 mm is not above"));
  a.requested["interspinous"] = 0.1123, a.measured["interspinous"] = 0.1160;
  EXPECT_TRUE(any(preflight(scenario(), a), "warning: interspinous: 116.0 mm on the mesh, 112.3 requested"));
  for (Vec3& x : a.fetus.mesh.nodes) x.x() += 0.0005;  // half a millimetre: it now touches the wall
  EXPECT_TRUE(any(preflight(scenario(), a), "error: fetus.skin to uterus.inner: the least gap is 0.000 mm"));
  std::swap(a.uterus.mesh.tets[7][0], a.uterus.mesh.tets[7][1]);
  EXPECT_TRUE(any(preflight(scenario(), a), "error: uterus: 1 of "));
  a.fetus.mesh = {}, a.fetus.surfaces.clear();
  const auto without = preflight(scenario(), a);
  EXPECT_TRUE(any(without, "error: fetus: has no elements"));
  EXPECT_TRUE(any(without, "error: fetus: has no surface \"skin\""));

  a = small_anatomy();
  EXPECT_TRUE(any(preflight(scenario({"contact.search=0.5 mm"}), a), "mm, over contact.search 0.50 mm; they do "));
  for (Vec3& x : a.fetus.mesh.nodes) x.z() *= 0.01;  // slivers
  EXPECT_TRUE(any(preflight(scenario(), a), "warning: fetus: element "));
  a.uterus.surfaces.clear(), a.abdomen.surfaces.clear();
  const auto bare = preflight(scenario(), a);
  EXPECT_TRUE(any(bare, "error: uterus: has no surface \"inner\""));
  EXPECT_TRUE(any(bare, "error: uterus: has no surface \"outer\""));
}

}  // namespace
}  // namespace carus::scenario
