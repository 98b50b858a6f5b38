// SPDX-License-Identifier: Apache-2.0
#include "carus/results/vtk_grid.hpp"

#include <fmt/format.h>
#include <vtkCellArray.h>
#include <vtkCellData.h>
#include <vtkDataSetAttributes.h>
#include <vtkFieldData.h>
#include <vtkFloatArray.h>
#include <vtkIntArray.h>
#include <vtkNew.h>
#include <vtkPointData.h>
#include <vtkPoints.h>
#include <vtkStringArray.h>
#include <vtkXMLUnstructuredGridWriter.h>

#include "carus/core/error.hpp"

namespace carus::results {
namespace {

template <class Array>
auto* add_array(vtkDataSetAttributes& to, const char* name, int components, std::size_t tuples) {
  vtkNew<Array> array;
  array->SetName(name);
  array->SetNumberOfComponents(components);
  array->SetNumberOfTuples(vtkIdType(tuples));
  to.AddArray(array);
  return array->GetPointer(0);
}

}  // namespace

vtkSmartPointer<vtkUnstructuredGrid> tet_grid(const std::vector<Vec3>& x, const std::vector<mesh::Tet>& tets,
                                              Precision of_points) {
  vtkNew<vtkPoints> points;
  points->SetDataType(of_points == Precision::full ? VTK_DOUBLE : VTK_FLOAT);
  points->SetNumberOfPoints(vtkIdType(x.size()));
  for (std::size_t i = 0; i < x.size(); ++i) points->SetPoint(vtkIdType(i), x[i].data());
  vtkNew<vtkUnstructuredGrid> grid;
  grid->SetPoints(points);
  vtkNew<vtkCellArray> cells;
  cells->Use32BitStorage();
  for (const auto& t : tets) cells->InsertNextCell({t[0], t[1], t[2], t[3]});
  grid->SetCells(VTK_TETRA, cells);
  return grid;
}

void set_vectors(vtkDataSetAttributes& to, const char* name, const std::vector<Vec3>& values, double scale) {
  float* p = add_array<vtkFloatArray>(to, name, 3, values.size());
  for (const Vec3& v : values) {
    for (int k = 0; k < 3; ++k) *p++ = float(scale * v[k]);
  }
}

void set_scalars(vtkDataSetAttributes& to, const char* name, const std::vector<double>& values) {
  float* p = add_array<vtkFloatArray>(to, name, 1, values.size());
  for (const double v : values) *p++ = float(v);
}

void set_integers(vtkDataSetAttributes& to, const char* name, const std::vector<std::int32_t>& values) {
  std::copy(values.begin(), values.end(), add_array<vtkIntArray>(to, name, 1, values.size()));
}

void set_names(vtkUnstructuredGrid& grid, const char* name, const std::vector<std::string>& values) {
  vtkNew<vtkStringArray> names;
  names->SetName(name);
  for (const auto& v : values) names->InsertNextValue(v);
  grid.GetFieldData()->AddArray(names);
}

void write_vtu(vtkUnstructuredGrid& grid, const std::filesystem::path& file) {
  vtkNew<vtkXMLUnstructuredGridWriter> writer;
  writer->SetInputData(&grid);
  writer->SetFileName(file.c_str());
  writer->SetDataModeToAppended();
  writer->EncodeAppendedDataOff();
  writer->SetHeaderTypeToUInt32();
  writer->SetIdTypeToInt32();
  writer->SetCompressorTypeToZLib();
  writer->SetCompressionLevel(1);
  if (!writer->Write())
    throw InputError(fmt::format("{}: cannot be written; is the disk full, or the folder read-only?", file.string()));
}

}  // namespace carus::results
