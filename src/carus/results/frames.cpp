// SPDX-License-Identifier: Apache-2.0
#include "carus/results/frames.hpp"

#include <fmt/format.h>
#include <vtkCellData.h>
#include <vtkPointData.h>

#include <algorithm>

#include "carus/results/files.hpp"
#include "carus/results/vtk_grid.hpp"

namespace carus::results {

struct Frames::Grid {
  vtkSmartPointer<vtkUnstructuredGrid> vtk;
};

Frames::Frames(std::filesystem::path folder, const fem::Model& model, const observe::Strain& strain, double labour_per_pseudo,
               std::vector<double> times)
    : folder_(std::move(folder)), model_(model), strain_(strain), labour_per_pseudo_(labour_per_pseudo), times_(std::move(times)),
      grid_(std::make_unique<Grid>()) {
  std::filesystem::create_directories(folder_ / "frames");
  grid_->vtk = tet_grid(model.mesh.nodes, model.mesh.tets);
  std::vector<std::string> regions, organs;
  std::vector<std::int32_t> organ_of_region, organ;
  for (const auto& r : model.regions) {
    regions.push_back(r.name);
    const auto it = std::find(organs.begin(), organs.end(), r.organ);
    organ_of_region.push_back(std::int32_t(it - organs.begin()));
    if (it == organs.end()) organs.push_back(r.organ);
  }
  for (const auto label : model.mesh.labels) organ.push_back(organ_of_region[label]);
  set_integers(*grid_->vtk->GetCellData(), "region", model.mesh.labels);
  set_integers(*grid_->vtk->GetCellData(), "organ", organ);
  set_names(*grid_->vtk, "region_names", regions);
  set_names(*grid_->vtk, "organ_names", organs);
  write_index();
}

Frames::~Frames() = default;

void Frames::write(const fem::State& state, const std::vector<Vec3>& contact_force) {
  auto& grid = *grid_->vtk;
  set_points(grid, state.x);
  std::vector<Vec3> displacement(state.x.size());
  for (std::size_t i = 0; i < displacement.size(); ++i) displacement[i] = state.x[i] - model_.mesh.nodes[i];
  set_vectors(*grid.GetPointData(), "displacement", displacement);
  set_vectors(*grid.GetPointData(), "velocity", state.v, 1 / labour_per_pseudo_);
  set_vectors(*grid.GetPointData(), "contact_force",
              contact_force.empty() ? std::vector<Vec3>(state.x.size(), Vec3::Zero()) : contact_force);
  const auto strain = strain_.field(state.x);
  set_scalars(*grid.GetCellData(), "J", strain.J);
  set_scalars(*grid.GetCellData(), "max_stretch", strain.stretch);
  write_atomically(folder_ / "frames" / fmt::format("frame_{:04}.vtu", times_.size()),
                   [&](const std::filesystem::path& file) { write_vtu(grid, file); });
  times_.push_back(state.time);
  write_index();
}

void Frames::write_index() const {
  std::string text = "<?xml version=\"1.0\"?>\n<VTKFile type=\"Collection\" version=\"0.1\" byte_order=\"LittleEndian\">\n  <Collection>\n";
  for (std::size_t i = 0; i < times_.size(); ++i) {
    text += fmt::format("    <DataSet timestep=\"{}\" part=\"0\" file=\"frames/frame_{:04}.vtu\"/>\n", times_[i], i);
  }
  write_atomically(folder_ / "frames.pvd", text + "  </Collection>\n</VTKFile>\n");
}

}  // namespace carus::results
