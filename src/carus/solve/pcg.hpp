// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cmath>
#include <vector>

#include "carus/core/parallel.hpp"
#include "carus/core/types.hpp"

namespace carus::solve {

/// A vector over the unknowns, three to an entry.
using Unknowns = std::vector<Vec3>;

inline constexpr std::size_t unknown_chunk = 2048;

inline double dot(const Unknowns& a, const Unknowns& b) {
  return parallel::sum_chunks(a.size(), unknown_chunk, [&](std::size_t begin, std::size_t end) {
    double sum = 0;
    for (std::size_t i = begin; i < end; ++i) sum += a[i].dot(b[i]);
    return sum;
  });
}
/// y += a x.
inline void add_scaled(double a, const Unknowns& x, Unknowns& y) {
  parallel::for_chunks(y.size(), unknown_chunk, [&](std::size_t begin, std::size_t end, std::size_t) {
    for (std::size_t i = begin; i < end; ++i) y[i] += a * x[i];
  });
}

struct PcgResult {
  int iterations = 0;
  double reduction = 1;             ///< of the preconditioned residual's norm
  bool negative_curvature = false;  ///< stopped where the matrix is not positive along a direction
};

/// Scratch vectors of a solve, to be kept between solves.
struct PcgWork {
  Unknowns r, z, p, Ap;
};

/// Preconditioned conjugate gradients for A x = b from x = 0, until sqrt(r.M^-1 r) has fallen by `tolerance`. Stops at
/// a direction without curvature (Steihaug 1983): what it has then still descends. `multiply(p, Ap)` and
/// `precondition(r, z)` overwrite their second argument. Sums do not depend on the number of threads.
template <class Multiply, class Precondition>
PcgResult pcg(Multiply&& multiply, Precondition&& precondition, const Unknowns& b, Unknowns& x, double tolerance,
              int max_iterations, PcgWork& w) {
  x.assign(b.size(), Vec3::Zero());
  w.r = b;
  w.z.resize(b.size()), w.Ap.resize(b.size());
  precondition(w.r, w.z);
  w.p = w.z;
  double rz = dot(w.r, w.z);
  const double start = rz;
  PcgResult out;
  if (!(start > 0)) return out;
  while (out.iterations < max_iterations) {
    multiply(w.p, w.Ap);
    const double curvature = dot(w.p, w.Ap);
    if (!(curvature > 0)) {
      out.negative_curvature = true;
      if (out.iterations == 0) x = w.p;
      break;
    }
    const double a = rz / curvature;
    add_scaled(a, w.p, x);
    add_scaled(-a, w.Ap, w.r);
    precondition(w.r, w.z);
    const double next = dot(w.r, w.z);
    ++out.iterations;
    out.reduction = std::sqrt(next / start);
    if (!(out.reduction > tolerance)) break;
    const double beta = next / rz;
    parallel::for_chunks(w.p.size(), unknown_chunk, [&](std::size_t begin, std::size_t end, std::size_t) {
      for (std::size_t i = begin; i < end; ++i) w.p[i] = w.z[i] + beta * w.p[i];
    });
    rz = next;
  }
  return out;
}

}  // namespace carus::solve
