// SPDX-License-Identifier: Apache-2.0
#include "carus/results/vtu_file.hpp"

#include <vtkCallbackCommand.h>
#include <vtkNew.h>
#include <vtkUnstructuredGrid.h>
#include <vtkXMLUnstructuredGridReader.h>

#include <string_view>

#include "carus/results/files.hpp"

namespace carus::results {
namespace {

/// VTK does not miss what follows the last block.
bool is_whole(const std::filesystem::path& file) {
  const std::string text = read_text(file);
  const auto end = text.find_last_not_of(" \r\n");
  return end != std::string::npos && std::string_view(text).substr(0, end + 1).ends_with("</VTKFile>");
}

}  // namespace

vtkSmartPointer<vtkUnstructuredGrid> read_vtu(const std::filesystem::path& file,
                                              const std::function<void(const std::string& what)>& refuse) {
  if (!std::filesystem::is_regular_file(file)) refuse("no such file");
  if (!is_whole(file)) refuse("is not a VTU file, or is truncated");
  bool broken = false;
  vtkNew<vtkCallbackCommand> on_error;
  on_error->SetClientData(&broken);
  on_error->SetCallback([](vtkObject*, unsigned long, void* flag, void*) { *static_cast<bool*>(flag) = true; });
  vtkNew<vtkXMLUnstructuredGridReader> reader;
  reader->SetReaderErrorObserver(on_error);
  reader->SetParserErrorObserver(on_error);
  if (!reader->CanReadFile(file.c_str())) refuse("is not a VTU file of an unstructured grid");
  reader->SetFileName(file.c_str());
  reader->Update();
  vtkSmartPointer<vtkUnstructuredGrid> grid = reader->GetOutput();
  if (broken || grid == nullptr) refuse("is damaged or truncated");
  return grid;
}

}  // namespace carus::results
