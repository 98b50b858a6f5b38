// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "carus/fem/model.hpp"

namespace carus::fem {

/// The rest length of a retracting wall: one value per ring, hat functions along the wall's coordinate s, so that it
/// belongs to a stretch of wall and not to an element and converges with the mesh.
class RestLength {
 public:
  explicit RestLength(const Model& model);

  /// Moves the rest length on by dt [s of labour]. Ratchet: it follows the wall's mean meridional stretch per ring
  /// downwards while the muscle is active, with time constant tau, never back, never below the floor:
  ///     dr/dt = -activity (r - (1 - e0) stretch)/tau,   r > (1 - e0) stretch,
  /// Hill's law made linear: unloaded the muscle shortens by e0/tau, at the elastic strain e0 it only holds. With e0 =
  /// 0 it follows and takes up no slack. Imposed: as the timetable says.
  void advance(const std::vector<Vec3>& x, double t, double dt);

  [[nodiscard]] bool active() const { return model_->retraction.kind != Retraction::Kind::off; }
  /// Rest length of the i-th retracting element.
  [[nodiscard]] double of(std::size_t i) const;
  [[nodiscard]] double mean() const;
  std::vector<double>& rings() { return rings_; }
  [[nodiscard]] const std::vector<double>& rings() const { return rings_; }

 private:
  struct Share {
    std::int32_t ring;
    double weight;  ///< of `ring`; the next ring has the rest
  };
  void measure(const std::vector<Vec3>& x);

  const Model* model_;
  std::vector<Share> share_;
  std::vector<double> volume_, rings_, stretch_, element_stretch_, ring_volume_;
  std::vector<Mat3> inverse_edges_;
};

}  // namespace carus::fem
