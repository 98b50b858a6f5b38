// SPDX-License-Identifier: Apache-2.0
#include "carus/imaging/vtk_surface.hpp"

#include <fmt/format.h>
#include <vtkCallbackCommand.h>
#include <vtkCellArray.h>
#include <vtkCellArrayIterator.h>
#include <vtkExecutive.h>
#include <vtkNew.h>
#include <vtkPoints.h>
#include <vtkXMLReader.h>

#include "carus/core/error.hpp"

namespace carus::imaging {

vtkSmartPointer<vtkPolyData> to_vtk(const mesh::Surface& s, double scale) {
  vtkNew<vtkPoints> points;
  points->SetDataTypeToFloat();
  points->SetNumberOfPoints(vtkIdType(s.nodes.size()));
  for (std::size_t i = 0; i < s.nodes.size(); ++i) points->SetPoint(vtkIdType(i), Vec3(scale * s.nodes[i]).data());
  vtkNew<vtkCellArray> cells;
  cells->Use32BitStorage();
  cells->AllocateExact(vtkIdType(s.triangles.size()), vtkIdType(3 * s.triangles.size()));
  for (const auto& t : s.triangles) cells->InsertNextCell({t[0], t[1], t[2]});
  auto data = vtkSmartPointer<vtkPolyData>::New();
  data->SetPoints(points);
  data->SetPolys(cells);
  return data;
}

mesh::Surface from_vtk(vtkPolyData& data) {
  mesh::Surface s;
  s.nodes.resize(static_cast<std::size_t>(data.GetNumberOfPoints()));
  for (std::size_t i = 0; i < s.nodes.size(); ++i) data.GetPoint(vtkIdType(i), s.nodes[i].data());
  const auto cells = vtk::TakeSmartPointer(data.GetPolys()->NewIterator());
  for (cells->GoToFirstCell(); !cells->IsDoneWithTraversal(); cells->GoToNextCell()) {
    vtkIdType n = 0;
    const vtkIdType* p = nullptr;
    cells->GetCurrentCell(n, p);
    for (vtkIdType k = 2; k < n; ++k)
      s.triangles.push_back(
          {static_cast<std::int32_t>(p[0]), static_cast<std::int32_t>(p[k - 1]), static_cast<std::int32_t>(p[k])});
  }
  return s;
}

void run(vtkAlgorithm& algorithm, const std::string& name) {
  std::string problem;
  vtkNew<vtkCallbackCommand> listener;
  listener->SetClientData(&problem);
  listener->SetCallback([](vtkObject*, unsigned long, void* to, void* text) {
    auto& first = *static_cast<std::string*>(to);
    if (first.empty()) first = text != nullptr ? static_cast<const char*>(text) : "unknown";
  });
  const auto tag = algorithm.AddObserver(vtkCommand::ErrorEvent, listener);
  const auto warnings = algorithm.AddObserver(vtkCommand::WarningEvent, listener);
  const auto executive = algorithm.GetExecutive()->AddObserver(vtkCommand::ErrorEvent, listener);  // it repeats them
  auto* xml = vtkXMLReader::SafeDownCast(&algorithm);
  if (xml != nullptr) xml->SetParserErrorObserver(listener);
  algorithm.Update();
  if (xml != nullptr) xml->SetParserErrorObserver(nullptr);
  algorithm.RemoveObserver(tag);
  algorithm.RemoveObserver(warnings);
  algorithm.GetExecutive()->RemoveObserver(executive);
  if (problem.empty()) return;
  while (!problem.empty() && std::isspace(static_cast<unsigned char>(problem.back())) != 0) problem.pop_back();
  const auto end_of_place = problem.find("): ");  // "ERROR: In file, line n\nClass (0x...): what"
  throw InputError(
      fmt::format("{}: {}", name, end_of_place == std::string::npos ? problem : problem.substr(end_of_place + 3)));
}

}  // namespace carus::imaging
