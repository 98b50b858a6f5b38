// SPDX-License-Identifier: Apache-2.0
#include "carus/results/export.hpp"

#include <fmt/format.h>
#include <vtkCellArray.h>
#include <vtkCellData.h>
#include <vtkDoubleArray.h>
#include <vtkFieldData.h>
#include <vtkIntArray.h>
#include <vtkNew.h>
#include <vtkPoints.h>
#include <vtkPolyData.h>
#include <vtkSTLWriter.h>

#include <algorithm>
#include <nlohmann/json.hpp>
#include <set>

#include "carus/core/error.hpp"
#include "carus/results/checkpoint.hpp"
#include "carus/results/files.hpp"
#include "carus/results/vtk_grid.hpp"

namespace carus::results {
namespace {

template <class Write>
void add_doubles(vtkCellData& to, const char* name, int components, const std::vector<anatomy::WallFrame>& wall,
                 Write&& write) {
  vtkNew<vtkDoubleArray> array;
  array->SetName(name);
  array->SetNumberOfComponents(components);
  array->SetNumberOfTuples(vtkIdType(wall.size()));
  for (std::size_t e = 0; e < wall.size(); ++e) write(wall[e], array->GetPointer(vtkIdType(e) * components));
  to.AddArray(array);
}

void add_indices(vtkUnstructuredGrid& grid, const std::string& name, int components, const std::int32_t* values,
                 std::size_t tuples) {
  if (tuples == 0) return;
  vtkNew<vtkIntArray> array;
  array->SetName(name.c_str());
  array->SetNumberOfComponents(components);
  array->SetNumberOfTuples(vtkIdType(tuples));
  std::copy(values, values + tuples * std::size_t(components), array->GetPointer(0));
  grid.GetFieldData()->AddArray(array);
}

}  // namespace

void write_stl(const mesh::TetMesh& mesh, const mesh::Triangles& triangles, const std::filesystem::path& file) {
  vtkNew<vtkPoints> points;
  for (const Vec3& x : mesh.nodes) points->InsertNextPoint(1e3 * x.x(), 1e3 * x.y(), 1e3 * x.z());
  vtkNew<vtkCellArray> cells;
  for (const auto& t : triangles) cells->InsertNextCell({t[0], t[1], t[2]});
  vtkNew<vtkPolyData> surface;
  surface->SetPoints(points);
  surface->SetPolys(cells);
  vtkNew<vtkSTLWriter> writer;
  writer->SetInputData(surface);
  writer->SetFileTypeToBinary();
  write_atomically(file, [&](const std::filesystem::path& temporary) {
    writer->SetFileName(temporary.c_str());
    if (!writer->Write()) throw InputError(fmt::format("{}: cannot be written", file.string()));
  });
}

void write_body(const anatomy::Body& body, const std::vector<anatomy::WallFrame>& wall,
                const std::filesystem::path& file) {
  const auto grid = tet_grid(body.mesh.nodes, body.mesh.tets, Precision::full);
  vtkCellData& cells = *grid->GetCellData();
  set_integers(cells, "label", body.mesh.labels);
  if (!wall.empty()) {
    add_doubles(cells, "meridian", 3, wall, [](const auto& w, double* p) { Eigen::Map<Vec3>{p} = w.meridian; });
    add_doubles(cells, "normal", 3, wall, [](const auto& w, double* p) { Eigen::Map<Vec3>{p} = w.normal; });
    add_doubles(cells, "s", 1, wall, [](const auto& w, double* p) { *p = w.s; });
    add_doubles(cells, "dome", 1, wall, [](const auto& w, double* p) { *p = w.dome; });
  }
  for (const auto& set : body.nodes) add_indices(*grid, nodes_prefix + set.name, 1, set.nodes.data(), set.nodes.size());
  for (const auto& s : body.surfaces)
    add_indices(*grid, surface_prefix + s.name, 3, s.triangles.empty() ? nullptr : s.triangles[0].data(),
                s.triangles.size());
  write_atomically(file, [&](const std::filesystem::path& temporary) { write_vtu(*grid, temporary); });
}

void write_landmarks(const anatomy::Anatomy& anatomy, const std::filesystem::path& file) {
  nlohmann::ordered_json j;
  for (const auto& [name, x] : anatomy.landmarks) {
    const double unit = name.ends_with("_normal") ? 1 : 1e3;
    j[name] = {{"x", unit * x.x()}, {"y", unit * x.y()}, {"z", unit * x.z()}};
  }
  write_atomically(file, j.dump(2) + "\n");
}

namespace {

/// Numbers read back to the same doubles.
void write_anatomy_file(const anatomy::Anatomy& a, const std::map<std::string, std::string>& keys,
                        const std::filesystem::path& file) {
  nlohmann::ordered_json j{{"format", anatomy_format}, {"keys", keys}};
  for (const auto* body : {&a.fetus, &a.uterus, &a.abdomen}) j["meshes"][body->name] = hash_of(body->mesh);
  j["landmarks"] = nlohmann::ordered_json::object();
  for (const auto& [name, x] : a.landmarks) j["landmarks"][name] = {x.x(), x.y(), x.z()};
  j["requested"] = a.requested, j["measured"] = a.measured, j["warnings"] = a.warnings;
  write_atomically(file, j.dump(2) + "\n");
}

}  // namespace

std::vector<std::string> export_anatomy(const anatomy::Anatomy& anatomy, const std::map<std::string, std::string>& keys,
                                        const std::filesystem::path& folder) {
  std::vector<std::string> files;
  const auto named = [&](const std::string& name) { return files.push_back(name), folder / name; };
  for (const auto* body : {&anatomy.fetus, &anatomy.uterus, &anatomy.abdomen}) {
    const std::set<std::int32_t> labels(body->mesh.labels.begin(), body->mesh.labels.end());
    for (const auto label : labels) {
      const auto surface = mesh::boundary(body->mesh, [=](std::int32_t l) { return l == label; });
      write_stl(body->mesh, surface, named(fmt::format("{}.stl", anatomy::name_of(label))));
    }
    write_stl(body->mesh, mesh::boundary(body->mesh), named(body->name + "_whole.stl"));
    write_body(*body, body == &anatomy.uterus ? anatomy.uterine_wall : std::vector<anatomy::WallFrame>{},
               named(body->name + ".vtu"));
  }
  write_landmarks(anatomy, named("landmarks.json"));
  write_anatomy_file(anatomy, keys, named(anatomy_file));
  return files;
}

}  // namespace carus::results
