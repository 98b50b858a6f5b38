// SPDX-License-Identifier: Apache-2.0
#include "carus/report/frame_file.hpp"

#include <fmt/format.h>
#include <vtkCallbackCommand.h>
#include <vtkCellData.h>
#include <vtkDataArraySelection.h>
#include <vtkFieldData.h>
#include <vtkFloatArray.h>
#include <vtkIntArray.h>
#include <vtkNew.h>
#include <vtkPointData.h>
#include <vtkSmartPointer.h>
#include <vtkStringArray.h>
#include <vtkUnstructuredGrid.h>
#include <vtkXMLUnstructuredGridReader.h>

#include <cmath>
#include <cstdlib>
#include <fstream>
#include <new>
#include <optional>
#include <string_view>

#include "carus/core/error.hpp"
#include "carus/results/files.hpp"

namespace carus::report {
namespace {

namespace fs = std::filesystem;

constexpr const char* advice = "run the birth again, or go on with carus run --resume";

/// A frame as VTK reads it. Only the arrays that are asked for are unpacked.
class VtuFile {
 public:
  VtuFile(fs::path file, const std::vector<const char*>& point_arrays, const std::vector<const char*>& cell_arrays)
      : file_(std::move(file)) {
    if (!fs::is_regular_file(file_)) refuse("no such file");
    if (!is_whole()) refuse("is no VTU file, or is cut off");  // VTK does not miss what follows the last block
    bool broken = false;
    vtkNew<vtkCallbackCommand> on_error;
    on_error->SetClientData(&broken);
    on_error->SetCallback([](vtkObject*, unsigned long, void* flag, void*) { *static_cast<bool*>(flag) = true; });
    vtkNew<vtkXMLUnstructuredGridReader> reader;
    for (const unsigned long event : {vtkCommand::ErrorEvent, vtkCommand::WarningEvent})
      reader->AddObserver(event, on_error);
    reader->SetReaderErrorObserver(on_error);
    reader->SetParserErrorObserver(on_error);
    if (!reader->CanReadFile(file_.c_str())) refuse("is no VTU file of an unstructured grid");
    reader->SetFileName(file_.c_str());
    try {
      reader->UpdateInformation();
      if (broken) refuse("is damaged");
      select(*reader->GetPointDataArraySelection(), point_arrays);
      select(*reader->GetCellDataArraySelection(), cell_arrays);
      reader->Update();
    } catch (const std::bad_alloc&) {
      refuse("announces more than memory holds: is damaged");
    }
    grid_ = reader->GetOutput();
    if (broken || grid_ == nullptr || reader->GetErrorCode() != 0) refuse("is damaged");
    if (grid_->GetPoints() == nullptr || grid_->GetNumberOfPoints() == 0) refuse("has no points");
    if (vtkFloatArray::SafeDownCast(grid_->GetPoints()->GetData()) == nullptr)
      refuse("has points that are not Float32");
  }

  [[nodiscard]] std::size_t nodes() const { return std::size_t(grid_->GetNumberOfPoints()); }
  [[nodiscard]] std::size_t cells() const { return std::size_t(grid_->GetNumberOfCells()); }

  [[nodiscard]] std::vector<std::array<float, 3>> positions() const {
    return triples(*vtkFloatArray::SafeDownCast(grid_->GetPoints()->GetData()), "Points");
  }
  [[nodiscard]] std::vector<std::array<float, 3>> node_vectors(const char* name) const {
    return triples(*array<vtkFloatArray>(*grid_->GetPointData(), name, 3, nodes()), name);
  }
  [[nodiscard]] std::vector<float> cell_scalars(const char* name) const {
    const auto* a = array<vtkFloatArray>(*grid_->GetCellData(), name, 1, cells());
    const float* p = const_cast<vtkFloatArray*>(a)->GetPointer(0);
    std::vector<float> out(p, p + cells());
    for (const float v : out) finite(v, name);
    return out;
  }
  [[nodiscard]] std::vector<std::int32_t> cell_integers(const char* name, std::size_t names) const {
    auto* a = array<vtkIntArray>(*grid_->GetCellData(), name, 1, cells());
    std::vector<std::int32_t> out(cells());
    for (std::size_t e = 0; e < out.size(); ++e) {
      out[e] = a->GetValue(vtkIdType(e));
      if (out[e] < 0 || std::size_t(out[e]) >= names)
        refuse(fmt::format("cell {} has {} {}; allowed 0 to {}", e, name, out[e], names - 1));
    }
    return out;
  }
  [[nodiscard]] std::vector<std::string> names(const char* name) const {
    auto* a = vtkStringArray::SafeDownCast(grid_->GetFieldData()->GetAbstractArray(name));
    if (a == nullptr || a->GetNumberOfValues() == 0)
      refuse(fmt::format("has no field data \"{}\": no frame of carus", name));
    std::vector<std::string> out;
    for (vtkIdType i = 0; i < a->GetNumberOfValues(); ++i) out.push_back(a->GetValue(i));
    return out;
  }
  [[nodiscard]] std::vector<mesh::Tet> tets() const {
    std::vector<mesh::Tet> out(cells());
    for (std::size_t e = 0; e < out.size(); ++e) {
      vtkIdType count = 0;
      const vtkIdType* points = nullptr;
      grid_->GetCellPoints(vtkIdType(e), count, points);
      if (grid_->GetCellType(vtkIdType(e)) != VTK_TETRA || count != 4)
        refuse(fmt::format("cell {} is no tetrahedron", e));
      for (std::size_t k = 0; k < 4; ++k) {
        if (points[k] < 0 || std::size_t(points[k]) >= nodes())
          refuse(fmt::format("cell {} has the corner {}; allowed 0 to {}", e, points[k], nodes() - 1));
        out[e][k] = std::int32_t(points[k]);
      }
    }
    return out;
  }

  [[noreturn]] void refuse(const std::string& what) const {
    throw InputError(fmt::format("{}: {}; {}", file_.string(), what, advice));
  }

 private:
  [[nodiscard]] bool is_whole() const {
    std::ifstream in(file_, std::ios::binary);
    in.seekg(0, std::ios::end);
    const auto size = std::streamoff(in.tellg());
    const auto tail = std::min<std::streamoff>(size, 64);
    std::string text(std::size_t(std::max<std::streamoff>(tail, 0)), '\0');
    in.seekg(size - tail);
    in.read(text.data(), tail);
    const auto end = text.find_last_not_of(" \r\n");
    return in && end != std::string::npos && std::string_view(text).substr(0, end + 1).ends_with("</VTKFile>");
  }

  static void select(vtkDataArraySelection& selection, const std::vector<const char*>& wanted) {
    selection.DisableAllArrays();
    for (const char* name : wanted) {
      if (selection.ArrayExists(name)) selection.EnableArray(name);
    }
  }

  template <class Array>
  [[nodiscard]] Array* array(vtkDataSetAttributes& data, const char* name, int components, std::size_t tuples) const {
    auto* a = Array::SafeDownCast(data.GetArray(name));
    if (a == nullptr || a->GetNumberOfComponents() != components || std::size_t(a->GetNumberOfTuples()) != tuples)
      refuse(fmt::format("has no array \"{}\" of {} x {}: no frame of carus", name, tuples, components));
    return a;
  }

  [[nodiscard]] std::vector<std::array<float, 3>> triples(vtkFloatArray& a, const char* name) const {
    std::vector<std::array<float, 3>> out(std::size_t(a.GetNumberOfTuples()));
    const float* p = a.GetPointer(0);
    for (auto& v : out) {
      for (float& c : v) c = finite(*p++, name);
    }
    return out;
  }
  float finite(float v, const char* name) const {
    if (!std::isfinite(v)) refuse(fmt::format("\"{}\" holds a value that is not finite", name));
    return v;
  }

  fs::path file_;
  vtkSmartPointer<vtkUnstructuredGrid> grid_;
};

/// The value of an attribute of one XML element's text.
std::optional<std::string> attribute(std::string_view element, std::string_view name) {
  const auto key = fmt::format(" {}=\"", name);
  const auto begin = element.find(key);
  if (begin == std::string_view::npos) return {};
  const auto end = element.find('"', begin + key.size());
  if (end == std::string_view::npos) return {};
  return std::string(element.substr(begin + key.size(), end - begin - key.size()));
}

}  // namespace

FrameMesh read_frame_mesh(const fs::path& file) {
  const VtuFile vtu(file, {"displacement"}, {"region", "organ"});
  FrameMesh m;
  m.tets = vtu.tets();
  m.regions = vtu.names("region_names"), m.organs = vtu.names("organ_names");
  m.labels = vtu.cell_integers("region", m.regions.size()), m.organ = vtu.cell_integers("organ", m.organs.size());
  const auto x = vtu.positions(), u = vtu.node_vectors("displacement");
  for (std::size_t i = 0; i < x.size(); ++i)
    m.nodes.emplace_back(x[i][0] - u[i][0], x[i][1] - u[i][1], x[i][2] - u[i][2]);
  return m;
}

FrameState read_frame_state(const fs::path& file, std::size_t nodes, std::size_t tets) {
  const VtuFile vtu(file, {"contact_force"}, {"J", "max_stretch"});
  if (vtu.nodes() != nodes || vtu.cells() != tets)
    vtu.refuse(fmt::format("has {} nodes and {} cells, the frames before {} and {}: the folder holds two runs",
                           vtu.nodes(), vtu.cells(), nodes, tets));
  return {vtu.positions(), vtu.node_vectors("contact_force"), vtu.cell_scalars("J"), vtu.cell_scalars("max_stretch")};
}

std::vector<FrameEntry> read_frame_index(const fs::path& pvd) {
  const std::string text = results::read_text(pvd);
  const auto refuse = [&](const std::string& what) {
    throw InputError(fmt::format("{}: {}; {}", pvd.string(), what, advice));
  };
  if (text.find("<Collection>") == std::string::npos || text.find("</VTKFile>") == std::string::npos)
    refuse("is no ParaView collection, or is cut off");
  std::vector<FrameEntry> frames;
  constexpr std::string_view open = "<DataSet";
  for (auto at = text.find(open); at != std::string::npos; at = text.find(open, at + open.size())) {
    const auto end = text.find("/>", at);
    if (end == std::string::npos) refuse(fmt::format("the element of frame {} does not end", frames.size()));
    const auto element = std::string_view(text).substr(at, end - at);
    const auto time = attribute(element, "timestep"), name = attribute(element, "file");
    if (!time || !name) refuse(fmt::format("frame {} has no timestep or no file", frames.size()));
    char* rest = nullptr;
    const double t = std::strtod(time->c_str(), &rest);
    if (time->empty() || *rest != '\0' || !std::isfinite(t) || (!frames.empty() && t <= frames.back().time))
      refuse(fmt::format("frame {} has the timestep \"{}\"; allowed are increasing numbers", frames.size(), *time));
    const fs::path relative(*name);
    for (const auto& part : relative) {
      if (relative.is_absolute() || part == "..")
        refuse(fmt::format("frame {} is \"{}\"; allowed are files inside the folder", frames.size(), *name));
    }
    frames.push_back({t, pvd.parent_path() / relative});
  }
  return frames;
}

}  // namespace carus::report
