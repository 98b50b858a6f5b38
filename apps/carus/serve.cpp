// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include <cstdio>
#include <filesystem>

#include "app.hpp"
#include "carus/core/error.hpp"
#include "carus/report/server.hpp"
#include "version.hpp"
#include "viewer.hpp"

namespace carus::app {
namespace {

struct ServeArguments {
  std::vector<std::string> folders;
  std::string address = "127.0.0.1", viewer;
  unsigned short port = 8321;
};

int serve(const ServeArguments& a) {
  report::ManifestOptions options;
  options.version = program_version, options.commit = program_commit;
  report::Site site(viewer_page(a.viewer), {a.folders.begin(), a.folders.end()}, options);
  report::Server server(site, a.address, a.port);
  const bool v6 = a.address.find(':') != std::string::npos;
  fmt::print("http://{}:{}/ (Ctrl-C ends)\n", v6 ? "[" + a.address + "]" : a.address, server.port());
  std::fflush(stdout);
  server.run(true);
  return done;
}

}  // namespace

void add_serve(CLI::App& app, int& status) {
  auto a = std::make_shared<ServeArguments>();
  auto* c = app.add_subcommand("serve", "Show results folders in a browser piece by piece, a run in progress too");
  c->add_option("DIR", a->folders, "Results folders of carus run; the first is the one shown")->required();
  c->add_option("--port", a->port, "0 takes a free one")->capture_default_str();
  c->add_option("--address", a->address, "To listen at; 127.0.0.1 is this machine alone, 0.0.0.0 whoever reaches it")
      ->capture_default_str();
  c->add_option("--viewer", a->viewer, "Another viewer.html than the built-in one")->check(CLI::ExistingFile);
  c->footer(
      "Examples:\n"
      "  carus serve out/reference\n"
      "  carus serve out/reference out/softer --port 0\n"
      "The page of a run in progress follows it.");
  c->callback([a, &status] { status = serve(*a); });
}

}  // namespace carus::app
