// SPDX-License-Identifier: Apache-2.0
#include "carus/results/frames.hpp"

#include <fmt/format.h>
#include <vtkCellData.h>
#include <vtkPointData.h>

#include <algorithm>

#include "carus/results/files.hpp"
#include "carus/results/vtk_grid.hpp"

namespace carus::results {

Frames::Frames(std::filesystem::path folder, const fem::Model& model, const observe::Strain& strain,
               std::vector<double> times)
    : folder_(std::move(folder)), model_(model), strain_(strain), times_(std::move(times)) {
  std::filesystem::create_directories(folder_ / "frames");
  std::vector<std::int32_t> organ_of_region;
  for (const auto& r : model.regions) {
    regions_.push_back(r.name);
    const auto it = std::find(organs_.begin(), organs_.end(), r.organ);
    organ_of_region.push_back(std::int32_t(it - organs_.begin()));
    if (it == organs_.end()) organs_.push_back(r.organ);
  }
  for (const auto label : model.mesh.labels) organ_.push_back(organ_of_region[label]);
  write_index();
}

void Frames::write(const fem::State& state, const std::vector<Vec3>& contact_force,
                   const std::function<void(vtkUnstructuredGrid&)>& more) {
  // A grid of its own for every frame: VTK keeps notes in arrays that it has written once, and a frame must not tell
  // which came before.
  const auto owned = tet_grid(state.x, model_.mesh.tets);
  auto& grid = *owned;
  set_integers(*grid.GetCellData(), "region", model_.mesh.labels);
  set_integers(*grid.GetCellData(), "organ", organ_);
  set_names(grid, "region_names", regions_);
  set_names(grid, "organ_names", organs_);
  std::vector<Vec3> displacement(state.x.size());
  for (std::size_t i = 0; i < displacement.size(); ++i) displacement[i] = state.x[i] - model_.mesh.nodes[i];
  set_vectors(*grid.GetPointData(), "displacement", displacement);
  set_vectors(*grid.GetPointData(), "velocity", state.v, 1 / state.labour_per_pseudo);
  set_vectors(*grid.GetPointData(), "contact_force",
              contact_force.empty() ? std::vector<Vec3>(state.x.size(), Vec3::Zero()) : contact_force);
  const auto strain = strain_.field(state.x);
  set_scalars(*grid.GetCellData(), "J", strain.J);
  set_scalars(*grid.GetCellData(), "max_stretch", strain.stretch);
  if (more) more(grid);
  write_atomically(folder_ / "frames" / fmt::format("frame_{:04}.vtu", times_.size()),
                   [&](const std::filesystem::path& file) { write_vtu(grid, file); });
  times_.push_back(state.time);
  write_index();
}

void Frames::write_index() const {
  std::string text =
      "<?xml version=\"1.0\"?>\n<VTKFile type=\"Collection\" version=\"0.1\" byte_order=\"LittleEndian\">\n  "
      "<Collection>\n";
  for (std::size_t i = 0; i < times_.size(); ++i) {
    text += fmt::format("    <DataSet timestep=\"{}\" part=\"0\" file=\"frames/frame_{:04}.vtu\"/>\n", times_[i], i);
  }
  write_atomically(folder_ / "frames.pvd", text + "  </Collection>\n</VTKFile>\n");
}

}  // namespace carus::results
