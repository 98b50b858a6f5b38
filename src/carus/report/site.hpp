// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <map>
#include <memory>
#include <mutex>
#include <string>
#include <string_view>
#include <vector>

#include "carus/report/manifest.hpp"

namespace carus::report {

struct Answer {
  int status = 200;
  std::string type = "text/plain; charset=utf-8";
  std::shared_ptr<const std::string> body = std::make_shared<const std::string>();
  bool unchanging = false;  ///< the same address will always give the same bytes
};

/// What carus serve shows of results folders: the page at "/", its manifest at "/manifest.json", and the blobs by their
/// contents' hash at "/data/HASH". Nothing else has an address, and no address ever becomes a file's name. Folders that
/// change, as those of runs in progress do, are read anew; frames only the new ones. Thread-safe.
class Site {
 public:
  /// Throws InputError as read_run does.
  Site(std::string viewer, std::vector<std::filesystem::path> folders, ManifestOptions options, PackOptions pack = {});

  /// `target`: of the request line, a query included.
  Answer get(std::string_view target);

 private:
  void refresh();
  void rebuild();

  std::mutex busy_;
  std::string viewer_;
  ManifestOptions options_;
  PackOptions pack_;
  std::vector<std::filesystem::path> folders_;
  std::vector<Run> runs_;
  std::vector<std::string> stamps_;  // of each folder: what tells that it has changed
  std::shared_ptr<const std::string> page_, manifest_;
  // Those of the manifest before are kept: a browser may be fetching them.
  std::map<std::string, std::shared_ptr<const std::string>, std::less<>> blobs_, blobs_before_;
};

}  // namespace carus::report
