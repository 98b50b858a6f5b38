// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <CLI/CLI.hpp>
#include <string>
#include <vector>

#include "carus/mesh/surface.hpp"

namespace carus::app {

/// Where `carus mesh` takes its organs from, as its options say it.
struct OrganOptions {
  std::string labels;                 ///< file of a label volume
  std::vector<std::string> which;     ///< its labels; "1+2" makes one organ of two
  std::vector<std::string> surfaces;  ///< files of closed surfaces
  std::string unit, frame, part;      ///< of these
  std::string scenario;               ///< whose generated organs are wanted
  std::vector<std::string> organs{"fetus", "uterus"};
  double smoothing = 0.8;  ///< [voxels]
  std::string spacing;     ///< a length, or nothing
  bool largest = false;
};
void add_organ_options(CLI::App& command, OrganOptions& o);

struct Organ {
  std::string name;
  mesh::Surface surface;   ///< closed, outward
  double d_organ = 0;      ///< the length that the paper's alpha takes for it [m], 0: to be measured
  std::string d_organ_is;  ///< what length that is
};
/// Reads or makes them, telling on standard output what was done. Throws InputError.
std::vector<Organ> organs(const OrganOptions& o);

/// `carus mesh volume`.
void add_mesh_volume(CLI::App& mesh, int& status);

/// A length with its unit ("0.5 mm") in metres; throws InputError naming `option` unless it is between low and high.
double length(const std::string& text, const std::string& option, double low, double high);
/// The same for an angle ("45 deg") in rad.
double angle(const std::string& text, const std::string& option, double low, double high);

}  // namespace carus::app
