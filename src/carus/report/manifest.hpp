// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include "carus/report/folder.hpp"
#include "carus/report/pack.hpp"
#include "carus/report/verdict.hpp"

namespace carus::report {

struct Blob {
  std::string bytes;    ///< zlib stream
  std::size_t raw = 0;  ///< bytes before deflate
};

/// A run as the page shows it. `packer` is null where frames cannot be read at all.
struct Run {
  Folder folder;
  Verdict verdict;
  std::shared_ptr<FramePacker> packer;
};
/// Reads a folder and its frames; throws InputError as read_folder does. Frames that are missing or damaged become
/// notes. With the packer of an earlier reading only frames that are new are read.
Run read_run(const std::filesystem::path& folder, const PackOptions& options = {},
             std::shared_ptr<FramePacker> packer = {});

struct ManifestOptions {
  std::string version, commit, created;  ///< created: UTC, ISO 8601
  int ghost = -1;                        ///< index of a run, or none
  std::string blob_url;  ///< "data/": blobs are fetched from there, by content_hash; empty: they are in the page
  std::string live_url;  ///< where a newer manifest of a run in progress is; empty: nowhere
};
std::string content_hash(const Blob& blob);
struct Manifest {
  std::string json;  ///< docs/reference/report_format.md
  std::vector<Blob> blobs;
};
Manifest manifest_of(const std::vector<Run>& runs, const ManifestOptions& options);

/// "2026-11-26T03:00:00Z"
std::string utc_now();

}  // namespace carus::report
