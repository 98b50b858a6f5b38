// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <fstream>
#include <sstream>
#include <string>

#include "../results/mover.hpp"

namespace carus::test {

/// A whole results folder, written by the same code as a birth's, of a fetus of boxes that sinks.
inline void write_small_run(const std::filesystem::path& out, double descent = 0.4, int frames = 8) {
  auto scenario = quick_scenario();
  scenario.output.frames = frames;
  const auto model = fetus_of_boxes();
  auto setup = setup_of_boxes();
  setup.contractions = scenario.loads.contractions;
  results::RunOptions options;
  options.out = out, options.version = "test";
  results::prepare_folder(out, false);
  Mover mover(model, descent);
  results::run_birth(scenario, model, setup, mover, options);
}

inline std::string text_of(const std::filesystem::path& file) {
  std::ifstream in(file, std::ios::binary);
  std::ostringstream text;
  text << in.rdbuf();
  return text.str();
}
inline void set_text(const std::filesystem::path& file, const std::string& text) {
  std::ofstream(file, std::ios::binary) << text;
}

/// What an InputError said, or "" if none was thrown.
template <class F>
std::string error_of(F&& f) {
  try {
    f();
  } catch (const InputError& e) {
    return e.what();
  }
  return "";
}

}  // namespace carus::test
