// SPDX-License-Identifier: Apache-2.0
// carus report, export and serve on a real run, as their users call them.
#include <arpa/inet.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/socket.h>

#include <chrono>
#include <csignal>
#include <nlohmann/json.hpp>
#include <thread>

#include "program.hpp"

namespace {

using namespace carus::test;
using testing::HasSubstr;
using testing::Not;

/// Where the viewer is not built, a page that only has the place for the data: what is tested is what the program puts
/// there.
std::vector<std::string> with_viewer(std::vector<std::string> arguments) {
  const fs::path viewer = fresh("viewer.html");
  std::ofstream(viewer) << "<!doctype html><title>x</title><!--CARUS-DATA-->\n";
  arguments.insert(arguments.end(), {"--viewer", viewer.string()});
  return arguments;
}

/// 90 s of the reference birth, made once.
const fs::path& run() {
  static const fs::path out = [] {
    fs::path dir = fresh("reported");
    const int status = wait_for(start(short_labour(dir), dir.string() + ".log"));
    EXPECT_EQ(status, 0) << text(dir.string() + ".log");
    return dir;
  }();
  return out;
}

nlohmann::json manifest_in(const std::string& html) {
  const std::string open = "<script id=\"carus-manifest\" type=\"application/json\">";
  const auto begin = html.find(open) + open.size();
  return nlohmann::json::parse(html.substr(begin, html.find("</script>", begin) - begin));
}

void writes_one_page() {
  const fs::path log = run().string() + ".report.log";
  ASSERT_EQ(wait_for(start(with_viewer({"report", run().string()}), log)), 0) << text(log);
  const auto html = text(run() / "report.html");
  const auto j = manifest_in(html);
  const auto& r = j.at("runs").at(0);
  EXPECT_EQ(r.at("status"), "finished");
  EXPECT_EQ(r.at("notes").size(), 0u) << r.at("notes");
  EXPECT_GT(r.at("mesh").at("tets").get<int>(), 15000);
  EXPECT_GE(r.at("frames").at("times_s").size(), 15u);
  EXPECT_EQ(r.at("plots").size(), 20u);
  for (std::size_t i = 0; i < j.at("blobs").size(); ++i)
    EXPECT_THAT(html, HasSubstr("carus-blob-" + std::to_string(i) + "\""));
  // Its scale: a 200-frame birth must stay below 25 MB (about 0.1 MB a frame on this mesh).
  EXPECT_LT(html.size(), 4e6);
  EXPECT_FALSE(fs::exists(run() / "report.html.tmp"));
  // The same rows as in the summary.
  const auto s = nlohmann::json::parse(text(run() / "summary.json"));
  const auto& rows = r.at("verdict").at("rows");
  ASSERT_EQ(rows.size(), s.at("validation").size() + s.at("bands").size());
  for (std::size_t i = 0; i < rows.size(); ++i) {
    const auto n = s.at("validation").size();
    const auto& line = i < n ? s.at("validation").at(i) : s.at("bands").at(i - n);
    EXPECT_EQ(rows[i].at("what"), line.at("what"));
    EXPECT_EQ(rows[i].at("obtained"), line.at("obtained"));
    EXPECT_EQ(rows[i].at("state") == "inside", line.at("inside").get<bool>() && line.at("asked").get<bool>());
  }
}

void puts_runs_side_by_side() {
  const fs::path log = run().string() + ".report.log", copy = fresh("reported_copy"), out = fresh("both.html");
  fs::copy(run(), copy, fs::copy_options::recursive);
  ASSERT_EQ(wait_for(start(
                with_viewer({"report", run().string(), copy.string(), "--ghost", copy.string(), "--out", out.string()}),
                log)),
            0)
      << text(log);
  const auto j = manifest_in(text(out));
  ASSERT_EQ(j.at("runs").size(), 2u);
  EXPECT_EQ(j.at("ghost"), 1);
  EXPECT_NE(j.at("runs").at(0).at("name"), j.at("runs").at(1).at("name"));
  EXPECT_GT(j.at("comparison").at("rows").size(), 20u);
}

void ends_a_check_with_the_verdict() {
  const fs::path log = run().string() + ".check.log";
  EXPECT_EQ(wait_for(start({"report", run().string(), "--check"}, log)), 1) << "90 s are no birth";
  const auto said = text(log);
  EXPECT_THAT(said, HasSubstr("\nNOT MET: "));
  EXPECT_EQ(said.find('\n', said.find("\nNOT MET: ") + 1), said.size() - 1) << "it is the last line";
}

void refuses_bad_folders() {
  const fs::path log = run().string() + ".bad.log", foreign = fresh("foreign");
  fs::create_directories(foreign);
  for (const auto& bad : {fs::path("/nowhere/run"), foreign}) {
    EXPECT_EQ(wait_for(start(with_viewer({"report", bad.string(), "--out", (foreign / "report.html").string()}), log)),
              2);
    EXPECT_THAT(text(log), HasSubstr(bad.string()));
    EXPECT_EQ(wait_for(start({"report", bad.string(), "--check"}, log)), 2);
    EXPECT_EQ(wait_for(start({"export", "trajectory", bad.string()}, log)), 2);
    EXPECT_EQ(wait_for(start(with_viewer({"serve", bad.string(), "--port", "0"}), log)), 2);
  }
  EXPECT_TRUE(fs::is_empty(foreign));
  EXPECT_EQ(wait_for(start(with_viewer({"report", run().string(), "--out", "/nowhere/report.html"}), log)), 2);
  EXPECT_THAT(text(log), HasSubstr("/nowhere/report.html"));
}

void writes_a_trajectory_or_says_why_not() {
  const fs::path log = run().string() + ".export.log", out = fresh("trajectory");
  ASSERT_EQ(wait_for(start({"export", "trajectory", run().string(), "--out", out.string(), "--rate", "5"}, log)), 0)
      << text(log);
  const auto j = nlohmann::json::parse(text(out.string() + ".json"));
  EXPECT_NEAR(double(j.at("rows").size()), 451, 1);  // the run of 90 s ends within half a step of that
  EXPECT_FALSE(j.at("frame").at("head_centre_at_start_mm").is_null());
  EXPECT_LT(j.at("rows").at(450).at(4).get<double>(), -20) << "the head has gone down";
  const fs::path refused = fresh("refused");
  EXPECT_EQ(
      wait_for(start({"export", "trajectory", run().string(), "--out", refused.string(), "--max-speed", "0.01"}, log)),
      2);
  EXPECT_THAT(text(log), HasSubstr("mm/s at "));
  EXPECT_FALSE(fs::exists(refused.string() + ".csv"));
  EXPECT_EQ(wait_for(start({"export", "trajectory", run().string(), "--out", refused.string(), "--max-speed", "0.1",
                            "--slow-down"},
                           log)),
            0);
  EXPECT_GT(nlohmann::json::parse(text(refused.string() + ".json")).at("time_stretch").get<double>(), 2);
}

std::string get(int port, const std::string& path) {
  const int s = socket(AF_INET, SOCK_STREAM, 0);
  sockaddr_in to{};
  to.sin_family = AF_INET, to.sin_port = htons(std::uint16_t(port)), to.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
  std::string answer;
  if (connect(s, reinterpret_cast<const sockaddr*>(&to), sizeof to) == 0) {
    const auto line = "GET " + path + " HTTP/1.1\r\nHost: localhost\r\nConnection: close\r\n\r\n";
    EXPECT_EQ(send(s, line.data(), line.size(), MSG_NOSIGNAL), ssize_t(line.size()));
    char part[65536];
    for (ssize_t n; (n = recv(s, part, sizeof part, 0)) > 0;) answer.append(part, std::size_t(n));
  }
  close(s);
  return answer;
}

void serves_until_interrupted() {
  const fs::path log = run().string() + ".serve.log";
  const pid_t child = start(with_viewer({"serve", run().string(), "--port", "0"}), log);
  int port = 0;
  for (int i = 0; i < 600 && port == 0; ++i) {
    std::this_thread::sleep_for(std::chrono::milliseconds(50));
    const auto said = text(log);
    if (const auto at = said.find("127.0.0.1:"); at != std::string::npos) port = std::atoi(said.c_str() + at + 10);
  }
  ASSERT_NE(port, 0) << text(log);
  const auto html = get(port, "/");
  EXPECT_THAT(html, testing::StartsWith("HTTP/1.1 200"));
  const auto j = manifest_in(html);
  std::string path = "/";
  path += j.at("blobs").at(0).at("src").get<std::string>();  // GCC 12 takes "/" + string for an overlapping copy
  const auto blob = get(port, path);
  EXPECT_EQ(blob.size() - blob.find("\r\n\r\n") - 4, j.at("blobs").at(0).at("bytes").get<std::size_t>());
  EXPECT_THAT(get(port, "/../../etc/passwd"), testing::StartsWith("HTTP/1.1 404"));
  kill(child, SIGINT);
  EXPECT_EQ(wait_for(child), 0);
}

// One test, so that the run is made once.
TEST(CommandLine, ReportExportAndServeOfARealRun) {
  writes_one_page();
  puts_runs_side_by_side();
  ends_a_check_with_the_verdict();
  refuses_bad_folders();
  writes_a_trajectory_or_says_why_not();
  serves_until_interrupted();
}

}  // namespace
