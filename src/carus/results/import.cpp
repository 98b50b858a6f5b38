// SPDX-License-Identifier: Apache-2.0
#include "carus/results/import.hpp"

#include <fmt/format.h>
#include <vtkCellArray.h>
#include <vtkCellData.h>
#include <vtkDoubleArray.h>
#include <vtkFieldData.h>
#include <vtkIntArray.h>
#include <vtkNew.h>
#include <vtkSmartPointer.h>
#include <vtkUnstructuredGrid.h>

#include <cmath>
#include <nlohmann/json.hpp>

#include "carus/core/error.hpp"
#include "carus/results/checkpoint.hpp"
#include "carus/results/export.hpp"
#include "carus/results/files.hpp"
#include "carus/results/vtu_file.hpp"

namespace carus::results {
namespace {

namespace fs = std::filesystem;
using Json = nlohmann::json;

/// One VTU file of a body.
class BodyFile {
 public:
  explicit BodyFile(fs::path file)
      : file_(std::move(file)), grid_(read_vtu(file_, [this](const std::string& what) { refuse(what); })) {}

  anatomy::Body body(const std::string& name) {
    anatomy::Body b;
    b.name = name;
    read_mesh(b.mesh);
    vtkFieldData& fields = *grid_->GetFieldData();
    for (int k = 0; k < fields.GetNumberOfArrays(); ++k) {
      auto* array = vtkIntArray::SafeDownCast(fields.GetArray(k));
      const std::string key = array != nullptr && array->GetName() != nullptr ? array->GetName() : "";
      if (key.starts_with(nodes_prefix))
        b.nodes.push_back({key.substr(std::string(nodes_prefix).size()), indices<1>(*array, key, b.mesh)});
      if (key.starts_with(surface_prefix)) {
        mesh::NamedSurface s{key.substr(std::string(surface_prefix).size()), {}};
        const auto flat = indices<3>(*array, key, b.mesh);
        for (std::size_t i = 0; i < flat.size(); i += 3) s.triangles.push_back({flat[i], flat[i + 1], flat[i + 2]});
        b.surfaces.push_back(std::move(s));
      }
    }
    return b;
  }

  std::vector<anatomy::WallFrame> wall_frames() {
    const auto meridian = cells<vtkDoubleArray>("meridian", 3), normal = cells<vtkDoubleArray>("normal", 3),
               s = cells<vtkDoubleArray>("s", 1), dome = cells<vtkDoubleArray>("dome", 1);
    std::vector<anatomy::WallFrame> frames(std::size_t(grid_->GetNumberOfCells()));
    for (std::size_t e = 0; e < frames.size(); ++e) {
      meridian->GetTuple(vtkIdType(e), frames[e].meridian.data());
      normal->GetTuple(vtkIdType(e), frames[e].normal.data());
      frames[e].s = s->GetValue(vtkIdType(e)), frames[e].dome = dome->GetValue(vtkIdType(e));
    }
    return frames;
  }

  [[noreturn]] void refuse(const std::string& what) const {
    throw InputError(fmt::format("{}: {}; write the folder again with carus anatomy", file_.string(), what));
  }

 private:
  void read_mesh(mesh::TetMesh& m) {
    if (grid_->GetNumberOfCells() == 0) refuse("has no cells");
    m.nodes.resize(std::size_t(grid_->GetNumberOfPoints()));
    for (std::size_t i = 0; i < m.nodes.size(); ++i) {
      grid_->GetPoint(vtkIdType(i), m.nodes[i].data());
      if (!m.nodes[i].allFinite()) refuse(fmt::format("point {} is not finite", i));
    }
    const auto labels = cells<vtkIntArray>("label", 1);
    for (vtkIdType e = 0; e < grid_->GetNumberOfCells(); ++e) {
      vtkIdType count = 0;
      const vtkIdType* points = nullptr;
      grid_->GetCellPoints(e, count, points);
      if (grid_->GetCellType(e) != VTK_TETRA || count != 4) refuse(fmt::format("cell {} is not a tetrahedron", e));
      mesh::Tet tet{};
      for (int k = 0; k < 4; ++k) tet[k] = checked(points[k], "cell", m);
      m.tets.push_back(tet);
      m.labels.push_back(labels->GetValue(e));
      if (!(mesh::volume(m, std::size_t(e)) > 0)) refuse(fmt::format("cell {} has no positive volume", e));
    }
  }

  template <class Array>
  Array* cells(const char* name, int components) {
    auto* array = Array::SafeDownCast(grid_->GetCellData()->GetArray(name));
    if (array == nullptr || array->GetNumberOfComponents() != components ||
        array->GetNumberOfTuples() != grid_->GetNumberOfCells())
      refuse(fmt::format("has no cell data \"{}\" with {} {} per cell", name, components,
                         components == 1 ? "value" : "values"));
    return array;
  }

  template <int components>
  std::vector<std::int32_t> indices(vtkIntArray& values, const std::string& key, const mesh::TetMesh& m) const {
    if (values.GetNumberOfComponents() != components)
      refuse(fmt::format("{}: {} components; allowed {}", key, values.GetNumberOfComponents(), components));
    std::vector<std::int32_t> out;
    for (vtkIdType i = 0; i < values.GetNumberOfValues(); ++i) out.push_back(checked(values.GetValue(i), key, m));
    return out;
  }

  std::int32_t checked(vtkIdType node, const std::string& what, const mesh::TetMesh& m) const {
    if (node < 0 || node >= vtkIdType(m.nodes.size()))
      refuse(fmt::format("{}: node {}; allowed 0 to {}", what, node, m.nodes.size() - 1));
    return std::int32_t(node);
  }

  fs::path file_;
  vtkSmartPointer<vtkUnstructuredGrid> grid_;
};

double number(const Json& j) { return j.is_null() ? NAN : j.get<double>(); }

std::map<std::string, double> numbers(const Json& j) {
  std::map<std::string, double> out;
  for (const auto& [key, value] : j.items()) out[key] = number(value);
  return out;
}

/// A mesh of other dimensions than the scenario states would be run under a false description.
void refuse_other_keys(const fs::path& folder, const Json& written, const scenario::Scenario& s) {
  std::vector<std::string> problems;
  for (const auto& [key, ours] : scenario::anatomy_settings(s)) {
    const std::string theirs = written.value(key, "nothing");
    if (theirs != ours)
      problems.push_back(
          fmt::format("{}: anatomy.from: {} was meshed with {} {}, the scenario says {}; make them "
                      "equal, or mesh again with carus anatomy",
                      s.file, folder.string(), key, theirs, ours));
  }
  if (!problems.empty()) throw InputError(problems);
}

}  // namespace

anatomy::Anatomy read_anatomy(const fs::path& folder, const scenario::Scenario& s) {
  if (!fs::is_directory(folder))
    throw InputError(
        fmt::format("{}: anatomy.from: \"{}\" is no folder; allowed one that carus anatomy SCENARIO --out DIR wrote",
                    s.file, folder.string()));
  const fs::path file = folder / anatomy_file;
  if (!fs::exists(file))
    throw InputError(fmt::format("{}: no such file; write the folder again with carus anatomy", file.string()));
  anatomy::Anatomy a;
  a.parameters = s.anatomy;
  std::vector<std::string> problems;
  try {
    const Json j = Json::parse(read_text(file));
    if (j.at("format") != anatomy_format)
      throw InputError(fmt::format("{}: format {}; allowed \"{}\"; write the folder again with carus anatomy",
                                   file.string(), j.at("format").dump(), anatomy_format));
    refuse_other_keys(folder, j.at("keys"), s);
    for (const auto& [name, x] : j.at("landmarks").items()) a.landmarks[name] = Vec3(x.at(0), x.at(1), x.at(2));
    a.requested = numbers(j.at("requested")), a.measured = numbers(j.at("measured"));
    a.warnings = j.at("warnings").get<std::vector<std::string>>();
    for (auto* body : {&a.fetus, &a.uterus, &a.abdomen}) {
      const std::string name = body == &a.fetus ? "fetus" : body == &a.uterus ? "uterus" : "abdomen";
      try {
        BodyFile vtu(folder / (name + ".vtu"));
        *body = vtu.body(name);
        if (j.at("meshes").at(name) != hash_of(body->mesh)) vtu.refuse("is not the mesh that anatomy.json describes");
        if (body == &a.uterus) a.uterine_wall = vtu.wall_frames();
      } catch (const InputError& error) {
        problems.insert(problems.end(), error.problems().begin(), error.problems().end());
      }
    }
  } catch (const Json::exception& error) {
    throw InputError(fmt::format("{}: is damaged or truncated ({}); write the folder again with carus anatomy",
                                 file.string(), error.what()));
  }
  if (!problems.empty()) throw InputError(problems);
  return a;
}

}  // namespace carus::results
