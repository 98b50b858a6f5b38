// SPDX-License-Identifier: Apache-2.0
#include "carus/report/cubic.hpp"

#include <algorithm>
#include <cmath>

#include "carus/core/error.hpp"

namespace carus::report {
namespace {

/// Slope at an end: of the parabola through three points, held to the sign of the first secant and to three times it.
double end_slope(double h1, double h2, double d1, double d2) {
  const double m = ((2 * h1 + h2) * d1 - h1 * d2) / (h1 + h2);
  if (m * d1 <= 0) return 0;
  if (d1 * d2 <= 0 && std::abs(m) > 3 * std::abs(d1)) return 3 * d1;
  return m;
}

}  // namespace

MonotoneCubic::MonotoneCubic(std::vector<double> t, std::vector<double> y)
    : t_(std::move(t)), y_(std::move(y)), m_(t_.size(), 0) {
  CARUS_ASSERT(!t_.empty() && t_.size() == y_.size());
  const std::size_t n = t_.size();
  if (n < 2) return;
  std::vector<double> h(n - 1), d(n - 1);
  for (std::size_t i = 0; i + 1 < n; ++i) {
    h[i] = t_[i + 1] - t_[i];
    CARUS_ASSERT(h[i] > 0);
    d[i] = (y_[i + 1] - y_[i]) / h[i];
  }
  if (n == 2) {
    m_ = {d[0], d[0]};
    return;
  }
  for (std::size_t i = 1; i + 1 < n; ++i) {
    if (d[i - 1] * d[i] <= 0) continue;
    const double w1 = 2 * h[i] + h[i - 1], w2 = h[i] + 2 * h[i - 1];
    m_[i] = (w1 + w2) / (w1 / d[i - 1] + w2 / d[i]);
  }
  m_[0] = end_slope(h[0], h[1], d[0], d[1]);
  m_[n - 1] = end_slope(h[n - 2], h[n - 3], d[n - 2], d[n - 3]);
}

MonotoneCubic::Place MonotoneCubic::place(double t) const {
  const auto after = std::size_t(std::upper_bound(t_.begin(), t_.end(), t) - t_.begin());
  const std::size_t i = std::clamp<std::size_t>(after, 1, t_.size() - 1) - 1;
  const double h = t_[i + 1] - t_[i];
  return {i, h, (t - t_[i]) / h};
}

double MonotoneCubic::value(double t) const {
  if (t_.size() < 2 || t <= t_.front()) return y_.front();
  if (t >= t_.back()) return y_.back();
  // Hermite: y = y0 + h s (m0 + s ((3 d - 2 m0 - m1) + s (m0 + m1 - 2 d)))
  const auto [i, h, s] = place(t);
  const double d = (y_[i + 1] - y_[i]) / h, m0 = m_[i], m1 = m_[i + 1];
  return y_[i] + h * s * (m0 + s * ((3 * d - 2 * m0 - m1) + s * (m0 + m1 - 2 * d)));
}

double MonotoneCubic::slope_in(std::size_t i, double s) const {
  const double d = (y_[i + 1] - y_[i]) / (t_[i + 1] - t_[i]), m0 = m_[i], m1 = m_[i + 1];
  return m0 + s * (2 * (3 * d - 2 * m0 - m1) + 3 * s * (m0 + m1 - 2 * d));
}

double MonotoneCubic::curvature_in(std::size_t i, double s) const {
  const double h = t_[i + 1] - t_[i], d = (y_[i + 1] - y_[i]) / h, m0 = m_[i], m1 = m_[i + 1];
  return (2 * (3 * d - 2 * m0 - m1) + 6 * s * (m0 + m1 - 2 * d)) / h;
}

double MonotoneCubic::slope(double t) const {
  if (outside(t)) return 0;
  const auto p = place(t);
  return slope_in(p.i, p.s);
}

double MonotoneCubic::curvature(double t) const {
  if (outside(t)) return 0;
  const auto p = place(t);
  return curvature_in(p.i, p.s);
}

MonotoneCubic::Extreme MonotoneCubic::steepest() const {
  Extreme best{t_.front(), 0};
  for (std::size_t i = 0; i + 1 < t_.size(); ++i) {
    const double c0 = curvature_in(i, 0), c1 = curvature_in(i, 1);
    double at[3] = {0, 1, 0};
    if (c0 * c1 < 0) at[2] = c0 / (c0 - c1);
    for (const double s : at) {
      if (const double v = slope_in(i, s); std::abs(v) > std::abs(best.value))
        best = {t_[i] + s * (t_[i + 1] - t_[i]), v};
    }
  }
  return best;
}

MonotoneCubic::Extreme MonotoneCubic::most_curved() const {
  Extreme best{t_.front(), 0};
  for (std::size_t i = 0; i + 1 < t_.size(); ++i) {
    for (const double s : {0.0, 1.0}) {
      if (const double v = curvature_in(i, s); std::abs(v) > std::abs(best.value)) best = {t_[i + (s > 0 ? 1 : 0)], v};
    }
  }
  return best;
}

}  // namespace carus::report
