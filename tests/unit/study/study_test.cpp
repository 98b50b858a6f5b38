// SPDX-License-Identifier: Apache-2.0
#include "carus/study/study.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <fstream>
#include <nlohmann/json.hpp>

#include "../results/mover.hpp"
#include "carus/results/files.hpp"

namespace carus::study {
namespace {

namespace fs = std::filesystem;

TEST(Difference, IsTheLargestAtCommonPeaksRelativeToTheBase) {
  EXPECT_DOUBLE_EQ(*largest_difference_percent({10, 50, 100}, {11, 49, 130}), 30);
  EXPECT_DOUBLE_EQ(*largest_difference_percent({10, 50}, {11, 49, 130}), 10);  // the third has no counterpart
  EXPECT_DOUBLE_EQ(*largest_difference_percent({10, 50, 100}, {12}), 20);
  EXPECT_DOUBLE_EQ(*largest_difference_percent({10, 50}, {10, 50}), 0);
}

TEST(Difference, NeedsSomethingToBeRelativeTo) {
  EXPECT_FALSE(largest_difference_percent({}, {1, 2}));
  EXPECT_FALSE(largest_difference_percent({0.5, -0.2}, {1, 2}));
  EXPECT_DOUBLE_EQ(*largest_difference_percent({0.5, 20}, {5, 21}), 5);
  EXPECT_DOUBLE_EQ(*largest_difference_percent({NAN, 20}, {5, 21}), 5);
  EXPECT_DOUBLE_EQ(*largest_difference_percent({-10}, {-11}), 10);
}

/// Births by a stand-in for the solver whose pace the drag's factor decides.
struct Births {
  fem::Model model = test::fetus_of_boxes();
  observe::Setup setup = test::setup_of_boxes();
  std::vector<std::string> ran;
  std::atomic<bool> stop{false};
  double stop_at = 1e9;

  Options options(const fs::path& out) {
    Options o;
    o.out = out, o.scenario = "s.yaml", o.variants = "v.yaml", o.version = "test", o.commit = "abc";
    o.run = [this](const scenario::Scenario& s, const fs::path& folder, bool resume) {
      ran.push_back(folder.filename().string() + (resume ? " resumed" : ""));
      if (s.numerics.drag_factor > 50) throw InputError("anatomy: does not fit");
      test::Mover mover(model, 0.4 / s.numerics.drag_factor, s.numerics.drag_factor == 7 ? 300 : 1e9);
      mover.on_advance = [this](double t) { stop = stop || t > stop_at; };
      results::RunOptions r;
      r.out = folder, r.resume = resume, r.version = "test", r.commit = "abc", r.stop = &stop;
      setup.contractions = s.loads.contractions;
      results::prepare_folder(folder, resume);
      return results::run_birth(s, model, setup, mover, r);
    };
    return o;
  }
};

std::vector<Row> rows() {
  const std::string quick = "output: {frames: 0, curve_interval: 60 s}\n";
  const auto row = [&](const std::string& name, const std::string& factor) {
    return Row{name,
               {"numerics.drag_factor=" + factor},
               scenario::parse(quick, "test.yaml", {"numerics.drag_factor=" + factor}),
               {}};
  };
  std::vector<Row> all{row("base", "1"), row("slow", "2"), row("fails", "7"), row("misfit", "60"), row("again", "2")};
  all.back().same_as = "slow";
  return all;
}

TEST(Study, MakesOneTableOfAllRows) {
  const test::Folder folder("study");
  Births births;
  std::vector<std::string> told;
  auto o = births.options(folder.path());
  o.tell = [&](const std::string& line) { told.push_back(line); };
  const auto table = run(rows(), o);
  EXPECT_EQ(births.ran, (std::vector<std::string>{"base", "slow", "fails", "misfit"}));
  ASSERT_EQ(table.entries.size(), 5u);
  const auto& [base, slow, fails, misfit, again] =
      std::tie(table.entries[0], table.entries[1], table.entries[2], table.entries[3], table.entries[4]);
  EXPECT_EQ(base.measures.outcome, "born");
  EXPECT_FALSE(base.difference);
  ASSERT_FALSE(base.measures.peaks.empty());
  // 0.18 m at 0.4 m in 1920 s; peaks are at 90 s + 240 s k: those before 864 s.
  EXPECT_EQ(base.measures.peaks.size(), 4u);
  EXPECT_NEAR(*base.measures.birth_time, 864, 60);
  EXPECT_NEAR(*slow.difference, 50, 1);
  EXPECT_EQ(fails.measures.outcome, "failed");
  EXPECT_EQ(misfit.measures.outcome, "refused");
  EXPECT_EQ(misfit.measures.reason, "anatomy: does not fit");
  EXPECT_EQ(again.measures.peaks, slow.measures.peaks);
  ASSERT_EQ(told.size(), 5u);
  EXPECT_EQ(told[0].find("[1/5] base: born in contraction 4 at 14."), 0u) << told[0];
  EXPECT_EQ(told[3], "[4/5] misfit: refused: anatomy: does not fit");

  const auto j = nlohmann::json::parse(results::read_text(folder / "study.json"));
  ASSERT_EQ(j.at("rows").size(), 5u);
  EXPECT_TRUE(j.at("rows")[0].at("difference_percent").is_null());
  EXPECT_NEAR(j.at("rows")[1].at("difference_percent").get<double>(), 50, 1);
  EXPECT_EQ(j.at("rows")[3].at("reason"), "anatomy: does not fit");
  EXPECT_EQ(j.at("rows")[4].at("same_as"), "slow");
  const auto text = results::read_text(folder / "study.md");
  // Every line of the table has as many cells as its head.
  std::istringstream lines(text);
  int in_table = 0;
  for (std::string line; std::getline(lines, line);) {
    if (!line.starts_with("|")) continue;
    ++in_table;
    EXPECT_EQ(std::count(line.begin(), line.end(), '|'), 16) << line;
  }
  EXPECT_EQ(in_table, 7);
}

TEST(Study, KeepsWhatIsCompleteAndGoesOnWithTheRest) {
  const test::Folder folder("study_resume");
  Births births;
  births.stop_at = 500;
  auto table = run(rows(), births.options(folder.path()));
  EXPECT_TRUE(table.interrupted);
  EXPECT_TRUE(table.entries.empty());
  births.stop = false, births.stop_at = 1e9;
  table = run(rows(), births.options(folder.path()));
  EXPECT_FALSE(table.interrupted);
  births.ran.clear();
  table = run(rows(), births.options(folder.path()));
  EXPECT_EQ(births.ran, std::vector<std::string>{"misfit"});  // nothing of it can be kept
  EXPECT_TRUE(table.entries[0].kept);
  // A row whose scenario has changed is run again, afresh.
  auto changed = rows();
  changed[1].scenario.numerics.drag_factor = 1.5;
  births.ran.clear();
  table = run(changed, births.options(folder.path()));
  EXPECT_EQ(births.ran, (std::vector<std::string>{"slow", "misfit"}));
  EXPECT_NEAR(*table.entries[1].difference, 33, 1);
}

TEST(Study, AnInterruptedRowGoesOnFromItsCheckpoint) {
  const test::Folder folder("study_checkpoint");
  Births births;
  births.stop_at = 500;
  run(rows(), births.options(folder.path()));
  births.stop = false, births.stop_at = 1e9;
  births.ran.clear();
  run(rows(), births.options(folder.path()));
  EXPECT_EQ(births.ran.front(), "base resumed");
  // Of another build: from the start.
  fs::remove(folder / "base/summary.json");
  auto o = births.options(folder.path());
  o.commit = "def";
  births.ran.clear();
  run(rows(), o);
  EXPECT_EQ(births.ran.front(), "base");
}

TEST(Study, ADamagedSummaryIsRefusedByName) {
  const test::Folder folder("study_damaged");
  Births births;
  run(rows(), births.options(folder.path()));
  std::ofstream(folder / "base/summary.json") << "{\"outcome\": \"born\"}";
  const auto table = run(rows(), births.options(folder.path()));
  EXPECT_EQ(table.entries[0].measures.outcome, "refused");
  EXPECT_EQ(table.entries[0].measures.reason.find((folder / "base/summary.json").string() + ": not a summary"), 0u);
}

}  // namespace
}  // namespace carus::study
