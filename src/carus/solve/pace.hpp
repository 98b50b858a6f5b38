// SPDX-License-Identifier: Apache-2.0
#pragma once

namespace carus::solve {

/// How far the time scaling may follow the labour. Equal bounds: it stays as it is.
struct PaceOptions {
  double kinetic_ratio = 0.04;  ///< kinetic over internal energy, at most
  double slowest = 1;           ///< least multiple of the mean time scaling
  double fastest = 1;           ///< greatest
};

/// How fast labour passes in pseudo-time, as a multiple of the mean time scaling. Inertia grows with its square: where
/// the kinetic energy exceeds its share the pace falls at once; where it is far below and the loads stand, in the
/// rests, it rises a rung at a time, and before the loads move again it is back at the mean. The rungs are sqrt(2)
/// apart. A function of what it is told, so the same for any number of threads.
class Pace {
 public:
  explicit Pace(const PaceOptions& options);
  [[nodiscard]] bool varies() const { return lowest_ < highest_; }
  [[nodiscard]] double factor() const;
  /// True if the pace changed. `kinetic`, `internal`: energies now [J]; `steady`: loads stand until the next judgement.
  bool judge(double kinetic, double internal, bool steady);

  [[nodiscard]] int rung() const { return rung_; }
  void set_rung(int rung) { rung_ = rung; }

 private:
  double ratio_;
  int lowest_, highest_, rung_ = 0;
};

}  // namespace carus::solve
