// SPDX-License-Identifier: Apache-2.0
#include "support/element_forces.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "carus/solve/energy.hpp"
#include "support/models.hpp"

namespace carus::fem {

#ifdef __x86_64__
// The instruction sets that kernel_choice.cpp chooses from.
namespace portable {
KernelReport forces(const Batch*, std::size_t, const KernelMaterial&, const Float4*, Float4*, const float*,
                    const BatchStress*);
double relax(const Batch*, std::size_t, const KernelMaterial&, const Float4*, BatchStress*);
void volumes(const Batch*, std::size_t, const Float4*, float*);
}  // namespace portable
namespace avx2 {
KernelReport forces(const Batch*, std::size_t, const KernelMaterial&, const Float4*, Float4*, const float*,
                    const BatchStress*);
double relax(const Batch*, std::size_t, const KernelMaterial&, const Float4*, BatchStress*);
void volumes(const Batch*, std::size_t, const Float4*, float*);
}  // namespace avx2
namespace avx512 {
KernelReport forces(const Batch*, std::size_t, const KernelMaterial&, const Float4*, Float4*, const float*,
                    const BatchStress*);
double relax(const Batch*, std::size_t, const KernelMaterial&, const Float4*, BatchStress*);
void volumes(const Batch*, std::size_t, const Float4*, float*);
}  // namespace avx512
#endif

namespace {

using models::element_forces;
constexpr double shear = 30e3, edge = 0.1;  // [Pa], [m]
constexpr int cells = 4;

/// A shaken block of 384 elements (24 full batches in 16 blocks leave ragged ones), with fibres if asked.
Model block(material::Law law, bool fibres = false, bool relaxing = false) {
  auto mesh = shapes::box({-0.03, 0.02, -0.05}, Vec3::Constant(edge), cells, cells, cells);
  shapes::shake(mesh, 0.25 * edge / cells);
  auto material = models::soft(law, shear, 0.45);
  if (fibres) material.fibre_k1 = shear, material.fibre_k2 = 0.8;
  if (relaxing) material.prony = {{0.3, 2.0}, {0.2, 20.0}};
  Model m = models::of(std::move(mesh), {material});
  if (fibres) m.regions[0].fibres = true, m.fibre.assign(m.mesh.tets.size(), Vec3(2, 1, -2) / 3);
  return m;
}

/// Smooth large deformation with J about 0.8..1.3, plus a rotation where the law allows one.
std::vector<Vec3> deformed(const Model& m, bool rotate) {
  Mat3 A;
  A << 1.15, 0.2, -0.1, 0.05, 0.9, 0.12, -0.08, 0.1, 1.05;
  if (rotate) A = models::skew_rotation(0.8) * A;
  std::vector<Vec3> x;
  for (const Vec3& X : m.mesh.nodes) {
    const Vec3 wave(std::sin(30 * X.y()), std::sin(25 * X.z() + 1), std::sin(35 * X.x()));
    x.push_back(A * X + 0.003 * wave);
  }
  return x;
}

double largest(const std::vector<Vec3>& f) {
  double most = 0;
  for (const Vec3& v : f) most = std::max(most, v.norm());
  return most;
}

// Float-level zero: strains are good to about 1e-6 (positions of 0.1 m in single precision over edges of 0.025 m), so a
// force is to G times a facet's area times some 1e-5, K/G = 9.7 included.
constexpr double float_zero = 3e-5 * shear * (edge / cells) * (edge / cells);

TEST(ElementForces, RestGivesNone) {
  for (const auto& law : models::laws) {
    for (const bool fibres : {false, true}) {
      const Model m = block(law.law, fibres);
      auto blocks = make_blocks(m, 16);
      const auto f = element_forces(m, blocks, m.mesh.nodes);
      EXPECT_LT(largest(f.at), float_zero) << law.name;
      EXPECT_NEAR(f.report.min_J, 1, 1e-5) << law.name;
    }
  }
}

TEST(ElementForces, RigidMotionGivesNone) {
  for (const auto& law : models::laws) {
    for (const bool fibres : {false, true}) {
      const Model m = block(law.law, fibres);
      auto blocks = make_blocks(m, 16);
      std::vector<Vec3> x;
      const Mat3 R = law.objective ? models::skew_rotation(2.1) : Mat3::Identity();
      for (const Vec3& X : m.mesh.nodes) x.push_back(R * X + Vec3(0.05, -0.02, 0.08));
      // Twice the zero of rest: the positions are rounded anew.
      EXPECT_LT(largest(element_forces(m, blocks, x).at), 2 * float_zero) << law.name;
    }
  }
}

TEST(ElementForces, SumToZeroWithTheirMoments) {
  for (const auto& law : models::laws) {
    const Model m = block(law.law);
    auto blocks = make_blocks(m, 16);
    const auto x = deformed(m, law.objective);
    const auto f = element_forces(m, blocks, x);
    Vec3 sum = Vec3::Zero(), moment = Vec3::Zero();
    for (std::size_t i = 0; i < x.size(); ++i) sum += f.at[i], moment += x[i].cross(f.at[i]);
    // 384 elements, each rounded at 6e-8 of forces of the size of the largest.
    EXPECT_LT(sum.norm(), 1e-5 * largest(f.at)) << law.name;
    if (!law.objective) continue;
    EXPECT_LT(moment.norm(), 1e-5 * largest(f.at) * edge) << law.name;
  }
}

/// -dW/dx of the double-precision energy by central differences along a random direction: the error falls as h^2 down
/// to the rounding of the single-precision forces.
TEST(ElementForces, AreMinusTheGradientOfTheEnergy) {
  for (const auto& law : models::laws) {
    for (const auto& [fibres, relaxing] : {std::pair{false, false}, {true, false}, {false, true}, {true, true}}) {
      const Model m = block(law.law, fibres, relaxing);
      auto blocks = make_blocks(m, 16);
      State state;
      state.x = deformed(m, law.objective);
      const auto energy = [&](const State& s) {
        return solve::stored_energy(m, blocks, s) - solve::relaxed_energy(m, blocks, s.x);
      };
      for (int update = 0; update < 2; ++update) {
        const double before = energy(state), rise = models::relax(m, blocks, state.x, 1);
        EXPECT_NEAR(energy(state) - before, rise, 1e-5 * before) << law.name << " fibres " << fibres;
        EXPECT_EQ(relaxing, rise < 0) << law.name << " fibres " << fibres;
      }
      std::mt19937 random(7);
      std::normal_distribution<double> normal;
      std::vector<Vec3> direction;
      for (std::size_t i = 0; i < state.x.size(); ++i)
        direction.emplace_back(normal(random), normal(random), normal(random));
      const auto f = element_forces(m, blocks, state.x);
      double slope = 0;
      for (std::size_t i = 0; i < direction.size(); ++i) slope -= f.at[i].dot(direction[i]);
      ASSERT_GT(std::abs(slope), 1);  // [N]: a zero gradient would prove nothing
      const auto error = [&](double h) {
        State up = state, down = state;
        for (std::size_t i = 0; i < direction.size(); ++i) up.x[i] += h * direction[i], down.x[i] -= h * direction[i];
        return std::abs((energy(up) - energy(down)) / (2 * h) - slope) / std::abs(slope);
      };
      // Steps of 1.6 and 0.8 % of an edge: far above single-precision noise, so the order shows. Small strain without
      // fibres is quadratic: no error to fall.
      const double coarse = error(4e-4), fine = error(2e-4);
      if (law.objective || fibres) {
        ASSERT_GT(coarse, 1e-3) << law.name;
        EXPECT_NEAR(std::log2(coarse / fine), 2, 0.1) << law.name << " fibres " << fibres;
      }
      EXPECT_LT(error(2e-6), 2e-5) << law.name << " fibres " << fibres;  // single precision of ~400 elements' forces
    }
  }
}

#ifdef __x86_64__
const Kernel plain{portable::forces, portable::relax, portable::volumes, "portable"};
struct Isa {
  Kernel kernel;
  bool here;
};
std::vector<Isa> instruction_sets() {
  const bool has_avx512 =
      __builtin_cpu_supports("avx512f") && __builtin_cpu_supports("avx512dq") && __builtin_cpu_supports("avx512vl");
  return {{{avx2::forces, avx2::relax, avx2::volumes, "avx2"},
           __builtin_cpu_supports("avx2") && __builtin_cpu_supports("fma")},
          {{avx512::forces, avx512::relax, avx512::volumes, "avx512"}, has_avx512}};
}

TEST(ElementForces, InstructionSetsAgree) {
  for (const auto& isa : instruction_sets()) {
    if (!isa.here) {
      std::printf("skipped: this processor has no %s\n", isa.kernel.name);
      continue;
    }
    for (const auto& law : models::laws) {
      for (const bool fibres : {false, true}) {
        for (const bool relaxing : {false, true}) {
          const Model m = block(law.law, fibres, relaxing);
          auto a = make_blocks(m, 16), b = a;
          const auto x = deformed(m, law.objective);
          for (int pass = 0; pass < 2; ++pass) {  // the second meets the history of the first
            const double ra = models::relax(m, a, x, 1, plain), rb = models::relax(m, b, x, 1, isa.kernel);
            EXPECT_NEAR(ra, rb, 1e-5 * std::abs(ra)) << isa.kernel.name << ' ' << law.name << ' ' << fibres;
            const auto fa = element_forces(m, a, x, plain), fb = element_forces(m, b, x, isa.kernel);
            double apart = 0;
            for (std::size_t i = 0; i < x.size(); ++i) apart = std::max(apart, (fa.at[i] - fb.at[i]).norm());
            EXPECT_LT(apart, 1e-5 * largest(fa.at)) << isa.kernel.name << ' ' << law.name << ' ' << fibres << relaxing;
            EXPECT_NEAR(fa.report.min_J, fb.report.min_J, 1e-5);
          }
        }
      }
    }
    const Model m = block(material::Law::neo_hooke);
    for (auto& b : make_blocks(m, 16)) {
      for (std::size_t l = 0; l < b.nodes.size(); ++l) {
        const Vec3 p = 1.1 * m.mesh.nodes[b.nodes[l]];
        b.x[l] = {{float(p.x()), float(p.y()), float(p.z()), 0.f}};
      }
      std::vector<float> va(b.nodes.size(), 0.f), vb = va;
      portable::volumes(b.batches.data(), b.batches.size(), b.x.data(), va.data());
      isa.kernel.volumes(b.batches.data(), b.batches.size(), b.x.data(), vb.data());
      for (std::size_t l = 0; l < va.size(); ++l) EXPECT_NEAR(va[l], vb[l], 1e-5f * va[l]) << isa.kernel.name;
    }
  }
}

TEST(ElementForces, EveryInstructionSetReportsInversionAndNaN) {
  auto sets = instruction_sets();
  sets.push_back({plain, true});
  for (const auto& isa : sets) {
    if (!isa.here) continue;
    for (const auto& law : models::laws) {
      const Model m = block(law.law);
      auto blocks = make_blocks(m, 16);
      auto x = m.mesh.nodes;
      const auto victim = m.mesh.tets[200][0];
      x[victim] += Vec3(0.06, 0.05, 0);  // across its opposite facets
      EXPECT_GT(element_forces(m, blocks, x, isa.kernel).report.inverted, 0) << isa.kernel.name << ' ' << law.name;
      x[victim] = Vec3::Constant(std::numeric_limits<double>::quiet_NaN());
      const auto report = element_forces(m, blocks, x, isa.kernel).report;
      EXPECT_GT(report.inverted, 0) << isa.kernel.name << ' ' << law.name;
      EXPECT_GE(report.worst_element, 0) << isa.kernel.name << ' ' << law.name;
    }
  }
}
#endif

TEST(Blocks, CoverEachElementOnce) {
  auto mesh = shapes::join(shapes::box({0, 0, 0}, {1, 1, 1}, 5, 3, 4, 0), shapes::ball({3, 0, 0}, 0.5, 4, 1));
  const std::size_t stressed = mesh.tets.size();
  mesh = shapes::join(mesh, shapes::box({5, 0, 0}, {1, 1, 1}, 2, 2, 2, 2));
  const auto soft = models::soft(material::Law::neo_hooke, 1, 0.3);
  Model m = models::of(mesh, {soft, soft, soft});
  m.regions[2].rigid = true;
  for (const int count : {1, 7, 16}) {
    const auto blocks = make_blocks(m, count);
    EXPECT_EQ(blocks.size(), std::size_t(count));
    std::vector<int> seen(mesh.tets.size(), 0);
    double volume = 0;
    for (const auto& b : blocks) {
      for (const auto& run : b.runs) {
        for (std::size_t q = run.begin; q < run.end; ++q) {
          for (int l = 0; l < lanes; ++l) {
            const Batch& batch = b.batches[q];
            EXPECT_EQ(mesh.labels[batch.element[l]], run.region);
            if (batch.volume[l] <= 0) continue;
            ++seen[batch.element[l]], volume += double(batch.volume[l]);
            for (int a = 0; a < 4; ++a)
              EXPECT_EQ(b.nodes[std::size_t(batch.node[a][l])], mesh.tets[batch.element[l]][a]);
          }
        }
      }
    }
    for (std::size_t e = 0; e < seen.size(); ++e)
      EXPECT_EQ(seen[e], e < stressed ? 1 : 0);  // rigid parts carry no stress
    double total = 0;
    for (std::size_t e = 0; e < stressed; ++e) total += mesh::volume(mesh, e);
    EXPECT_NEAR(volume, total, 1e-5 * total);  // single precision
  }
}

TEST(Blocks, MoreThanElements) {
  const Model m =
      models::of(shapes::box({0, 0, 0}, {1, 1, 1}, 1, 1, 1), {models::soft(material::Law::neo_hooke, 1, 0.3)});
  std::size_t elements = 0;
  for (const auto& b : make_blocks(m, 16)) {
    for (const auto& q : b.batches)
      elements += std::size_t(std::count_if(q.volume, q.volume + lanes, [](float v) { return v > 0; }));
  }
  EXPECT_EQ(elements, 6u);
}

}  // namespace
}  // namespace carus::fem
