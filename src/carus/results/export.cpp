// SPDX-License-Identifier: Apache-2.0
#include "carus/results/export.hpp"

#include <fmt/format.h>
#include <vtkCellArray.h>
#include <vtkCellData.h>
#include <vtkNew.h>
#include <vtkPoints.h>
#include <vtkPolyData.h>
#include <vtkSTLWriter.h>

#include <nlohmann/json.hpp>
#include <set>

#include "carus/core/error.hpp"
#include "carus/results/files.hpp"
#include "carus/results/vtk_grid.hpp"

namespace carus::results {

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

void write_body(const anatomy::Body& body, const std::filesystem::path& file) {
  const auto grid = tet_grid(body.mesh.nodes, body.mesh.tets);
  set_integers(*grid->GetCellData(), "label", body.mesh.labels);
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

std::vector<std::string> export_anatomy(const anatomy::Anatomy& anatomy, const std::filesystem::path& folder) {
  std::vector<std::string> files;
  const auto named = [&](const std::string& name) { return files.push_back(name), folder / name; };
  for (const auto* body : {&anatomy.fetus, &anatomy.uterus, &anatomy.abdomen}) {
    const std::set<std::int32_t> labels(body->mesh.labels.begin(), body->mesh.labels.end());
    for (const auto label : labels) {
      const auto surface = mesh::boundary(body->mesh, [=](std::int32_t l) { return l == label; });
      write_stl(body->mesh, surface, named(fmt::format("{}.stl", anatomy::name_of(label))));
    }
    write_stl(body->mesh, mesh::boundary(body->mesh), named(body->name + "_whole.stl"));
    write_body(*body, named(body->name + ".vtu"));
  }
  write_landmarks(anatomy, named("landmarks.json"));
  return files;
}

}  // namespace carus::results
