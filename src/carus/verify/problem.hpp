// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cmath>
#include <functional>
#include <limits>
#include <string>
#include <vector>

namespace carus::verify {

/// One number of a problem against what it should be.
struct Check {
  std::string quantity, unit, solver;  ///< "explicit", "implicit", "explicit against implicit"
  double expected = 0, obtained = 0;
  double tolerance = 0;                                           ///< of `error`, with its reason in the problem's code
  double scale = 0;                                               ///< what the error is measured by; 0: |expected|
  double order = std::numeric_limits<double>::quiet_NaN();        ///< observed, where meshes were refined
  double least_order = -std::numeric_limits<double>::infinity();  ///< asked for

  [[nodiscard]] double error() const {
    return std::abs(obtained - expected) / (scale > 0 ? scale : std::abs(expected));
  }
  [[nodiscard]] bool met() const { return error() <= tolerance && !(order < least_order); }
};

/// A benchmark problem with its reference.
struct Problem {
  std::string name;       ///< for the command line, e.g. "thick_sphere"
  std::string title;      ///< what is computed
  std::string reference;  ///< the closed form or value, and its source
  bool quick = true;      ///< seconds, not minutes: part of `carus verify --quick`
  std::function<std::vector<Check>()> run;
};

struct Outcome {
  const Problem* problem;
  std::vector<Check> checks;
  std::string failure;  ///< of a problem that ended by an error
  double seconds = 0;   ///< processor time of the whole process
  [[nodiscard]] bool met() const;
};

/// All problems, in the order of the documentation.
const std::vector<Problem>& problems();

/// Runs one; an error is an outcome that is not met.
Outcome run(const Problem& problem);

/// A line for the terminal per check.
std::string as_text(const Outcome& outcome);
std::string as_csv(const std::vector<Outcome>& outcomes);
/// docs/theory/verification.md. `machine`: what it was run on, `version`: by what.
std::string as_markdown(const std::vector<Outcome>& outcomes, const std::string& machine, const std::string& version);
/// "MET: ..." or "NOT MET: ...".
std::string verdict(const std::vector<Outcome>& outcomes);

/// Order from errors on meshes each twice as fine as the one before, of the last two.
inline double observed_order(const std::vector<double>& errors) {
  return std::log2(errors[errors.size() - 2] / errors.back());
}

}  // namespace carus::verify
