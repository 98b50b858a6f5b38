// SPDX-License-Identifier: Apache-2.0
#include "carus/results/checkpoint.hpp"

#include <fmt/format.h>
#include <hdf5.h>

#include "carus/core/error.hpp"
#include "carus/results/files.hpp"

namespace carus::results {
namespace {

/// An HDF5 identifier with its closing function.
class Handle {
 public:
  Handle(hid_t id, herr_t (*close)(hid_t), const std::string& what) : id_(id), close_(close) {
    if (id < 0) throw InputError(what);
  }
  ~Handle() { close_(id_); }
  Handle(const Handle&) = delete;
  Handle& operator=(const Handle&) = delete;
  operator hid_t() const { return id_; }  // NOLINT: to be used as one

 private:
  hid_t id_;
  herr_t (*close_)(hid_t);
};

/// One array per dataset, by name; the file says in each message.
class Store {
 public:
  Store(const std::filesystem::path& file, bool write)
      : name_(file.string()),
        file_(write ? H5Fcreate(file.c_str(), H5F_ACC_TRUNC, H5P_DEFAULT, H5P_DEFAULT)
                    : H5Fopen(file.c_str(), H5F_ACC_RDONLY, H5P_DEFAULT),
              H5Fclose,
              fmt::format("{}: cannot be {}", name_, write ? "written" : "read; it is not a checkpoint of carus")) {}

  void put(const char* name, const void* data, std::size_t n, hid_t type) const {
    const hsize_t size = n;
    const Handle space(H5Screate_simple(1, &size, nullptr), H5Sclose, bad(name));
    const Handle set(H5Dcreate2(file_, name, type, space, H5P_DEFAULT, H5P_DEFAULT, H5P_DEFAULT), H5Dclose, bad(name));
    if (n > 0 && H5Dwrite(set, type, H5S_ALL, H5S_ALL, H5P_DEFAULT, data) < 0) throw InputError(bad(name));
  }
  void put(const char* name, const std::vector<double>& v) const { put(name, v.data(), v.size(), H5T_NATIVE_DOUBLE); }
  void put(const char* name, const std::vector<Vec3>& v) const { put(name, v.data(), 3 * v.size(), H5T_NATIVE_DOUBLE); }
  void put(const char* name, const std::vector<std::int64_t>& v) const {
    put(name, v.data(), v.size(), H5T_NATIVE_INT64);
  }
  void put(const char* name, const std::string& v) const { put(name, v.data(), v.size(), H5T_NATIVE_CHAR); }

  template <class Resize>
  void get(const char* name, hid_t type, Resize&& resize) const {
    const Handle set(H5Dopen2(file_, name, H5P_DEFAULT), H5Dclose, bad(name));
    const Handle space(H5Dget_space(set), H5Sclose, bad(name));
    void* data = resize(std::size_t(H5Sget_simple_extent_npoints(space)));
    if (data && H5Dread(set, type, H5S_ALL, H5S_ALL, H5P_DEFAULT, data) < 0) throw InputError(bad(name));
  }
  void get(const char* name, std::vector<double>& v) const {
    get(name, H5T_NATIVE_DOUBLE, [&](std::size_t n) { return v.resize(n), v.data(); });
  }
  void get(const char* name, std::vector<Vec3>& v) const {
    get(name, H5T_NATIVE_DOUBLE, [&](std::size_t n) { return v.resize(n / 3), v.data(); });
  }
  void get(const char* name, std::vector<std::int64_t>& v) const {
    get(name, H5T_NATIVE_INT64, [&](std::size_t n) { return v.resize(n), v.data(); });
  }
  void get(const char* name, std::string& v) const {
    get(name, H5T_NATIVE_CHAR, [&](std::size_t n) { return v.resize(n), v.data(); });
  }

 private:
  [[nodiscard]] std::string bad(const char* part) const {
    return fmt::format("{}: {}: missing or damaged; it is not a checkpoint of carus", name_, part);
  }
  std::string name_;
  Handle file_;
};

static_assert(sizeof(Vec3) == 3 * sizeof(double), "stored as rows of three");

}  // namespace

void write_checkpoint(const std::filesystem::path& file, const Checkpoint& c) {
  write_atomically(file, [&](const std::filesystem::path& temporary) {
    const Store h(temporary, true);
    h.put("scenario_hash", c.scenario_hash), h.put("mesh_hash", c.mesh_hash), h.put("version", c.version);
    h.put("counts", std::vector<std::int64_t>{c.rows, c.stops, c.events, c.state.step});
    h.put("frame_times", c.frame_times), h.put("wall", c.wall);
    h.put("time", std::vector<double>{c.state.time, c.state.labour_per_pseudo});
    h.put("x", c.state.x), h.put("v", c.state.v);
    h.put("hinge_angle", c.state.hinge_angle), h.put("hinge_rate", c.state.hinge_rate);
    h.put("rest_length", c.state.rest_length), h.put("internal", c.state.internal);
  });
}

Checkpoint read_checkpoint(const std::filesystem::path& file) {
  if (!std::filesystem::exists(file)) {
    throw InputError(fmt::format("{}: no such file; nothing to resume; run without --resume to start", file.string()));
  }
  H5Eset_auto2(H5E_DEFAULT, nullptr, nullptr);  // our own messages say it
  const Store h(file, false);
  Checkpoint c;
  std::vector<std::int64_t> counts;
  std::vector<double> time;
  h.get("scenario_hash", c.scenario_hash), h.get("mesh_hash", c.mesh_hash), h.get("version", c.version);
  h.get("counts", counts), h.get("time", time);
  h.get("frame_times", c.frame_times), h.get("wall", c.wall);
  h.get("x", c.state.x), h.get("v", c.state.v);
  h.get("hinge_angle", c.state.hinge_angle), h.get("hinge_rate", c.state.hinge_rate);
  h.get("rest_length", c.state.rest_length), h.get("internal", c.state.internal);
  if (counts.size() != 4 || time.size() != 2) throw InputError(fmt::format("{}: counts: damaged", file.string()));
  c.rows = counts[0], c.stops = counts[1], c.events = counts[2], c.state.step = counts[3];
  c.state.time = time[0], c.state.labour_per_pseudo = time[1];
  return c;
}

std::string hash_of(const scenario::Scenario& given) {
  scenario::Scenario s = given;
  s.numerics.threads = 0;
  s.file.clear();
  Hash h;
  h.add_all(scenario::resolved_yaml(s));
  return h.hex();
}

std::string hash_of(const mesh::TetMesh& mesh) {
  Hash h;
  h.add_all(mesh.nodes), h.add_all(mesh.tets), h.add_all(mesh.labels);
  return h.hex();
}

void refuse_foreign(const std::filesystem::path& file, const Checkpoint& c, const std::string& scenario_hash,
                    const std::string& mesh_hash) {
  const auto refuse = [&](const char* what, const std::string& theirs, const std::string& ours) {
    throw InputError(
        fmt::format("{}: was written for another {} ({} against {}); resume with the one in scenario.resolved.yaml, or "
                    "run without --resume",
                    file.string(), what, theirs, ours));
  };
  if (c.scenario_hash != scenario_hash) refuse("scenario", c.scenario_hash, scenario_hash);
  if (c.mesh_hash != mesh_hash) refuse("mesh", c.mesh_hash, mesh_hash);
}

}  // namespace carus::results
