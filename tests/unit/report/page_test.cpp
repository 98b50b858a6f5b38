// SPDX-License-Identifier: Apache-2.0
#include "carus/report/page.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "carus/report/manifest.hpp"
#include "small_run.hpp"

namespace carus::report {
namespace {

using testing::HasSubstr;
using testing::Not;

const std::string viewer = "<html><body><p>v</p><!--CARUS-DATA--></body></html>";

TEST(Page, HoldsManifestAndBlobsWhereTheCommentWas) {
  const auto html = page(viewer, R"({"a":1})", {"foo", ""});
  EXPECT_EQ(html,
            "<html><body><p>v</p><script id=\"carus-manifest\" type=\"application/json\">{\"a\":1}</script>\n"
            "<script id=\"carus-blob-0\" type=\"text/plain\">Zm9v</script>\n"
            "<script id=\"carus-blob-1\" type=\"text/plain\"></script>\n</body></html>");
}

TEST(Page, NeedsTheCommentOnce) {
  EXPECT_THAT(test::error_of([] { page("<html></html>", "{}", {}); }), HasSubstr("./dev build"));
  EXPECT_NE(test::error_of([] { page(viewer + viewer, "{}", {}); }), "");
}

TEST(ForScript, EscapesAllThatCouldEndAScriptAndMeansTheSame) {
  const nlohmann::json hostile = {
      {"</script><script>alert(1)</script>", "<!-- <script> & \xE2\x80\xA8 \xE2\x80\xA9 \xE2\x80\xA7 \" \\ ä"}};
  const auto safe = for_script(hostile.dump());
  for (const char* bad : {"<", ">", "&", "\xE2\x80\xA8", "\xE2\x80\xA9"}) EXPECT_THAT(safe, Not(HasSubstr(bad)));
  EXPECT_EQ(nlohmann::json::parse(safe), hostile);
}

/// Texts of a folder that try to be markup, in every file that holds any.
TEST(Report, TextInFilesNeverBecomesMarkup) {
  const test::Folder folder("report_hostile_text");
  test::write_small_run(folder / "run");
  const std::string bad = "</script><img src=x onerror=alert(1)><!--CARUS-DATA-->";
  const auto dir = folder / "run";
  test::set_text(dir / "log.txt", bad + "\xff\xfe not UTF-8");
  auto yaml = test::text_of(dir / "scenario.resolved.yaml");
  const auto at = yaml.find("description: ");
  ASSERT_NE(at, std::string::npos);
  yaml.replace(at, yaml.find('\n', at) - at, "description: \"" + bad + "\"");
  test::set_text(dir / "scenario.resolved.yaml", yaml);
  test::set_text(dir / "events.jsonl", "{\"time_s\": 1, \"event\": \"" + bad + "\"}\n");
  auto summary = nlohmann::json::parse(test::text_of(dir / "summary.json"));
  summary["version"] = bad, summary["declared"][bad] = bad;
  test::set_text(dir / "summary.json", summary.dump());

  const std::vector<report::Run> runs = {read_run(dir)};
  const auto manifest = manifest_of(runs, {});
  EXPECT_THAT(manifest.json, HasSubstr("onerror")) << "the texts are there";
  const auto html = page(viewer, manifest.json, {});
  EXPECT_THAT(html, Not(HasSubstr("<img")));
  std::size_t ends = 0;
  for (auto p = html.find("</script"); p != std::string::npos; p = html.find("</script", p + 1)) ++ends;
  EXPECT_EQ(ends, 1u) << "the manifest's own";
  const auto begin = html.find('{');
  const auto j = nlohmann::json::parse(html.substr(begin, html.find("</script") - begin));
  EXPECT_EQ(j["runs"][0]["description"], bad);
  EXPECT_EQ(j["runs"][0]["events"][0]["event"], bad);
  EXPECT_THAT(j["runs"][0]["log"].get<std::string>(), testing::StartsWith(bad));
}

}  // namespace
}  // namespace carus::report
