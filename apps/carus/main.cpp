// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include <cstdio>

#include "app.hpp"
#include "carus/core/error.hpp"
#include "carus/results/import.hpp"
#include "version.hpp"
#ifdef CARUS_WITH_MESHING
#include "carus/meshing/build.hpp"
#endif

namespace carus::app {

anatomy::Anatomy build_anatomy(const scenario::Scenario& s) {
  if (!s.anatomy_from.empty()) return results::read_anatomy(s.anatomy_from, s);
#ifdef CARUS_WITH_MESHING
  return meshing::build(s.anatomy);
#else
  throw InputError(s.file +
                   ": anatomy.from: silent, and this build has no meshing (CARUS_MESHING=OFF); allowed a folder that "
                   "carus anatomy wrote; or configure with -DCARUS_MESHING=ON");
#endif
}

}  // namespace carus::app

int main(int argc, char** argv) {
  using namespace carus;
  CLI::App app("carus: computes a childbirth by finite elements. Not for clinical use.", "carus");
  app.set_version_flag("--version",
                       fmt::format("carus {} ({})", carus::app::program_version, carus::app::program_commit));
  app.require_subcommand(1);
  app.footer("Exit status: 0 done, 1 a check is not met, 2 bad input, 3 numerical failure, 4 interrupted (resumable).");
  int status = app::done;
  app::add_run(app, status);
  app::add_check(app, status);
  app::add_anatomy(app, status);
  app::add_mesh(app, status);
  app::add_study(app, status);
  app::add_bench(app, status);
  app::add_report(app, status);
  app::add_export(app, status);
  app::add_serve(app, status);
  app::add_verify(app, status);
  try {
    app.parse(argc, argv);
  } catch (const CLI::ParseError& e) {
    return app.exit(e) == 0 ? app::done : app::bad_input;
  } catch (const InputError& e) {
    for (const auto& problem : e.problems()) fmt::print(stderr, "error: {}\n", problem);
    return app::bad_input;
  } catch (const NumericalFailure& e) {
    fmt::print(stderr, "numerical failure: {}\n", e.what());
    return app::numerical_failure;
  }
  return status;
}
