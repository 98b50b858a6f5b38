// SPDX-License-Identifier: Apache-2.0
#pragma once

namespace carus::labour {

/// Waveform of the contractions: base tonus, then rise, plateau, fall; the paper's Fig. 9.
struct Contractions {
  double base = 0;              ///< [Pa] between contractions
  double amplitude = 0;         ///< [Pa] above the base at the plateau
  double duration = 90;         ///< [s]
  double rise = 30, fall = 30;  ///< [s], the rest is plateau
  double period = 240;          ///< [s] from start to start
  double first = 30;            ///< [s] start of the first
};
/// Voluntary push (abdominals, diaphragm), in synchrony with the contractions.
struct Push {
  bool enabled = true;
  double amplitude = 0;         ///< [Pa]
  bool directed = true;         ///< along the canal axis; false: follower pressure
  int efforts = 1;              ///< efforts within one contraction
  double effort_duration = 10;  ///< [s] each, where efforts > 1
};
struct ResidualTone {
  bool enabled = true;
  double pressure = 9500;  ///< [Pa]
};

/// 0..1: how far the contraction under way at t [s] has risen. Smooth (C1).
double contraction_activity(const Contractions& c, double t);
/// [Pa]
double contraction_pressure(const Contractions& c, double t);
double push_pressure(const Push& p, const Contractions& c, double t);
double tone_pressure(const ResidualTone& tone, double t);
/// Number of contractions that have begun by t.
int contractions_begun(const Contractions& c, double t);

}  // namespace carus::labour
