// SPDX-License-Identifier: Apache-2.0
#include "carus/imaging/frame.hpp"

#include <fmt/format.h>

#include <map>

#include "carus/core/error.hpp"

namespace carus::imaging {

Convention convention(const std::string& unit, const std::string& frame, const std::string& where) {
  static const std::map<std::string, double> units{{"m", 1.0}, {"cm", 1e-2}, {"mm", 1e-3}, {"um", 1e-6}};
  static const std::map<char, Vec3> ways{{'R', Vec3::UnitX()},  {'L', -Vec3::UnitX()}, {'A', Vec3::UnitY()},
                                         {'P', -Vec3::UnitY()}, {'S', Vec3::UnitZ()},  {'I', -Vec3::UnitZ()}};
  const auto u = units.find(unit);
  if (u == units.end())
    throw InputError(
        fmt::format("{}: unit \"{}\"; allowed m, cm, mm, um: a file of triangles does not say it", where, unit));
  Mat3 to_ras = Mat3::Zero();
  if (frame.size() == 3)
    for (int k = 0; k < 3; ++k)
      if (const auto way = ways.find(frame[k]); way != ways.end()) to_ras.col(k) = way->second;
  if (std::abs(to_ras.determinant()) != 1)
    throw InputError(fmt::format(
        "{}: frame \"{}\"; allowed three letters for where +x, +y, +z point, one of R/L, one of A/P, one of S/I: RAS "
        "(NIfTI), LPS (DICOM), LSA (y up)",
        where, frame));
  return {u->second, to_ras};
}

}  // namespace carus::imaging
