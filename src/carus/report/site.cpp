// SPDX-License-Identifier: Apache-2.0
#include "carus/report/site.hpp"

#include <fmt/format.h>

#include "carus/core/error.hpp"
#include "carus/report/page.hpp"
#include "carus/results/files.hpp"

namespace carus::report {
namespace {

namespace fs = std::filesystem;

constexpr std::string_view data_prefix = "/data/";

/// Sizes and times of the files that a run changes.
std::string stamp(const fs::path& folder) {
  std::string text;
  for (const char* name : {"curves.csv", "frames.pvd", "summary.json", "events.jsonl"}) {
    std::error_code missing;
    const auto size = fs::file_size(folder / name, missing);
    const auto time = fs::last_write_time(folder / name, missing);
    text += missing ? "-;" : fmt::format("{}@{};", size, time.time_since_epoch().count());
  }
  return text;
}

Answer failure(int status, const std::string& message) {
  return {status, "text/plain; charset=utf-8", std::make_shared<const std::string>(message + "\n"), false};
}

}  // namespace

Site::Site(std::string viewer, std::vector<fs::path> folders, ManifestOptions options, PackOptions pack)
    : viewer_(std::move(viewer)), options_(std::move(options)), pack_(pack), folders_(std::move(folders)) {
  options_.blob_url = std::string(data_prefix.substr(1));
  options_.live_url = "manifest.json";
  for (const auto& folder : folders_) {
    stamps_.push_back(stamp(folder));
    runs_.push_back(read_run(folder, pack_));
  }
  rebuild();
}

void Site::refresh() {
  bool changed = false;
  for (std::size_t i = 0; i < folders_.size(); ++i) {
    const auto now = stamp(folders_[i]);
    if (now == stamps_[i]) continue;
    // Another scenario is another run: nothing of what was read still holds.
    const auto yaml = folders_[i] / "scenario.resolved.yaml";
    const bool same = fs::is_regular_file(yaml) && results::read_text(yaml) == runs_[i].folder.scenario_yaml;
    auto again = read_run(folders_[i], pack_, same ? runs_[i].packer : nullptr);
    runs_[i] = std::move(again), stamps_[i] = now, changed = true;
  }
  if (changed) rebuild();
}

void Site::rebuild() {
  options_.created = utc_now();
  auto m = manifest_of(runs_, options_);
  blobs_before_ = std::move(blobs_);
  blobs_.clear();
  for (auto& blob : m.blobs) {
    auto name = content_hash(blob);
    blobs_.emplace(std::move(name), std::make_shared<const std::string>(std::move(blob.bytes)));
  }
  manifest_ = std::make_shared<const std::string>(std::move(m.json));
  page_ = std::make_shared<const std::string>(page(viewer_, *manifest_, {}));
}

Answer Site::get(std::string_view target) {
  const std::scoped_lock lock(busy_);
  const auto path = target.substr(0, target.find('?'));
  try {
    if (path == "/" || path == "/index.html") {
      refresh();
      return {200, "text/html; charset=utf-8", page_, false};
    }
    if (path == "/manifest.json") {
      refresh();
      return {200, "application/json", manifest_, false};
    }
  } catch (const InputError& e) {
    return failure(503, e.what());
  }
  if (path.starts_with(data_prefix)) {
    const auto name = path.substr(data_prefix.size());
    for (const auto* blobs : {&blobs_, &blobs_before_}) {
      if (const auto it = blobs->find(name); it != blobs->end())
        return {200, "application/octet-stream", it->second, true};
    }
    return failure(404, "no such data; load the page again");
  }
  return failure(404, "nothing here; the page is at /");
}

}  // namespace carus::report
