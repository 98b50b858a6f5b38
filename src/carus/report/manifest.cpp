// SPDX-License-Identifier: Apache-2.0
#include "carus/report/manifest.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <bit>
#include <chrono>
#include <cmath>
#include <cstring>
#include <ctime>
#include <map>
#include <nlohmann/json.hpp>

#include "carus/core/error.hpp"
#include "carus/report/compare.hpp"
#include "carus/report/mesh_quality.hpp"
#include "carus/report/plots.hpp"
#include "carus/report/wrench.hpp"
#include "carus/results/figures.hpp"
#include "carus/results/files.hpp"

namespace carus::report {
namespace {

using Json = nlohmann::ordered_json;

Json number(double v) { return std::isfinite(v) ? Json(v) : Json(nullptr); }
Json number(const std::optional<double>& v) { return v ? number(*v) : Json(nullptr); }

class Writer {
 public:
  explicit Writer(const ManifestOptions& options) : options_(options) {}

  std::size_t add(std::string bytes, std::size_t raw) {
    blobs_.push_back({std::move(bytes), raw});
    return blobs_.size() - 1;
  }
  Json add(const Packed& p) { return {{"blob", add(p.bytes, p.raw)}, {"planes", p.planes}}; }

  Json run(const Run& r, const std::string& name);
  Json blobs() const {
    Json list = Json::array();
    for (std::size_t i = 0; i < blobs_.size(); ++i) {
      Json b = {{"bytes", blobs_[i].bytes.size()}, {"raw", blobs_[i].raw}};
      if (!options_.blob_url.empty()) b["src"] = options_.blob_url + content_hash(blobs_[i]);
      list.push_back(std::move(b));
    }
    return list;
  }
  std::vector<Blob> take_blobs() { return std::move(blobs_); }

 private:
  Json curves(const observe::Table& table);
  Json mesh(const FramePacker& p, const std::string& file);
  Json frames(const FramePacker& p);

  const ManifestOptions& options_;
  std::vector<Blob> blobs_;
};

Json verdict_json(const Verdict& v) {
  Json rows = Json::array();
  for (const auto& r : v.rows) {
    rows.push_back({{"group", r.number > 0 ? "band" : "paper"},
                    {"number", r.number > 0 ? Json(r.number) : Json(nullptr)},
                    {"what", r.what},
                    {"expected", r.expected},
                    {"source", r.source},
                    {"obtained", r.obtained},
                    {"state", !r.asked   ? "not_asked"
                              : r.inside ? "inside"
                                         : "outside"}});
  }
  return {{"met", v.met},         {"line", v.line},           {"inside", v.inside},
          {"outside", v.outside}, {"not_asked", v.not_asked}, {"rows", std::move(rows)}};
}

/// Text of a summary's value as a person reads it.
std::string as_words(const Json& j) {
  if (j.is_string()) return j.get<std::string>();
  if (j.is_null()) return "none";
  return j.dump(-1, ' ', false, Json::error_handler_t::replace);
}

std::string spaced(std::string key) {
  std::replace(key.begin(), key.end(), '_', ' ');
  return key;
}

/// Members of summary[key], or nothing where it is of another form: the folder may be of another version.
void add_members(Json& list, const Json& summary, const char* key, const std::string& prefix = "") {
  const auto it = summary.find(key);
  if (it == summary.end() || !it->is_object()) return;
  for (const auto& [name, value] : it->items())
    list.push_back({{"what", prefix + spaced(name)}, {"value", as_words(value)}});
}

Json provenance(const Json& summary, const Run& r) {
  Json list = Json::array();
  const auto add = [&](const std::string& what, const std::string& value) {
    if (!value.empty()) list.push_back({{"what", what}, {"value", value}});
  };
  add("folder", r.folder.path.string());
  // Before there is a summary, the first line of the resolved scenario tells the version.
  if (summary.empty() && r.folder.scenario_yaml.starts_with("# carus "))
    add("version", r.folder.scenario_yaml.substr(8, r.folder.scenario_yaml.find('\n') - 8));
  for (const char* key : {"version", "commit", "machine", "threads", "seed", "outcome"}) {
    if (const auto it = summary.find(key); it != summary.end()) add(key, as_words(*it));
  }
  add_members(list, summary, "numerics");
  if (r.packer && !r.packer->empty()) {
    const auto q = mesh_quality(r.packer->mesh());
    if (!summary.contains("numerics")) {
      add("elements", fmt::format("{}", r.packer->mesh().tets.size()));
      add("nodes", fmt::format("{}", r.packer->mesh().nodes.size()));
    }
    add("least dihedral angle at rest",
        fmt::format("{:.1f} deg; 1 % of elements below {:.1f} deg", q.least_angle, q.low_angle));
    add("mean edge at rest", fmt::format("{:.2f} mm", 1e3 * q.mean_edge));
  }
  add_members(list, summary, "wall_s", "wall time, s: ");
  add_members(list, summary, "solver_stages_s", "solver, s: ");
  return list;
}

Json pairs(const Json& summary, const char* key) {
  Json list = Json::array();
  add_members(list, summary, key);
  const auto it = summary.find(key);
  if (it == summary.end() || !it->is_array()) return list;
  for (const auto& e : *it) {
    if (e.is_object() && e.contains("key") && e.contains("to"))
      list.push_back({{"what", as_words(e["key"])}, {"value", as_words(e["to"])}});
  }
  return list;
}

Json contractions(const Folder& f) {
  Json list = Json::array();
  if (!f.scenario) return list;
  const auto& c = f.scenario->loads.contractions;
  for (const double s : results::contraction_starts(c, f.curves.rows.back()[0])) {
    list.push_back({{"start_s", s},
                    {"plateau_s", s + c.rise},
                    {"plateau_end_s", s + c.duration - c.fall},
                    {"end_s", s + c.duration}});
  }
  return list;
}

Json plots_json(const std::vector<Plot>& plots) {
  Json list = Json::array();
  for (const auto& p : plots) {
    Json columns = Json::array(), marks = Json::array(), references = Json::array();
    for (const auto& l : p.lines) columns.push_back({{"name", l.column}, {"label", l.label}});
    for (const auto& m : p.marks) {
      if (m.low && m.high && *m.low == *m.high) {
        marks.push_back({{"kind", "value"}, {"value", number(m.low)}, {"label", m.label}, {"source", m.source}});
      } else {
        marks.push_back({{"kind", "band"},
                         {"low", number(m.low)},
                         {"high", number(m.high)},
                         {"label", m.label},
                         {"source", m.source}});
      }
    }
    for (const auto& r : p.references) {
      Json points = Json::array();
      for (std::size_t i = 0; i < r.time.size(); ++i) points.push_back({number(r.time[i]), number(r.value[i])});
      references.push_back({{"label", r.label}, {"source", r.source}, {"points", std::move(points)}});
    }
    list.push_back({{"id", p.id},
                    {"title", p.title},
                    {"figure", p.figure},
                    {"unit", p.unit},
                    {"columns", std::move(columns)},
                    {"marks", std::move(marks)},
                    {"references", std::move(references)}});
  }
  return list;
}

Json Writer::curves(const observe::Table& table) {
  static_assert(std::endian::native == std::endian::little, "the page holds little-endian floats");
  Json columns = Json::array();
  std::vector<std::uint8_t> bytes;
  for (std::size_t c = 0; c < table.names.size(); ++c) {
    columns.push_back({{"name", table.names[c]}, {"unit", unit_of(table.names[c])}});
    for (const auto& row : table.rows) {
      const auto v = float(row[c]);
      const auto at = bytes.size();
      bytes.resize(at + sizeof v);
      std::memcpy(bytes.data() + at, &v, sizeof v);
    }
  }
  return {{"rows", table.rows.size()}, {"columns", std::move(columns)}, {"blob", add(deflate(bytes), bytes.size())}};
}

Json Writer::mesh(const FramePacker& p, const std::string& file) {
  const auto& m = p.mesh();
  Json regions = Json::array();
  for (std::size_t r = 0; r < m.regions.size(); ++r) {
    const auto tet = std::find(m.labels.begin(), m.labels.end(), std::int32_t(r));
    if (tet == m.labels.end()) continue;
    const auto& name = m.regions[r];
    const auto& organ = m.organs[m.organ[std::size_t(tet - m.labels.begin())]];
    const bool bone = name.starts_with("innominate") || name == "sacrum" || name == "coccyx" ||
                      name.find("bone") != std::string::npos;
    const bool soft = name == "levator_ani" || name == "perineal_body" || organ == "abdomen";
    regions.push_back({{"id", r},
                       {"name", name},
                       {"label", spaced(name)},
                       {"organ", organ},
                       {"kind", bone                ? "bone"
                                : soft              ? "soft"
                                : organ == "fetus"  ? "fetus"
                                : organ == "uterus" ? "uterus"
                                                    : "soft"}});
  }
  Json landmarks = Json::array();
  try {
    const Vec3 c = Head(m, file).rest_centre();
    landmarks.push_back({{"name", "head_centre"}, {"label", "head's centre"}, {"position", {c[0], c[1], c[2]}}});
  } catch (const InputError&) {
    // A mesh without a skull has no head to follow.
  }
  return {{"nodes", m.nodes.size()},          {"tets", m.tets.size()},     {"regions", std::move(regions)},
          {"corners", add(p.corners())},      {"region", add(p.region())}, {"rest", add(p.rest())},
          {"landmarks", std::move(landmarks)}};
}

Json Writer::frames(const FramePacker& p) {
  Json times = Json::array(), position = Json::array(), fields = Json::array();
  const auto chunk_json = [&](std::size_t first, std::size_t count, const Packed& packed) -> Json {
    return {{"first", first},
            {"count", count},
            {"blob", add(packed.bytes, packed.raw)},
            {"planes", packed.planes},
            {"order", packed.order}};
  };
  fields.push_back({{"name", "displacement"},
                    {"label", "Total displacement"},
                    {"unit", "mm"},
                    {"at", "node"},
                    {"derived", "displacement"},
                    {"scale", {0, 250}}});
  // Blobs in the order of time, positions first: what a viewer wants first comes first.
  for (const auto& k : p.kinds()) {
    fields.push_back({{"name", k.name},
                      {"label", k.label},
                      {"unit", k.unit},
                      {"at", "node"},
                      {"offset", k.offset},
                      {"quantum", k.quantum},
                      {"scale", {k.low, k.high}},
                      {"min", nullptr},
                      {"max", nullptr},
                      {"chunks", Json::array()}});
  }
  std::size_t first = 0;
  std::vector<float> low(p.kinds().size(), std::numeric_limits<float>::infinity()),
      high(p.kinds().size(), -low.front());
  for (const auto& c : p.chunks()) {
    if (c.times.empty()) continue;  // all of its frames are unreadable
    for (const double t : c.times) times.push_back(t);
    position.push_back(chunk_json(first, c.times.size(), c.position));
    for (std::size_t k = 0; k < c.fields.size(); ++k) {
      low[k] = std::min(low[k], c.fields[k].min), high[k] = std::max(high[k], c.fields[k].max);
      fields[k + 1]["chunks"].push_back(chunk_json(first, c.times.size(), c.fields[k].data));
      fields[k + 1]["min"] = low[k], fields[k + 1]["max"] = high[k];
    }
    first += c.times.size();
  }
  return {{"times_s", std::move(times)},
          {"quantum", p.options().quantum},
          {"position", {{"chunks", std::move(position)}}},
          {"fields", std::move(fields)}};
}

Json Writer::run(const Run& r, const std::string& name) {
  const auto& f = r.folder;
  const Json summary = f.summary_json.empty() ? Json::object() : Json::parse(f.summary_json);
  auto table = f.curves;
  const auto plots = plots_of(f, table);
  auto notes = f.notes;
  if (r.packer) notes.insert(notes.end(), r.packer->notes().begin(), r.packer->notes().end());
  Json events = Json::array();
  for (const auto& e : f.events) events.push_back(Json::parse(e));
  const bool visible = r.packer && std::any_of(r.packer->chunks().begin(), r.packer->chunks().end(),
                                               [](const Chunk& c) { return !c.times.empty(); });
  Json j;
  j["name"] = name;
  j["folder"] = f.path.string();
  j["status"] = name_of(f.status);
  j["notes"] = notes;
  j["description"] = f.scenario ? f.scenario->description : "";
  j["scenario"] = f.scenario_yaml;
  j["summary"] = f.summary_json.empty() ? Json(nullptr) : summary;
  j["log"] = f.log;
  j["duration_s"] = f.curves.rows.back()[0];
  j["verdict"] = verdict_json(r.verdict);
  j["provenance"] = provenance(summary, r);
  j["declared"] = pairs(summary, "declared");
  j["calibrated"] = pairs(summary, "calibrated");
  j["events"] = std::move(events);
  j["contractions"] = contractions(f);
  j["curves"] = curves(table);
  j["plots"] = plots_json(plots);
  j["mesh"] = visible ? mesh(*r.packer, (f.path / "frames.pvd").string()) : Json(nullptr);
  j["frames"] = visible ? frames(*r.packer) : Json(nullptr);
  return j;
}

/// Names of the runs, told apart by their folders where they are alike.
std::vector<std::string> names_of(const std::vector<Run>& runs) {
  std::map<std::string, int> count;
  for (const auto& r : runs) ++count[r.folder.name()];
  std::vector<std::string> names;
  for (const auto& r : runs)
    names.push_back(count[r.folder.name()] == 1 ? r.folder.name()
                                                : fmt::format("{} ({})", r.folder.name(), r.folder.path.string()));
  return names;
}

Json comparison(const std::vector<Run>& runs) {
  if (runs.size() < 2) return nullptr;
  std::vector<const Folder*> folders;
  for (const auto& r : runs) folders.push_back(&r.folder);
  Json rows = Json::array();
  for (const auto& row : compare(folders)) {
    Json values = Json::array();
    for (const auto& v : row.values) values.push_back(number(v));
    rows.push_back({{"what", row.what}, {"unit", row.unit}, {"values", std::move(values)}});
  }
  return {{"rows", std::move(rows)}};
}

}  // namespace

std::string content_hash(const Blob& blob) {
  results::Hash hash;
  hash.add_all(blob.bytes);
  return hash.hex();
}

Run read_run(const std::filesystem::path& path, const PackOptions& options, std::shared_ptr<FramePacker> packer) {
  Run r;
  r.folder = read_folder(path);
  r.verdict = judge(r.folder);
  const auto pvd = path / "frames.pvd";
  if (!std::filesystem::is_regular_file(pvd)) {
    r.folder.notes.push_back(fmt::format("{}: no such file; there is nothing to show in 3-D", pvd.string()));
    return r;
  }
  FramePacker::Materials materials;
  if (r.folder.scenario) materials = r.folder.scenario->materials;
  r.packer = packer ? std::move(packer) : std::make_shared<FramePacker>(pvd, std::move(materials), options);
  try {
    r.packer->update();
  } catch (const InputError& e) {
    r.folder.notes.push_back(e.what());
    r.packer.reset();
  }
  return r;
}

Manifest manifest_of(const std::vector<Run>& runs, const ManifestOptions& options) {
  CARUS_ASSERT(!runs.empty() && options.ghost < int(runs.size()));
  Writer writer(options);
  const auto names = names_of(runs);
  Json j;
  j["format"] = "carus-report-1";
  j["generator"] = {{"version", options.version}, {"commit", options.commit}};
  j["created"] = options.created;
  j["title"] = names.size() == 1 ? names[0] : fmt::format("{} and {} more", names[0], names.size() - 1);
  j["runs"] = Json::array();
  for (std::size_t i = 0; i < runs.size(); ++i) j["runs"].push_back(writer.run(runs[i], names[i]));
  j["ghost"] = options.ghost < 0 ? Json(nullptr) : Json(options.ghost);
  j["comparison"] = comparison(runs);
  j["blobs"] = writer.blobs();
  const bool growing =
      std::any_of(runs.begin(), runs.end(), [](const Run& r) { return r.folder.status == RunStatus::in_progress; });
  j["live"] = growing && !options.live_url.empty() ? Json{{"src", options.live_url}, {"every_s", 5}} : Json(nullptr);
  return {j.dump(-1, ' ', false, Json::error_handler_t::replace), writer.take_blobs()};
}

std::string utc_now() {
  const std::time_t now = std::chrono::system_clock::to_time_t(std::chrono::system_clock::now());
  std::tm utc{};
  gmtime_r(&now, &utc);
  char text[32];
  std::strftime(text, sizeof text, "%Y-%m-%dT%H:%M:%SZ", &utc);
  return text;
}

}  // namespace carus::report
