// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "carus/core/types.hpp"
#include "carus/report/cubic.hpp"
#include "carus/report/folder.hpp"
#include "carus/report/wrench.hpp"

namespace carus::report {

/// The head's motion as a run put it out: displacement of its centre and rotation vector (axis times angle), both from
/// the start; RAS.
struct Motion {
  std::vector<double> time;         ///< [s of labour]
  std::vector<Vec3> displacement;   ///< [mm]
  std::vector<Vec3> rotation;       ///< [deg], continuous: no jump by a turn
  std::vector<double> travel;       ///< [mm] along the canal's axis
  Vec3 start = Vec3::Zero();        ///< [mm] the centre at rest, where frames tell it
  std::vector<double> wrench_time;  ///< of the frames; empty without frames
  std::vector<Wrench> wrench;
};
/// Up to the first output after birth, or with `to_end` to the end. Throws InputError if the curves lack the columns,
/// or hold fewer than two outputs or values that are not finite.
Motion motion_of(const Folder& folder, bool to_end = false);
/// Adds start and wrench from the frames; what cannot be read becomes a note.
void add_wrench(Motion& motion, const Folder& folder, std::vector<std::string>& notes);

/// How a pose becomes the one coordinate of a trainer's cylinder.
enum class Axis {
  chord,  ///< displacement projected on the line from start to end
  z,      ///< -z: the paper's cranio-caudal descent
  path,   ///< travel along the canal's axis
};
const char* name_of(Axis axis);
std::vector<double> along(const Motion& motion, Axis axis);  ///< [mm] from the start, at motion.time
Vec3 direction(const Motion& motion, Axis axis);             ///< unit; zero for `path`

/// The trajectory that BirthSIM imposes in place of a computed one, with the amplitude, the duration and the
/// contractions of this run. Linear: constant speed. Cyclic: down at constant speed from the start of each contraction
/// to the end of its plateau, back by `recession` of that at constant speed in the rest after it; all contractions
/// alike. Points (time [s], mm), straight between.
struct Reference {
  std::vector<double> time, value;
  [[nodiscard]] double at(double t) const;
};
Reference imposed_linear(double duration, double amplitude);
Reference imposed_cyclic(double duration, double amplitude, const labour::Contractions& contractions, double recession);
inline constexpr double imposed_recession = 0.25;  ///< of each advance; the paper draws the cycles, it gives no number

struct Limits {
  std::optional<double> speed, acceleration, stroke;  ///< [mm/s], [mm/s²], [mm]
};
struct TrajectoryOptions {
  double rate = 10;  ///< [Hz]
  Axis axis = Axis::chord;
  Limits limits;           ///< of the axis' coordinate
  bool slow_down = false;  ///< stretch time where speed or acceleration are over
};

/// Resampled: every quantity by a MonotoneCubic through the outputs.
struct Trajectory {
  TrajectoryOptions options;
  double time_stretch = 1;                         ///< seconds here per second of labour
  MonotoneCubic::Extreme speed{}, acceleration{};  ///< largest along the axis, in stretched time
  double stroke_low = 0, stroke_high = 0;          ///< [mm] the axis' range
  Vec3 axis_direction = Vec3::Zero(), start = Vec3::Zero();
  bool has_wrench = false, has_cyclic = false;
  std::vector<std::string> columns;
  std::vector<std::vector<double>> rows;
};
/// Throws InputError naming each limit that is passed, where, and by what, unless slow_down can cure it.
Trajectory resample(const Motion& motion, const std::optional<labour::Contractions>& contractions,
                    const TrajectoryOptions& options);

std::string as_csv(const Trajectory& trajectory);
std::string as_json(const Trajectory& trajectory, const Folder& folder);

}  // namespace carus::report
