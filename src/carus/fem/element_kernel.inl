// SPDX-License-Identifier: Apache-2.0
// The element pass for one instruction set. Included by element_kernel_{portable,avx2,avx512}.cpp inside a namespace of
// their own, so that no inline function of one instruction set can be picked by the linker for another.

#ifdef __AVX512F__
using Lanes = material::Float16;
#else
using Lanes = material::Float8;
#endif
constexpr int width = sizeof(Lanes) / sizeof(float);  // of a register; a batch is one or two of them
using Tensor = material::Mat3T<Lanes>;

struct Nodal {
  Lanes x, y, z;
};

#ifdef __AVX512F__
// Four loads of 16 bytes make a register of lanes l, l+4, l+8, l+12; a 4x4 transposition inside the 128-bit quarters
// then leaves x, y and z in natural order.
inline Nodal gather(const Float4* x, const std::int32_t* node) {
  const auto quad = [&](int l) {
    __m512 r = _mm512_castps128_ps512(_mm_load_ps(x[node[l]].v));
    r = _mm512_insertf32x4(r, _mm_load_ps(x[node[l + 4]].v), 1);
    r = _mm512_insertf32x4(r, _mm_load_ps(x[node[l + 8]].v), 2);
    return _mm512_insertf32x4(r, _mm_load_ps(x[node[l + 12]].v), 3);
  };
  const __m512 a = quad(0), b = quad(1), c = quad(2), d = quad(3);
  const __m512 ab = _mm512_unpacklo_ps(a, b), cd = _mm512_unpacklo_ps(c, d);
  const __m512 ab_z = _mm512_unpackhi_ps(a, b), cd_z = _mm512_unpackhi_ps(c, d);
  return {(Lanes)_mm512_shuffle_ps(ab, cd, 0x44), (Lanes)_mm512_shuffle_ps(ab, cd, 0xee),
          (Lanes)_mm512_shuffle_ps(ab_z, cd_z, 0x44)};
}

inline void scatter_add(Float4* f, const std::int32_t* node, const Nodal& g) {
  const __m512 x = (__m512)g.x, y = (__m512)g.y, z = (__m512)g.z, o = _mm512_setzero_ps();
  const __m512 xy = _mm512_unpacklo_ps(x, y), zo = _mm512_unpacklo_ps(z, o);
  const __m512 xy_h = _mm512_unpackhi_ps(x, y), zo_h = _mm512_unpackhi_ps(z, o);
  const __m512 r[4] = {_mm512_shuffle_ps(xy, zo, 0x44), _mm512_shuffle_ps(xy, zo, 0xee),
                       _mm512_shuffle_ps(xy_h, zo_h, 0x44), _mm512_shuffle_ps(xy_h, zo_h, 0xee)};
  const auto add = [&](int lane, __m128 v) {
    float* p = f[node[lane]].v;
    _mm_store_ps(p, _mm_add_ps(_mm_load_ps(p), v));
  };
  for (int l = 0; l < 4; ++l) {
    add(l, _mm512_castps512_ps128(r[l]));
    add(l + 4, _mm512_extractf32x4_ps(r[l], 1));
    add(l + 8, _mm512_extractf32x4_ps(r[l], 2));
    add(l + 12, _mm512_extractf32x4_ps(r[l], 3));
  }
}
#elif defined(__AVX2__)
// The same with two 128-bit halves: lanes l and l+4.
inline Nodal gather(const Float4* x, const std::int32_t* node) {
  const auto pair = [&](int l) {
    return _mm256_insertf128_ps(_mm256_castps128_ps256(_mm_load_ps(x[node[l]].v)), _mm_load_ps(x[node[l + 4]].v), 1);
  };
  const __m256 a = pair(0), b = pair(1), c = pair(2), d = pair(3);
  const __m256 ab = _mm256_unpacklo_ps(a, b), cd = _mm256_unpacklo_ps(c, d);
  const __m256 ab_z = _mm256_unpackhi_ps(a, b), cd_z = _mm256_unpackhi_ps(c, d);
  return {(Lanes)_mm256_shuffle_ps(ab, cd, 0x44), (Lanes)_mm256_shuffle_ps(ab, cd, 0xee),
          (Lanes)_mm256_shuffle_ps(ab_z, cd_z, 0x44)};
}

inline void scatter_add(Float4* f, const std::int32_t* node, const Nodal& g) {
  const __m256 x = (__m256)g.x, y = (__m256)g.y, z = (__m256)g.z, o = _mm256_setzero_ps();
  const __m256 xy = _mm256_unpacklo_ps(x, y), zo = _mm256_unpacklo_ps(z, o);
  const __m256 xy_h = _mm256_unpackhi_ps(x, y), zo_h = _mm256_unpackhi_ps(z, o);
  const __m256 r[4] = {_mm256_shuffle_ps(xy, zo, 0x44), _mm256_shuffle_ps(xy, zo, 0xee),
                       _mm256_shuffle_ps(xy_h, zo_h, 0x44), _mm256_shuffle_ps(xy_h, zo_h, 0xee)};
  const auto add = [&](int lane, __m128 v) {
    float* p = f[node[lane]].v;
    _mm_store_ps(p, _mm_add_ps(_mm_load_ps(p), v));
  };
  for (int l = 0; l < 4; ++l) {
    add(l, _mm256_castps256_ps128(r[l]));
    add(l + 4, _mm256_extractf128_ps(r[l], 1));
  }
}
#else
inline Nodal gather(const Float4* x, const std::int32_t* node) {
  alignas(64) float b[3][width];
  for (int l = 0; l < width; ++l) {
    const float* p = x[node[l]].v;
    b[0][l] = p[0], b[1][l] = p[1], b[2][l] = p[2];
  }
  return {*reinterpret_cast<const Lanes*>(b[0]), *reinterpret_cast<const Lanes*>(b[1]),
          *reinterpret_cast<const Lanes*>(b[2])};
}

inline void scatter_add(Float4* f, const std::int32_t* node, const Nodal& g) {
  for (int l = 0; l < width; ++l) {
    float* p = f[node[l]].v;
    p[0] += g.x[l], p[1] += g.y[l], p[2] += g.z[l];
  }
}
#endif

inline Lanes load(const float* p) { return *reinterpret_cast<const Lanes*>(p); }

/// F = Ds B with Ds the current edges from node 0, of the batch's lanes from `first`.
inline Tensor deformation_gradient(const Batch& b, int first, const Float4* x) {
  const Nodal x0 = gather(x, b.node[0] + first);
  Lanes F[9] = {};
  for (int a = 1; a < 4; ++a) {
    const Nodal xa = gather(x, b.node[a] + first);
    const Lanes d[3] = {xa.x - x0.x, xa.y - x0.y, xa.z - x0.z};
    for (int j = 0; j < 3; ++j) {
      const Lanes B = load(b.B[3 * (a - 1) + j] + first);
      for (int i = 0; i < 3; ++i) F[3 * i + j] += d[i] * B;
    }
  }
  return {F[0], F[1], F[2], F[3], F[4], F[5], F[6], F[7], F[8]};
}

/// H = -V P B^T: columns are the forces on nodes 1..3, node 0 takes the opposite of their sum.
inline void add_forces(const Batch& b, int first, const Tensor& P, Float4* f) {
  const Lanes V = load(b.volume + first);
  Nodal sum{Lanes{}, Lanes{}, Lanes{}};
  for (int a = 1; a < 4; ++a) {
    const Lanes B0 = load(b.B[3 * (a - 1)] + first) * V, B1 = load(b.B[3 * (a - 1) + 1] + first) * V,
                B2 = load(b.B[3 * (a - 1) + 2] + first) * V;
    const Nodal g{-(P.m00 * B0 + P.m01 * B1 + P.m02 * B2), -(P.m10 * B0 + P.m11 * B1 + P.m12 * B2),
                  -(P.m20 * B0 + P.m21 * B1 + P.m22 * B2)};
    scatter_add(f, b.node[a] + first, g);
    sum.x -= g.x, sum.y -= g.y, sum.z -= g.z;
  }
  scatter_add(f, b.node[0] + first, sum);
}

inline Lanes all(float v) { return Lanes{} + v; }

inline Lanes nodal_mean(const float* p, const Batch& b, int first) {
  Lanes s{};
  for (int l = 0; l < width; ++l) {
    const int k = first + l;
    s[l] = 0.25f * (p[b.node[0][k]] + p[b.node[1][k]] + p[b.node[2][k]] + p[b.node[3][k]]);
  }
  return s;
}

using Stress = material::Sym3T<Lanes>;

inline Stress load(const float (&rows)[6][lanes], int first) {
  return {load(rows[0] + first), load(rows[1] + first), load(rows[2] + first),
          load(rows[3] + first), load(rows[4] + first), load(rows[5] + first)};
}
inline void store(const Stress& s, float (&rows)[6][lanes], int first) {
  const Lanes* from[6] = {&s.xx, &s.yy, &s.zz, &s.yz, &s.xz, &s.xy};
  for (int k = 0; k < 6; ++k) *reinterpret_cast<Lanes*>(rows[k] + first) = *from[k];
}

/// The stress that the law and the fibres give at once, without the volumetric part.
template <bool fibres, class Law>
inline Tensor isochoric(const Law& law, const KernelMaterial& m, const Batch& b, int first, const Tensor& F,
                        const Lanes& J1) {
  Tensor P;
  law.first_piola(F, J1, Lanes{}, P);
  if constexpr (fibres) {
    Tensor along;
    const material::Vec3T<Lanes> a{load(b.fibre[0] + first), load(b.fibre[1] + first), load(b.fibre[2] + first)};
    // Fibres measure the true volume, whatever the matrix does.
    material::Fibre<Lanes>(all(m.k1), all(m.k2), a)
        .first_piola(F, material::FiniteVolume<Lanes>::volume_strain(F), Lanes{}, along);
    P += along;
  }
  return P;
}

template <bool fibres, bool prony, class Law>
inline KernelReport run(const Law& law, const Batch* batches, std::size_t n, const KernelMaterial& m, const Float4* x,
                        Float4* f, const float* pressure, const BatchStress* history) {
  KernelReport report;
  Lanes min_J = all(1e30f);
  for (std::size_t part = 0; part < n * (lanes / width); ++part) {
    const std::size_t e = part / (lanes / width);
    const int first = int(part % (lanes / width)) * width;
    const Batch& b = batches[e];
    const Tensor F = deformation_gradient(b, first, x);
    const Lanes J1 = Law::volume_strain(F);
    const Lanes p = pressure ? nodal_mean(pressure, b, first) : Law::volume_pressure(all(m.bulk), J1);
    Tensor P;
    if constexpr (fibres) {
      P = isochoric<true>(law, m, b, first, F, J1) + Law::volume_gradient(F) * p;
    } else {
      law.first_piola(F, J1, p, P);
    }
    if constexpr (prony) {
      const BatchStress* past = history + e * std::size_t(first_branch + m.prony_terms);
      P = P - material::first_piola_of(F, load(past[relaxed_stress].row, first));
    }
    add_forces(b, first, P, f);
    min_J = J1 < min_J ? J1 : min_J;
    const auto bad = ~(J1 > all(-1.0f));  // NaN compares false: it is bad too
    int any = 0;
    for (int l = 0; l < width; ++l) any |= bad[l];
    if (any) [[unlikely]] {
      for (int l = 0; l < width; ++l) {
        if (bad[l] && b.volume[first + l] > 0) ++report.inverted, report.worst_element = b.element[first + l];
      }
    }
  }
  for (int l = 0; l < width; ++l) report.min_J = std::min(report.min_J, min_J[l] + 1);
  return report;
}

/// Maxwell branches on the isochoric second Piola-Kirchhoff stress.
template <bool fibres, class Law>
inline double run_relaxation(const Law& law, const Batch* batches, std::size_t n, const KernelMaterial& m,
                             const Float4* x, BatchStress* history) {
  double energy = 0;
  for (std::size_t part = 0; part < n * (lanes / width); ++part) {
    const std::size_t e = part / (lanes / width);
    const int first = int(part % (lanes / width)) * width;
    const Batch& b = batches[e];
    BatchStress* past = history + e * std::size_t(first_branch + m.prony_terms);
    const Tensor F = deformation_gradient(b, first, x);
    const Lanes J1 = Law::volume_strain(F);
    const Stress now =
        material::second_piola(Law::volume_gradient(F), J1 + 1.0f, isochoric<fibres>(law, m, b, first, F, J1));
    const Stress before = load(past[last_stress].row, first);
    Stress left = now;
    for (int term = 0; term < m.prony_terms; ++term) {
      auto& branch = past[first_branch + term].row;
      Stress h = load(branch, first);
      material::relax(m.prony[term], now, before, h, left);
      store(h, branch, first);
    }
    const Stress taken = material::difference(now, left);
    const Stress fall = material::difference(load(past[relaxed_stress].row, first), taken);
    store(now, past[last_stress].row, first), store(taken, past[relaxed_stress].row, first);
    const Lanes rise = load(b.volume + first) * 0.5f * material::contract(fall, material::right_strain(F));
    for (int l = 0; l < width; ++l) energy += double(rise[l]);
  }
  return energy;
}

template <class Law>
inline KernelReport choose(const Law& law, const Batch* batches, std::size_t n, const KernelMaterial& m,
                           const Float4* x, Float4* f, const float* pressure, const BatchStress* history) {
  if (m.fibres) {
    return m.prony_terms ? run<true, true>(law, batches, n, m, x, f, pressure, history)
                         : run<true, false>(law, batches, n, m, x, f, pressure, history);
  }
  return m.prony_terms ? run<false, true>(law, batches, n, m, x, f, pressure, history)
                       : run<false, false>(law, batches, n, m, x, f, pressure, history);
}

template <class Visit>
inline auto with_law(const KernelMaterial& m, Visit&& visit) {
  switch (m.law) {
    case material::Law::neo_hooke:
      return visit(material::NeoHooke<Lanes>(all(m.c10)));
    case material::Law::mooney_rivlin:
      return visit(material::MooneyRivlin<Lanes>(all(m.c10), all(m.c01)));
    case material::Law::hooke_corotated:
      return visit(material::HookeCorotated<Lanes>(all(m.mu)));
    case material::Law::hooke_small_strain:
      return visit(material::HookeSmallStrain<Lanes>(all(m.mu)));
  }
  CARUS_ASSERT(false);
}

KernelReport forces(const Batch* batches, std::size_t n, const KernelMaterial& m, const Float4* x, Float4* f,
                    const float* pressure, const BatchStress* history) {
  return with_law(m, [&](const auto& law) { return choose(law, batches, n, m, x, f, pressure, history); });
}

double relax(const Batch* batches, std::size_t n, const KernelMaterial& m, const Float4* x, BatchStress* history) {
  return with_law(m, [&](const auto& law) {
    return m.fibres ? run_relaxation<true>(law, batches, n, m, x, history)
                    : run_relaxation<false>(law, batches, n, m, x, history);
  });
}

/// V = det Ds / 6: neither the rest shape is fetched for it, nor does an active strain change it.
void volumes(const Batch* batches, std::size_t n, const Float4* x, float* current) {
  for (std::size_t e = 0; e < n; ++e) {
    const Batch& b = batches[e];
    for (int first = 0; first < lanes; first += width) {
      const Nodal x0 = gather(x, b.node[0] + first), x1 = gather(x, b.node[1] + first),
                  x2 = gather(x, b.node[2] + first), x3 = gather(x, b.node[3] + first);
      const Tensor edges{x1.x - x0.x, x2.x - x0.x, x3.x - x0.x, x1.y - x0.y, x2.y - x0.y,
                         x3.y - x0.y, x1.z - x0.z, x2.z - x0.z, x3.z - x0.z};
      const Lanes quarter = load(b.volume + first) > Lanes{} ? material::determinant(edges) * (1.0f / 24) : Lanes{};
      for (int a = 0; a < 4; ++a) {
        for (int l = 0; l < width; ++l) current[b.node[a][first + l]] += quarter[l];
      }
    }
  }
}
