// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

namespace carus::report {

/// A curve through points, cubic between them, with a continuous slope; monotone wherever the points are, so it never
/// leaves the range of the two points that it is between: no overshoot.
///
///     slope at a point: harmonic mean of the secants d on its two sides, weighted by the intervals h,
///         (w1 + w2)/(w1/d1 + w2/d2),  w1 = 2 h2 + h1,  w2 = h2 + 2 h1;  0 where the secants differ in sign
///     (Fritsch and Butland 1984); one-sided three-point formula, held monotone, at the two ends
class MonotoneCubic {
 public:
  /// `t` increasing, at least one; as many `y`. One point is a constant.
  MonotoneCubic(std::vector<double> t, std::vector<double> y);

  [[nodiscard]] double value(double t) const;      ///< constant outside the points
  [[nodiscard]] double slope(double t) const;      ///< dy/dt; 0 outside
  [[nodiscard]] double curvature(double t) const;  ///< d²y/dt², which jumps at the points; 0 outside

  struct Extreme {
    double time, value;  ///< value with its sign
  };
  /// Largest slope and curvature in size, exact: the slope is quadratic between points, the curvature linear.
  [[nodiscard]] Extreme steepest() const;
  [[nodiscard]] Extreme most_curved() const;

 private:
  struct Place {
    std::size_t i;  // interval
    double h, s;    // its length, and where in it, 0..1
  };
  [[nodiscard]] bool outside(double t) const { return t_.size() < 2 || t < t_.front() || t > t_.back(); }
  [[nodiscard]] Place place(double t) const;
  [[nodiscard]] double slope_in(std::size_t i, double s) const;
  [[nodiscard]] double curvature_in(std::size_t i, double s) const;

  std::vector<double> t_, y_, m_;
};

}  // namespace carus::report
