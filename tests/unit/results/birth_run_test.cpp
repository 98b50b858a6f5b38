// SPDX-License-Identifier: Apache-2.0
#include "carus/results/birth_run.hpp"

#include <gtest/gtest.h>

#include <fstream>
#include <nlohmann/json.hpp>

#include "carus/results/checkpoint.hpp"
#include "carus/results/curves.hpp"
#include "carus/results/files.hpp"
#include "carus/results/schedule.hpp"
#include "mover.hpp"

namespace carus::results {
namespace {

namespace fs = std::filesystem;
using test::Folder;
using test::Mover;

struct Case {
  scenario::Scenario scenario = test::quick_scenario();
  fem::Model model = test::fetus_of_boxes();
  observe::Setup setup = test::setup_of_boxes();
  RunOptions options;

  Outcome run(const fs::path& out, Mover& mover, bool resume = false) {
    options.out = out, options.resume = resume;
    options.version = "test";
    setup.contractions = scenario.loads.contractions;
    prepare_folder(out, resume);
    return run_birth(scenario, model, setup, mover, options);
  }
  Outcome run(const fs::path& out) {
    Mover mover(model);
    return run(out, mover);
  }
};

TEST(BirthRun, DeclaresWhatThePaperDoesNotHave) {
  const Folder folder("declared");
  Case c;
  c.scenario.materials["vaginal_canal"].prony = {{0.75, 300}};
  c.scenario.retraction.enabled = true, c.scenario.retraction.kind = fem::Retraction::Kind::ratchet;
  c.scenario.retraction.tau = 150, c.scenario.retraction.isometric_strain = 0.05;
  c.scenario.attachments.bed_lateral = 4.5e6;
  c.scenario.numerics.pace_fastest = 4, c.scenario.numerics.pace_slowest = 0.5;
  c.run(folder / "with");
  auto j = nlohmann::json::parse(read_text(folder / "with" / "summary.json"))["declared"];
  EXPECT_EQ(j["relaxation"], "vaginal_canal 0.75 in 300 s");
  EXPECT_EQ(j["retraction_law"], "ratchet, 150 s, isometric strain 0.05");
  EXPECT_EQ(j["canal_bed_lateral_kpa_mm"], 4.5);
  EXPECT_EQ(j["pace"], "0.5 to 4 times the mean, for kinetic/internal energy of 0.04");
  c.scenario.numerics.pace_fastest = c.scenario.numerics.pace_slowest = 1;
  c.scenario.materials["vaginal_canal"].prony.clear(), c.scenario.retraction.enabled = false;
  c.run(folder / "without");
  j = nlohmann::json::parse(read_text(folder / "without" / "summary.json"))["declared"];
  EXPECT_EQ(j["relaxation"], "none");
  EXPECT_EQ(j["retraction_law"], "none");
  EXPECT_EQ(j["pace"], "even");
}

/// All that a run leaves but wall times, checkpoint and log.
std::map<std::string, std::string> contents(const fs::path& folder) {
  std::map<std::string, std::string> files;
  for (const auto& entry : fs::recursive_directory_iterator(folder)) {
    const auto name = fs::relative(entry.path(), folder).string();
    if (!entry.is_regular_file() || name == "checkpoint.h5") continue;
    auto text = read_text(entry.path());
    if (name == "summary.json") {
      auto j = nlohmann::json::parse(text);
      j.erase("wall_s");
      text = j.dump();
    }
    files[name] = text;
  }
  return files;
}

void expect_same(const fs::path& a, const fs::path& b) {
  const auto in_a = contents(a), in_b = contents(b);
  ASSERT_EQ(in_a.size(), in_b.size());
  for (const auto& [name, text] : in_a) EXPECT_TRUE(in_b.contains(name) && in_b.at(name) == text) << name;
}

TEST(BirthRun, WritesTheWholeContract) {
  const Folder folder("contract");
  Case c;
  EXPECT_EQ(c.run(folder.path()), Outcome::born);
  for (const char* file : {"scenario.resolved.yaml", "summary.json", "curves.csv", "frames.pvd",
                           "frames/frame_0000.vtu", "checkpoint.h5", "events.jsonl"}) {
    EXPECT_TRUE(fs::exists(folder / file)) << file;
  }
  const auto j = nlohmann::json::parse(read_text(folder / "summary.json"));
  const auto schema = nlohmann::json::parse(read_text(fs::path(CARUS_SOURCE_DIR) / "schema" / "summary.schema.json"));
  for (const auto& key : schema["required"]) EXPECT_TRUE(j.contains(key.get<std::string>())) << key;
  for (const auto& [key, value] : j.items()) EXPECT_TRUE(schema["properties"].contains(key)) << key;
  EXPECT_EQ(j["outcome"], "born");
  EXPECT_NE(j["machine"].get<std::string>().find(" threads"), std::string::npos);
  for (const char* table : {"validation", "bands"}) {
    ASSERT_GT(j[table].size(), 10u);
    for (const auto& key : schema["properties"][table]["items"]["required"])
      EXPECT_TRUE(j[table][0].contains(key.get<std::string>())) << table << key;
  }
  EXPECT_NEAR(j["birth_time_s"].get<double>(), 1920 * 0.18 / 0.4, 60);
  EXPECT_GT(j["head_at_contraction_peaks_mm"].size(), 1u);
  const auto birth = read_text(folder / "events.jsonl").find("\"event\": \"birth\"");
  EXPECT_NE(birth, std::string::npos);
}

TEST(BirthRun, GoesOnUntilTheBodyIsOutIfAsked) {
  const Folder folder("after_birth");
  Case c;
  c.run(folder / "on");
  c.scenario.output.run_after_birth = false;
  c.run(folder / "stop");
  EXPECT_GT(read_curves(folder / "on/curves.csv").rows.size(), read_curves(folder / "stop/curves.csv").rows.size());
}

TEST(BirthRun, InterruptedAndResumedGivesTheSameFiles) {
  const Folder folder("resume");
  Case c;
  c.run(folder / "whole");
  std::atomic<bool> stop{false};
  c.options.stop = &stop;
  Mover first(c.model);
  first.on_advance = [&](double t) { stop = t > 500; };
  ASSERT_EQ(c.run(folder / "parts", first), Outcome::interrupted);
  EXPECT_FALSE(fs::exists(folder / "parts/summary.json"));
  stop = false;
  Mover second(c.model);
  ASSERT_EQ(c.run(folder / "parts", second, true), Outcome::born);
  expect_same(folder / "parts", folder / "whole");
  // And once more, after its end: nothing is added.
  Mover third(c.model);
  ASSERT_EQ(c.run(folder / "parts", third, true), Outcome::born);
  expect_same(folder / "parts", folder / "whole");
}

TEST(BirthRun, KilledAfterLaterOutputsResumesToTheSameFiles) {
  const Folder folder("kill");
  Case c;
  c.run(folder / "whole");
  std::atomic<bool> stop{false};
  c.options.stop = &stop;
  Mover first(c.model);
  first.on_advance = [&](double t) { stop = t > 400; };
  ASSERT_EQ(c.run(folder / "killed", first), Outcome::interrupted);
  // What kill -9 can leave behind: outputs after the checkpoint, torn lines, temporary files; the index names no torn
  // frame.
  std::ofstream(folder / "killed/curves.csv", std::ios::app) << "420,1,2";
  std::ofstream(folder / "killed/events.jsonl", std::ios::app) << "{\"time_s\": 41";
  const auto frames = read_text(folder / "killed/frames.pvd");
  const auto next = std::count(frames.begin(), frames.end(), '\n') - 5;
  std::ofstream(folder / fmt::format("killed/frames/frame_{:04}.vtu.tmp", next)) << "half a frame";
  for (std::size_t at = 0; (at = frames.find("file=\"", at)) != std::string::npos; at += 6) {
    const auto name = frames.substr(at + 6, frames.find('"', at + 6) - at - 6);
    EXPECT_NE(read_text(folder / ("killed/" + name)).find("</VTKFile>"), std::string::npos) << name;
  }
  stop = false;
  Mover second(c.model);
  ASSERT_EQ(c.run(folder / "killed", second, true), Outcome::born);
  expect_same(folder / "killed", folder / "whole");
}

TEST(BirthRun, RefusesToResumeAnotherScenario) {
  const Folder folder("other");
  Case c;
  c.run(folder.path());
  c.scenario.numerics.drag *= 2;
  Mover mover(c.model);
  EXPECT_THROW(c.run(folder.path(), mover, true), InputError);
  c.scenario.numerics.drag /= 2;
  c.model.mesh.nodes[0].x() += 1e-9;
  EXPECT_THROW(c.run(folder.path(), mover, true), InputError);
}

TEST(BirthRun, ANumericalFailureKeepsTheLastGoodState) {
  const Folder folder("failure");
  Case c;
  Mover mover(c.model, 0.4, 300);
  EXPECT_EQ(c.run(folder.path(), mover), Outcome::failed);
  const auto j = nlohmann::json::parse(read_text(folder / "summary.json"));
  EXPECT_EQ(j["outcome"], "failed");
  EXPECT_EQ(j["reason"], "inversion of element 7 (skull)");
  EXPECT_EQ(read_checkpoint(folder / "checkpoint.h5").state.time, mover.state().time);
  EXPECT_NE(read_text(folder / "frames.pvd").find(fmt::format("timestep=\"{}\"", mover.state().time)),
            std::string::npos);
}

TEST(BirthRun, AFreshRunReplacesTheOld) {
  const Folder folder("fresh");
  Case c;
  c.run(folder.path());
  const auto before = contents(folder.path());
  std::ofstream(folder / "frames/frame_9999.vtu") << "old";
  c.run(folder.path());
  EXPECT_TRUE(contents(folder.path()) == before);
}

TEST(Schedule, HoldsOutputsPeaksAndStartsAndStopsOften) {
  const auto s = test::quick_scenario();
  const auto stops = schedule_of(s);
  EXPECT_EQ(stops.front().time, 0);
  EXPECT_EQ(stops.back().time, s.numerics.labour_duration);
  int frames = 0, rows = 0;
  for (std::size_t i = 0; i < stops.size(); ++i) {
    frames += stops[i].frame, rows += stops[i].row;
    if (i > 0) {
      EXPECT_GT(stops[i].time, stops[i - 1].time);
      EXPECT_LE(stops[i].time - stops[i - 1].time, 4 + 1e-9);
    }
  }
  EXPECT_EQ(frames, 9);
  const auto has_row = [&](double t) {
    return std::any_of(stops.begin(), stops.end(), [=](const Stop& p) { return p.row && std::abs(p.time - t) < 0.1; });
  };
  const auto& c = s.loads.contractions;
  EXPECT_TRUE(has_row(c.first));
  EXPECT_TRUE(has_row(c.first + c.period + c.duration - c.fall));
}

}  // namespace
}  // namespace carus::results
