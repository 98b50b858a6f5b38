// SPDX-License-Identifier: Apache-2.0
// The two formats whose readers in VTK stand damaged files (docs/theory/geometry.md): their result is checked, no more.
#include <fmt/format.h>
#include <vtkNew.h>
#include <vtkSTLReader.h>
#include <vtkXMLPolyDataReader.h>

#include "carus/core/error.hpp"
#include "carus/imaging/bytes.hpp"
#include "carus/imaging/read_surface.hpp"
#include "carus/imaging/vtk_surface.hpp"

namespace carus::imaging {

mesh::Surface read_stl(const std::filesystem::path& file) {
  const std::string name = file.string();
  {
    const auto bytes = read_bytes(file);
    const bool text = bytes.starts_with("solid");
    const auto promised =
        bytes.size() >= 84 ? 84 + 50 * static_cast<std::size_t>(number_at<std::uint32_t>(bytes, 80)) : std::size_t(84);
    if (promised != bytes.size() && !text)
      throw InputError(fmt::format("{}: is truncated, or no STL file: {} bytes, its header promises {}", name,
                                   bytes.size(), promised));
    if (promised != bytes.size() && bytes.find("endsolid") == std::string::npos)
      throw InputError(fmt::format("{}: is truncated: its text has no endsolid", name));
  }
  vtkNew<vtkSTLReader> reader;
  reader->SetFileName(file.c_str());
  reader->MergingOff();  // mesh::closed does, and tells
  run(*reader, name);
  return from_vtk(*reader->GetOutput());
}

mesh::Surface read_vtp(const std::filesystem::path& file) {
  static_cast<void>(read_bytes(file).size());
  vtkNew<vtkXMLPolyDataReader> reader;
  reader->SetFileName(file.c_str());
  run(*reader, file.string());
  return from_vtk(*reader->GetOutput());
}

}  // namespace carus::imaging
