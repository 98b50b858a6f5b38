// SPDX-License-Identifier: Apache-2.0
#include "carus/report/folder.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "carus/report/manifest.hpp"
#include "small_run.hpp"

namespace carus::report {
namespace {

namespace fs = std::filesystem;
using testing::Contains;
using testing::HasSubstr;

/// A small run whose files each test spoils.
class ResultsFolder : public testing::Test {
 protected:
  ResultsFolder() { test::write_small_run(dir); }
  std::string error() const {
    return test::error_of([&] { read_folder(dir); });
  }
  test::Folder folder{std::string("report_folder_") + testing::UnitTest::GetInstance()->current_test_info()->name()};
  fs::path dir = folder / "run";
};

TEST_F(ResultsFolder, IsReadWhole) {
  const auto f = read_folder(dir);
  EXPECT_EQ(f.status, RunStatus::finished);
  EXPECT_EQ(f.name(), "test");
  EXPECT_THAT(f.notes, testing::IsEmpty());
  EXPECT_TRUE(f.scenario);
  EXPECT_GT(f.curves.rows.size(), 10u);
  EXPECT_GT(f.events.size(), 2u);
}

TEST_F(ResultsFolder, ThatIsMissingOrForeignIsRefused) {
  EXPECT_THAT(test::error_of([&] { read_folder(folder / "none"); }), HasSubstr("no such folder"));
  EXPECT_THAT(test::error_of([&] { read_folder(dir / "curves.csv"); }), HasSubstr("is no folder"));
  fs::create_directories(folder / "foreign");
  test::set_text(folder / "foreign" / "readme.txt", "hello");
  EXPECT_THAT(test::error_of([&] { read_folder(folder / "foreign"); }), HasSubstr("no results folder of carus"));
}

TEST_F(ResultsFolder, WithoutOutputsYetSaysSo) {
  fs::remove(dir / "curves.csv");
  EXPECT_THAT(error(), HasSubstr("has not come to its first output"));
  test::set_text(dir / "curves.csv", "time_s,head_z_mm\n");
  EXPECT_THAT(error(), HasSubstr("holds no outputs yet"));
}

TEST_F(ResultsFolder, WithSpoiltCurvesIsRefusedWithLineAndValue) {
  test::set_text(dir / "curves.csv", "");
  EXPECT_NE(error(), "");
  test::set_text(dir / "curves.csv", "a,b\n1,2\n");
  EXPECT_THAT(error(), HasSubstr("first column is not time_s"));
  test::set_text(dir / "curves.csv", "time_s,head_z_mm\n0,1\n1,2,3\n");
  EXPECT_THAT(error(), HasSubstr("line 3 has 3 values"));
  test::set_text(dir / "curves.csv", "time_s,head_z_mm\n0,1\n1,<b>x\n");
  EXPECT_THAT(error(), HasSubstr("line 3: head_z_mm: \"<b>x\""));
  test::set_text(dir / "curves.csv", "time_s,head_z_mm\n0,1\n0,2\n");
  EXPECT_THAT(error(), HasSubstr("line 3: time_s: 0"));
  test::set_text(dir / "curves.csv", "time_s,head_z_mm\nnan,1\n");
  EXPECT_THAT(error(), HasSubstr("line 2: time_s: nan"));
  test::set_text(dir / "curves.csv", std::string("\x89PNG\r\n\x1a\n\0\0\0", 11));
  EXPECT_NE(error(), "");
}

TEST_F(ResultsFolder, ATornLastLineOfARunInProgressIsLeftOut) {
  fs::remove(dir / "summary.json");
  const auto rows = read_folder(dir).curves.rows.size();
  auto text = test::text_of(dir / "curves.csv");
  test::set_text(dir / "curves.csv", text + "1999.5,12.");
  const auto f = read_folder(dir);
  EXPECT_EQ(f.curves.rows.size(), rows);
  EXPECT_EQ(f.status, RunStatus::in_progress);
  EXPECT_THAT(f.notes, Contains(HasSubstr("in progress, or was interrupted")));
}

TEST_F(ResultsFolder, WhatElseIsSpoiltBecomesANote) {
  test::set_text(dir / "summary.json", "{\"outcome\": \"born\", ");
  test::set_text(dir / "scenario.resolved.yaml", "pelvis: [1, 2\n");
  test::set_text(dir / "events.jsonl", "{\"time_s\": 1, \"event\": \"spines\"}\nnonsense\n[1]\n{\"time_s\": 2, \"eve");
  test::set_text(dir / "log.txt", std::string(200000, 'x') + "\nlast\n");
  const auto f = read_folder(dir);
  EXPECT_THAT(f.notes, Contains(HasSubstr("summary.json: is damaged")));
  EXPECT_THAT(f.notes, Contains(HasSubstr("not a scenario of this version")));
  EXPECT_THAT(f.notes, Contains(HasSubstr("events.jsonl: line 2 is no event")));
  EXPECT_THAT(f.notes, Contains(HasSubstr("events.jsonl: line 3 is no event")));
  EXPECT_EQ(f.events.size(), 1u);
  EXPECT_EQ(f.status, RunStatus::failed);
  EXPECT_EQ(f.name(), "run") << "the folder's, without a scenario";
  EXPECT_LT(f.log.size(), 70000u);
  EXPECT_THAT(f.log, testing::EndsWith("last\n"));
  // And a report of it is still made.
  const std::vector<report::Run> runs = {read_run(dir)};
  EXPECT_THAT(runs[0].verdict.line, testing::StartsWith("NOT JUDGED"));
  EXPECT_NE(manifest_of(runs, {}).json, "");
}

TEST_F(ResultsFolder, ASummaryOfAnotherFormIsNotTrusted) {
  test::set_text(dir / "summary.json",
                 R"({"outcome": 7, "numerics": [1], "declared": "x", "calibrated": [1, {"key": 2}], "wall_s": null})");
  const std::vector<report::Run> runs = {read_run(dir)};
  EXPECT_EQ(runs[0].folder.status, RunStatus::failed);
  EXPECT_NE(manifest_of(runs, {}).json, "");
}

TEST_F(ResultsFolder, JsonNestedWithoutEndIsNoneOfOurs) {
  const std::size_t deep = 1000000;
  test::set_text(dir / "summary.json", "{\"a\":" + std::string(deep, '[') + std::string(deep, ']') + "}");
  test::set_text(dir / "events.jsonl", "{\"time_s\":1,\"event\":\"a]}\\\"\",\"x\":" + std::string(deep, '[') +
                                           std::string(deep, ']') + "}\n{\"time_s\": 1, \"event\": \"[[[[\"}\n");
  const auto f = read_folder(dir);
  EXPECT_THAT(f.notes, Contains(HasSubstr("summary.json: is damaged")));
  EXPECT_EQ(f.events.size(), 1u) << "brackets in a text are no nesting";
}

}  // namespace
}  // namespace carus::report
