// SPDX-License-Identifier: Apache-2.0
#include "carus/results/files.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <fstream>
#include <limits>

#include "carus/results/checkpoint.hpp"
#include "carus/results/curves.hpp"
#include "carus/results/events.hpp"
#include "mover.hpp"

namespace carus::results {
namespace {

using test::Folder;

std::string message_of(const std::function<void()>& f) {
  try {
    f();
  } catch (const InputError& e) {
    return e.what();
  }
  return "(accepted)";
}

TEST(Curves, ReadBackToTheSameBits) {
  const Folder folder("curves_bits");
  const observe::Values row{0.1, 1.0 / 3, -1e-300, std::nextafter(2.0, 3.0), 1e22, 0.0};
  Curves curves(folder / "c.csv", {"a", "b", "c", "d", "e", "f"});
  curves.append(row);
  EXPECT_EQ(read_curves(folder / "c.csv").rows.at(0), row);
}

TEST(Curves, ATornLineIsLeftOutAndRowsAfterTheCheckpointDropped) {
  const Folder folder("curves_torn");
  {
    Curves curves(folder / "c.csv", {"time_s", "z_mm"});
    for (int i = 0; i < 5; ++i) curves.append({double(i), -0.1 * i});
  }
  std::ofstream(folder / "c.csv", std::ios::app) << "5,-0.";  // killed here
  EXPECT_EQ(read_curves(folder / "c.csv").rows.size(), 5u);
  Curves resumed(folder / "c.csv", {"time_s", "z_mm"}, 3);
  resumed.append({3, 7});
  const auto table = read_curves(folder / "c.csv");
  ASSERT_EQ(table.rows.size(), 4u);
  EXPECT_EQ(table.rows[3], (observe::Values{3, 7}));
}

TEST(Curves, RefuseOtherColumnsAndMissingRows) {
  const Folder folder("curves_refuse");
  { Curves curves(folder / "c.csv", {"time_s"}); }
  const auto file = (folder / "c.csv").string();
  EXPECT_EQ(message_of([&] { Curves(folder / "c.csv", {"t"}, 0); }),
            file + ": columns are not those of this version of carus; run again without --resume");
  EXPECT_EQ(message_of([&] { Curves(folder / "c.csv", {"time_s"}, 2); }),
            file + ": has 1 whole lines; the checkpoint knows of 3; the folder was changed since");
}

TEST(WriteAtomically, AFailureLeavesTheOldFile) {
  const Folder folder("atomic");
  write_atomically(folder / "f", "old");
  EXPECT_THROW(write_atomically(folder / "f",
                                [](const std::filesystem::path& t) {
                                  std::ofstream(t) << "half";
                                  throw std::runtime_error("killed");
                                }),
               std::runtime_error);
  EXPECT_EQ(read_text(folder / "f"), "old");
}

Checkpoint sample() {
  Checkpoint c;
  c.state.time = 1.0 / 3, c.state.step = 123456789012;
  c.state.x = {{0.1, 0.2, 0.3}, {std::nextafter(1.0, 2.0), -0.0, 5e-324}};
  c.state.v = {{1, 2, 3}, {4, 5, 6}};
  c.state.hinge_angle = {0.07}, c.state.hinge_rate = {-1e-9};
  c.state.internal = {1e-17, std::numeric_limits<double>::max()};
  c.scenario_hash = "aaaa", c.mesh_hash = "bbbb", c.version = "0.1.0";
  c.rows = 7, c.stops = 9, c.events = 2;
  c.frame_times = {0, 7.7}, c.wall = {1, 2, 3};
  return c;
}

TEST(CheckpointFile, RoundTripsBitForBit) {
  const Folder folder("checkpoint");
  const auto c = sample();
  write_checkpoint(folder / "checkpoint.h5", c);
  const auto d = read_checkpoint(folder / "checkpoint.h5");
  const auto same = [](const std::vector<Vec3>& a, const std::vector<Vec3>& b) {
    return a.size() == b.size() && std::memcmp(a.data(), b.data(), a.size() * sizeof(Vec3)) == 0;
  };
  EXPECT_TRUE(same(c.state.x, d.state.x));
  EXPECT_TRUE(same(c.state.v, d.state.v));
  EXPECT_EQ(c.state.time, d.state.time);
  EXPECT_EQ(c.state.step, d.state.step);
  EXPECT_EQ(c.state.hinge_angle, d.state.hinge_angle);
  EXPECT_EQ(c.state.hinge_rate, d.state.hinge_rate);
  EXPECT_EQ(c.state.rest_length, d.state.rest_length);  // empty
  EXPECT_EQ(c.state.internal, d.state.internal);
  EXPECT_EQ(c.frame_times, d.frame_times);
  EXPECT_EQ(c.wall, d.wall);
  EXPECT_EQ(c.version, d.version);
  EXPECT_EQ(std::tie(c.rows, c.stops, c.events), std::tie(d.rows, d.stops, d.events));
}

TEST(CheckpointFile, RefusesWhatIsNotItsOwn) {
  const Folder folder("foreign");
  const auto file = folder / "checkpoint.h5";
  EXPECT_EQ(message_of([&] { read_checkpoint(file); }),
            file.string() + ": no such file; nothing to resume; run without --resume to start");
  std::ofstream(file) << "not HDF5";
  EXPECT_EQ(message_of([&] { read_checkpoint(file); }),
            file.string() + ": cannot be read; it is not a checkpoint of carus");
  const auto c = sample();
  EXPECT_EQ(message_of([&] { refuse_foreign(file, c, "aaab", "bbbb"); }),
            file.string() +
                ": was written for another scenario (aaaa against aaab); resume with the one in "
                "scenario.resolved.yaml, or run without --resume");
  EXPECT_EQ(message_of([&] { refuse_foreign(file, c, "aaaa", "cccc"); }),
            file.string() +
                ": was written for another mesh (bbbb against cccc); resume with the one in scenario.resolved.yaml, or "
                "run without --resume");
  EXPECT_EQ(message_of([&] { refuse_foreign(file, c, "aaaa", "bbbb"); }), "(accepted)");
}

TEST(ScenarioHash, IgnoresThreadsAndNothingElse) {
  auto s = test::quick_scenario();
  const auto hash = hash_of(s);
  s.numerics.threads = 3;
  EXPECT_EQ(hash_of(s), hash);
  s.anatomy.canal.radius *= 1.01;
  EXPECT_NE(hash_of(s), hash);
}

TEST(Events, AreLinesOfJsonThatCanBeCutBack) {
  const Folder folder("events");
  {
    Events events(folder / "e.jsonl");
    events.add(1, "contraction", "\"number\": 1");
    events.add(2, "engagement");
  }
  Events resumed(folder / "e.jsonl", 1);
  resumed.add(3, "birth");
  EXPECT_EQ(
      read_text(folder / "e.jsonl"),
      "{\"time_s\": 1.000, \"event\": \"contraction\", \"number\": 1}\n{\"time_s\": 3.000, \"event\": \"birth\"}\n");
}

}  // namespace
}  // namespace carus::results
