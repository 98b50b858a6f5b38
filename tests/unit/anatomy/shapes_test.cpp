// SPDX-License-Identifier: Apache-2.0
#include "carus/anatomy/shapes.hpp"

#include <gtest/gtest.h>

#include <Eigen/Geometry>

#include "carus/anatomy/abdomen.hpp"
#include "carus/anatomy/canal_axis.hpp"
#include "carus/anatomy/sizes.hpp"
#include "carus/core/error.hpp"

namespace carus::anatomy {
namespace {

TEST(CanalAxis, NearestUndoesPointAndTangentIsItsSlope) {
  const CanalAxis axis{CanalParameters{}};
  for (double s = -0.2; s < axis.vulva() + 0.05; s += 0.0071) {
    EXPECT_NEAR(axis.nearest(axis.point(s)), s, 1e-12);
    constexpr double e = 1e-6;  // central difference: error e^2 / R^2 away from the ends of the arc, e / R across them
    EXPECT_NEAR(((axis.point(s + e) - axis.point(s - e)) / (2 * e) - axis.tangent(s)).norm(), 0, 1e-5);
  }
}

TEST(CanalAxis, CoordinatesRebuildThePoint) {
  const CanalAxis axis{CanalParameters{}};
  for (const Vec3& x : {Vec3(0.02, 0.01, 0.1), Vec3(-0.03, 0.02, -0.08), Vec3(0.01, 0.05, -0.13)}) {
    const auto c = canal_coordinates(axis, x);
    const Vec3 t = axis.tangent(c.s), front(0, -t.z(), t.y());
    EXPECT_NEAR((axis.point(c.s) + c.lateral * Vec3::UnitX() + c.front * front - x).norm(), 0, 1e-12);
  }
}

TEST(Fetus, EveryPositionTurnsTheOcciput) {
  FetusParameters p;
  p.position = Position::LOT;
  EXPECT_LT(Fetus(p).landmarks().at("occiput").x(), -0.02);  // the mother's left
  p.position = Position::OA;
  EXPECT_GT(Fetus(p).landmarks().at("occiput").y(), 0.02);
  p.position = Position::ROP;
  const Vec3 o = Fetus(p).landmarks().at("occiput");
  EXPECT_GT(o.x(), 0.01);
  EXPECT_LT(o.y(), -0.01);
}

TEST(Fetus, FlexionBringsTheOcciputToLead) {
  FetusParameters p;
  p.flexion = pi / 2;
  const auto l = Fetus(p).landmarks();
  EXPECT_NEAR(l.at("occiput").z(), l.at("vertex").z(), 1e-12);
}

TEST(Fetus, TooShortIsRefused) {
  FetusParameters p;
  p.length = 0.2;
  EXPECT_THROW(Fetus{p}, InputError);
}

TEST(Pelvis, SagittalLengthsMeet) {
  const Parameters p;
  const auto l = Pelvis(p.pelvis, p.canal).landmarks();
  EXPECT_NEAR((l.at("promontory") - l.at("sacrum_tip")).norm(), p.pelvis.sacral_height, 1e-12);
  EXPECT_NEAR((l.at("symphysis_bottom") - l.at("coccyx_tip")).norm(), p.pelvis.sagittal_outlet, 1e-12);
  const Vec3 up = l.at("promontory") - l.at("sacrum_tip"), on = l.at("coccyx_tip") - l.at("sacrum_tip");
  EXPECT_NEAR(std::acos(up.dot(on) / up.norm() / on.norm()), p.pelvis.sacrococcygeal_angle, 1e-9);
}

TEST(Pelvis, LengthsThatCannotMeetAreRefused) {
  Parameters p;
  p.pelvis.sagittal_outlet = 0.30;
  EXPECT_THROW(Pelvis(p.pelvis, p.canal), InputError);
}

TEST(Uterus, WallHasItsThicknessAndLabels) {
  const Parameters p;
  const Fetus fetus(p.fetus);
  const Uterus uterus(p, fetus);
  // Along a ray to the side at mid-body, the wall is as thick as asked for within the sampling of its distance (0.1
  // mm).
  double in = 0, out = 0;
  for (double r = 0; r < 0.1; r += 1e-5) {
    const auto label = uterus.label({r, 0, 0.18});
    if (label == uterine_body && in == 0) in = r;
    if (label == uterine_body) out = r;
  }
  EXPECT_NEAR(out - in, p.uterus.wall_body, 1e-4);
  const CanalAxis& axis = uterus.axis();
  EXPECT_EQ(uterus.label(axis.centre(axis.vulva() - 0.001) + Vec3(p.canal.vulva_radius + 0.002, 0, 0)), vaginal_canal);
  EXPECT_EQ(uterus.label(axis.centre(axis.vulva() + 0.001) + Vec3(p.canal.vulva_radius + 0.002, 0, 0)), outside);
}

TEST(CanalAxis, NarrowsForwardDownToTheVulva) {
  CanalParameters p;
  p.taper_forward = 1;
  const CanalAxis axis(p);
  EXPECT_EQ(axis.radius(0), p.radius);
  EXPECT_EQ(axis.radius(p.taper_start), p.radius);
  EXPECT_NEAR(axis.radius(axis.vulva()), p.vulva_radius, 1e-12);
  for (double s = 0; s < axis.vulva(); s += 0.005) {
    // From behind only: the front wall stays where it was, in the axis' cross-section.
    const Vec3 t = axis.tangent(s), front(0, -t.z(), t.y()), off = axis.centre(s) - axis.point(s);
    EXPECT_NEAR(off.dot(front) + axis.radius(s), p.radius, 1e-12);
    EXPECT_NEAR(off.dot(t), 0, 1e-12);
  }
}

TEST(Bodies, DoNotOverlap) {
  const Parameters p;
  const Fetus fetus(p.fetus);
  const Uterus uterus(p, fetus);
  const Pelvis pelvis(p.pelvis, p.canal);
  const Abdomen abdomen(p, uterus, pelvis);
  for (double x = -0.15; x < 0.15; x += 0.0043)
    for (double y = -0.12; y < 0.12; y += 0.0047)
      for (double z = -0.15; z < 0.34; z += 0.0053) {
        const Vec3 q(x, y, z);
        const int bodies = (fetus.label(q) != 0) + (uterus.label(q) != 0) + (abdomen.label(q) != 0);
        ASSERT_LE(bodies, 1) << q.transpose();
      }
}

TEST(MeshSize, UnknownResolutionIsRefused) { EXPECT_THROW(mesh_size("huge"), InputError); }

}  // namespace
}  // namespace carus::anatomy
