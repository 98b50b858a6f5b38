// SPDX-License-Identifier: Apache-2.0
#include "carus/imaging/write_surface.hpp"

#include <fmt/format.h>
#include <vtkFloatArray.h>
#include <vtkNew.h>
#include <vtkPLYWriter.h>
#include <vtkPointData.h>
#include <vtkSTLWriter.h>
#include <vtkXMLPolyDataWriter.h>

#include "carus/core/atomic_file.hpp"
#include "carus/imaging/text_header.hpp"
#include "carus/imaging/vtk_surface.hpp"

namespace carus::imaging {
namespace {

template <class Writer>
void write(Writer& writer, vtkPolyData& data, const std::filesystem::path& file) {
  write_atomically(file, [&](const std::filesystem::path& temporary) {
    writer.SetInputData(&data);
    writer.SetFileName(temporary.c_str());
    if (writer.Write() == 0 || writer.GetErrorCode() != 0)
      throw InputError(fmt::format("{}: cannot be written; is the disk full, or the folder not there?", file.string()));
  });
}

}  // namespace

void write_surface(const mesh::Surface& s, const std::filesystem::path& file, const std::vector<NodeField>& fields) {
  const auto data = to_vtk(s, 1e3);
  for (const auto& f : fields) {
    vtkNew<vtkFloatArray> array;
    array->SetName(f.name.c_str());
    array->SetNumberOfTuples(vtkIdType(f.values.size()));
    for (std::size_t i = 0; i < f.values.size(); ++i) array->SetValue(vtkIdType(i), static_cast<float>(f.values[i]));
    data->GetPointData()->AddArray(array);
  }
  const auto kind = lower(file.extension().string());
  if (kind == ".stl") {
    vtkNew<vtkSTLWriter> writer;
    writer->SetFileTypeToBinary();
    write(*writer, *data, file);
  } else if (kind == ".ply") {
    vtkNew<vtkPLYWriter> writer;
    writer->SetFileTypeToBinary();
    write_atomically(file, [&](const std::filesystem::path& temporary) {
      writer->SetInputData(data);
      writer->SetFileName(temporary.c_str());
      if (writer->Write() == 0) throw InputError(fmt::format("{}: cannot be written", file.string()));
      // To a name that does not end so the writer adds ".ply".
      std::filesystem::rename(temporary.string() + ".ply", temporary);
    });
  } else if (kind == ".vtp") {
    vtkNew<vtkXMLPolyDataWriter> writer;
    writer->SetCompressionLevel(1);
    write(*writer, *data, file);
  } else {
    throw InputError(fmt::format("{}: surfaces are written as .stl, .ply or .vtp", file.string()));
  }
}

}  // namespace carus::imaging
