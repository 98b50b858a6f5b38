// SPDX-License-Identifier: Apache-2.0
#include "carus/report/server.hpp"

#include <arpa/inet.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/socket.h>
#include <unistd.h>

#include <nlohmann/json.hpp>
#include <thread>

#include "small_run.hpp"

namespace carus::report {
namespace {

namespace fs = std::filesystem;
using testing::HasSubstr;
using testing::Not;
using testing::StartsWith;

/// A results folder served on a free port, and a client that says whatever it likes.
class Served : public testing::Test {
 protected:
  Served() {
    test::write_small_run(dir);
    site = std::make_unique<Site>("<html><!--CARUS-DATA--></html>", std::vector<fs::path>{dir}, ManifestOptions{});
    server = std::make_unique<Server>(*site, "127.0.0.1", 0);
    thread = std::thread([this] { server->run(); });
  }
  ~Served() override {
    server->stop();
    thread.join();
  }
  /// All that comes back until the other side closes.
  std::string say(const std::string& words) const {
    const int s = socket(AF_INET, SOCK_STREAM, 0);
    sockaddr_in to{};
    to.sin_family = AF_INET, to.sin_port = htons(server->port()), to.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
    EXPECT_EQ(connect(s, reinterpret_cast<const sockaddr*>(&to), sizeof to), 0);
    const timeval patience{10, 0};
    setsockopt(s, SOL_SOCKET, SO_RCVTIMEO, &patience, sizeof patience);
    EXPECT_GT(send(s, words.data(), words.size(), MSG_NOSIGNAL), 0);  // it may hang up before the end
    std::string answer;
    char part[4096];
    for (ssize_t n; (n = recv(s, part, sizeof part, 0)) > 0;) answer.append(part, std::size_t(n));
    close(s);
    return answer;
  }
  std::string request(const std::string& line, const std::string& host = "localhost") const {
    return say(line + " HTTP/1.1\r\nHost: " + host + "\r\nConnection: close\r\n\r\n");
  }
  static std::string body(const std::string& answer) { return answer.substr(answer.find("\r\n\r\n") + 4); }

  test::Folder folder{std::string("report_server_") + testing::UnitTest::GetInstance()->current_test_info()->name()};
  fs::path dir = folder / "run";
  std::unique_ptr<Site> site;
  std::unique_ptr<Server> server;
  std::thread thread;
};

TEST_F(Served, PageManifestAndEachBlob) {
  const auto html = request("GET /");
  EXPECT_THAT(html, StartsWith("HTTP/1.1 200"));
  EXPECT_THAT(html, HasSubstr("carus-manifest"));
  EXPECT_THAT(html, Not(HasSubstr("carus-blob-0"))) << "blobs are fetched";
  const auto j = nlohmann::json::parse(body(request("GET /manifest.json?again=1")));
  EXPECT_EQ(j["format"], "carus-report-1");
  EXPECT_TRUE(j["live"].is_null());
  ASSERT_GT(j["blobs"].size(), 4u);
  for (const auto& b : j["blobs"]) {
    const auto bytes = body(request("GET /" + b["src"].get<std::string>()));
    EXPECT_EQ(bytes.size(), b["bytes"].get<std::size_t>());
    EXPECT_EQ(inflate(bytes, b["raw"].get<std::size_t>()).size(), b["raw"].get<std::size_t>());
  }
}

TEST_F(Served, HeadTellsTheLengthAndSendsNothing) {
  const auto get = request("GET /manifest.json"), head = request("HEAD /manifest.json");
  EXPECT_THAT(head, StartsWith("HTTP/1.1 200"));
  EXPECT_EQ(body(head), "");
  EXPECT_THAT(head, HasSubstr("Content-Length: " + std::to_string(body(get).size())));
}

TEST_F(Served, NothingElseHasAnAddress) {
  for (const char* path :
       {"/../../../../etc/passwd", "/%2e%2e/%2e%2e/etc/passwd", "/data/../curves.csv", "/curves.csv", "//etc/passwd",
        "/data/", "/data/0", "/data//etc/passwd", "/log.txt", "/index.html/x", "http://elsewhere/x"}) {
    EXPECT_THAT(request(std::string("GET ") + path), StartsWith("HTTP/1.1 404")) << path;
  }
}

TEST_F(Served, OnlyGetAndHead) {
  for (const char* method : {"POST", "PUT", "DELETE", "OPTIONS", "TRACE", "CONNECT", "PATCH"}) {
    const auto answer = request(std::string(method) + " /");
    EXPECT_THAT(answer, StartsWith("HTTP/1.1 405")) << method;
    EXPECT_THAT(answer, HasSubstr("Allow: GET, HEAD"));
  }
}

TEST_F(Served, AnotherHostNameIsRefused) {
  EXPECT_THAT(request("GET /", "evil.example"), StartsWith("HTTP/1.1 403"));
  EXPECT_THAT(request("GET /", "localhost.evil.example"), StartsWith("HTTP/1.1 403"));
  EXPECT_THAT(request("GET /", "127.0.0.1:8321"), StartsWith("HTTP/1.1 200"));
}

TEST_F(Served, NonsenseIsHungUpOnAndTheNextIsServed) {
  for (const std::string& nonsense :
       {std::string("\r\n\r\n\r\n"), std::string("GET\r\n\r\n"), std::string(200000, 'A') + "\r\n\r\n",
        std::string("GET / HTTP/9.9\r\n\r\n"), std::string("\x16\x03\x01\x02\0\x01", 6) + "\r\n\r\n",
        "GET / HTTP/1.1\r\nHost: localhost\r\nX: " + std::string(100000, 'x') + "\r\n\r\n",
        std::string("POST / HTTP/1.1\r\nHost: localhost\r\nContent-Length: 99999999999\r\n\r\nx")}) {
    EXPECT_THAT(say(nonsense), Not(HasSubstr("200 OK")));
    EXPECT_THAT(request("GET /"), StartsWith("HTTP/1.1 200"));
  }
}

TEST_F(Served, ARunInProgressIsFollowed) {
  const auto summary = test::text_of(dir / "summary.json"), curves = test::text_of(dir / "curves.csv");
  fs::remove(dir / "summary.json");
  auto cut = curves.substr(0, curves.size() / 2);
  test::set_text(dir / "curves.csv", cut);
  const auto get = [&] { return nlohmann::json::parse(body(request("GET /manifest.json"))); };
  auto j = get();
  EXPECT_EQ(j["runs"][0]["status"], "in_progress");
  EXPECT_EQ(j["live"]["src"], "manifest.json");
  const auto rows = j["runs"][0]["curves"]["rows"].get<int>();
  test::set_text(dir / "curves.csv", curves);
  j = get();
  EXPECT_GT(j["runs"][0]["curves"]["rows"].get<int>(), rows);
  test::set_text(dir / "summary.json", summary);
  j = get();
  EXPECT_EQ(j["runs"][0]["status"], "finished");
  EXPECT_TRUE(j["live"].is_null());
  fs::remove_all(dir);
  EXPECT_THAT(request("GET /"), StartsWith("HTTP/1.1 503"));
}

TEST_F(Served, ATakenPortAndABadAddressAreNamed) {
  EXPECT_THAT(test::error_of([&] { Server(*site, "127.0.0.1", server->port()); }), HasSubstr("--port"));
  EXPECT_THAT(test::error_of([&] { Server(*site, "localhost.", 0); }), HasSubstr("--address"));
}

}  // namespace
}  // namespace carus::report
