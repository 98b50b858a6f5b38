// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>
#include <map>
#include <memory>
#include <string>
#include <vector>

#include "carus/fem/model.hpp"
#include "carus/labour/labour.hpp"
#include "carus/observe/pose.hpp"
#include "carus/observe/strain.hpp"
#include "carus/solve/explicit.hpp"

namespace carus::observe {

/// What the measurements must know of the anatomy, in the model's numbering and rest configuration.
struct Setup {
  std::map<std::string, Vec3>
      landmarks;  ///< [m] of the pelvis, the fetus' head and the vulva: see `required_landmarks`
  std::map<std::string, std::vector<std::int32_t>>
      nodes;  ///< optional: "point_fundus", "point_lower", "point_left", "point_right", "vulva", "hiatus"
  std::vector<std::string> fetal_regions, head_regions,
      trunk_regions;  ///< of the model; head_regions: bone, without the skin
  std::function<double(const Vec3&)>
      canal_nearest;                          ///< arc length along the birth canal's axis [m], grows towards the vulva
  std::function<Vec3(double)> canal_tangent;  ///< unit, towards the vulva
  labour::Contractions contractions;
};

/// "occiput", "sinciput", "biparietal_right", "biparietal_left", "spine_right", "spine_left", "vulva_centre",
/// "vulva_normal"
const std::vector<std::string>& required_landmarks();

using Values = std::vector<double>;

/// Everything that is measured at an output, as a flat list of names (unit at the end of each) and values. Holds node
/// sets and rest values; `measure` is a pure function of its arguments, independent of threads, about 1 µs per element.
class Observer {
 public:
  /// `model` must outlive the observer. Throws InputError naming the landmarks and regions that are missing.
  Observer(const fem::Model& model, Setup setup);
  ~Observer();

  [[nodiscard]] const std::vector<std::string>& names() const;
  /// `previous`: the values of the output before, for speeds; null at the first.
  [[nodiscard]] Values measure(const fem::State& state, const solve::Observables& seen, const Values* previous) const;
  [[nodiscard]] std::size_t index(const std::string& name) const;  ///< of a name; asserts that it is there
  [[nodiscard]] const Strain& strain() const;
  /// Pose of the head's bone, the trunk's, by best fit.
  [[nodiscard]] Pose head_pose(const fem::State& state) const;
  [[nodiscard]] Pose trunk_pose(const fem::State& state) const;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace carus::observe
