// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <functional>
#include <string>
#include <vector>

#include "carus/fem/model.hpp"
#include "carus/observe/strain.hpp"

class vtkUnstructuredGrid;

namespace carus::results {

/// frames/frame_NNNN.vtu (VTK XML, appended raw, single precision, zlib) and frames.pvd, which names only frames that
/// are whole.
///
///     points     current position [m];  displacement [m], velocity [m/s of labour], contact_force [N]
///     cells      region, organ (numbers by name in the field data), J, max_stretch
class Frames {
 public:
  /// `times`: of frames that are already there (resume).
  Frames(std::filesystem::path folder, const fem::Model& model, const observe::Strain& strain,
         std::vector<double> times = {});
  /// `more` may add fields of its own.
  void write(const fem::State& state, const std::vector<Vec3>& contact_force,
             const std::function<void(vtkUnstructuredGrid&)>& more = {});
  [[nodiscard]] const std::vector<double>& times() const { return times_; }  ///< [s of labour]

 private:
  void write_index() const;

  std::filesystem::path folder_;
  const fem::Model& model_;
  const observe::Strain& strain_;
  std::vector<double> times_;
  std::vector<std::string> regions_, organs_;
  std::vector<std::int32_t> organ_;  // per tet
};

}  // namespace carus::results
