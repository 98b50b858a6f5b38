// SPDX-License-Identifier: Apache-2.0
#include "carus/anatomy/sampled_field.hpp"

#include <algorithm>
#include <cmath>

namespace carus::anatomy {
namespace {

Vec3 slope(const std::function<double(const Vec3&)>& f, const Vec3& x, double e) {
  Vec3 g;
  for (int i = 0; i < 3; ++i) g[i] = (f(x + e * Vec3::Unit(i)) - f(x - e * Vec3::Unit(i))) / (2 * e);
  return g;
}

/// Distance to the zero level by walking down the gradient to the foot point: y <- y - f g / |g|^2.
double true_distance(const std::function<double(const Vec3&)>& f, const Vec3& x) {
  const double f0 = f(x);
  Vec3 y = x;
  double value = f0;
  for (int it = 0; it < 4 && std::abs(value) > 1e-6; ++it) {
    const Vec3 g = slope(f, y, 1e-5);
    if (g.squaredNorm() < 0.04) return f0;  // a ridge far from the surface: the function is good enough there
    y -= value / g.squaredNorm() * g;
    value = f(y);
  }
  const double d = (y - x).norm();
  return std::abs(value) < 1e-4 ? std::copysign(d, f0) : f0;
}

}  // namespace

SampledField::SampledField(const std::function<double(const Vec3&)>& f, const Vec3& low, const Vec3& high, double h)
    : low_(low), h_(h) {
  for (int i = 0; i < 3; ++i) n_[i] = static_cast<int>(std::ceil((high[i] - low[i]) / h)) + 1;
  values_.resize(static_cast<std::size_t>(n_[0]) * n_[1] * n_[2]);
  for (int i = 0; i < n_[0]; ++i)
    for (int j = 0; j < n_[1]; ++j)
      for (int k = 0; k < n_[2]; ++k) at(i, j, k) = true_distance(f, low_ + h_ * Vec3(i, j, k));
}

double SampledField::operator()(const Vec3& x) const {
  std::array<int, 3> i{};
  Vec3 t;
  for (int a = 0; a < 3; ++a) {
    const double u = std::clamp((x[a] - low_[a]) / h_, 0.0, n_[a] - 1.0);
    i[a] = std::min(static_cast<int>(u), n_[a] - 2);
    t[a] = u - i[a];
  }
  double sum = 0;
  for (int c = 0; c < 8; ++c) {
    const int a = c & 1, b = (c >> 1) & 1, d = (c >> 2) & 1;
    sum += (a ? t[0] : 1 - t[0]) * (b ? t[1] : 1 - t[1]) * (d ? t[2] : 1 - t[2]) * at(i[0] + a, i[1] + b, i[2] + d);
  }
  return sum;
}

Vec3 SampledField::gradient(const Vec3& x) const {
  Vec3 g;
  for (int i = 0; i < 3; ++i) g[i] = ((*this)(x + h_ * Vec3::Unit(i)) - (*this)(x - h_ * Vec3::Unit(i))) / (2 * h_);
  return g;
}

}  // namespace carus::anatomy
