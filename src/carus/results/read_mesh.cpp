// SPDX-License-Identifier: Apache-2.0
#include "carus/results/read_mesh.hpp"

#include <fmt/format.h>
#include <vtkCellData.h>
#include <vtkDataArray.h>
#include <vtkFieldData.h>
#include <vtkPointData.h>
#include <vtkSmartPointer.h>
#include <vtkStringArray.h>
#include <vtkUnstructuredGrid.h>

#include <cmath>
#include <map>

#include "carus/core/error.hpp"
#include "carus/results/export.hpp"
#include "carus/results/vtu_file.hpp"

namespace carus::results {
namespace {

namespace fs = std::filesystem;

class VtuFile {
 public:
  explicit VtuFile(fs::path file)
      : file_(std::move(file)), grid_(read_vtu(file_, [this](const std::string& what) { refuse(what); })) {}

  mesh::NamedMesh read() {
    mesh::NamedMesh m;
    read_points(m.mesh);
    read_cells(m);
    read_point_sets(m);
    read_fields(m);
    return m;
  }

 private:
  [[noreturn]] void refuse(const std::string& what) const {
    throw InputError(fmt::format("{}: {}; allowed a whole VTU file of linear tetrahedra", file_.string(), what));
  }

  void read_points(mesh::TetMesh& m) {
    m.nodes.resize(std::size_t(grid_->GetNumberOfPoints()));
    for (std::size_t i = 0; i < m.nodes.size(); ++i) {
      grid_->GetPoint(vtkIdType(i), m.nodes[i].data());
      if (!m.nodes[i].allFinite()) refuse(fmt::format("point {} is not finite", i));
    }
  }

  /// Integers of the cells, or null.
  vtkDataArray* numbers(const char* name) {
    auto* array = vtkDataArray::SafeDownCast(grid_->GetCellData()->GetAbstractArray(name));
    if (array == nullptr || array->GetNumberOfComponents() != 1 ||
        array->GetNumberOfTuples() != grid_->GetNumberOfCells())
      return nullptr;
    return array;
  }

  /// Names of a number: of field data `NAME_names`, or "NAME N".
  std::string name_of(const std::string& array, int number) {
    auto* names = vtkStringArray::SafeDownCast(grid_->GetFieldData()->GetAbstractArray((array + "_names").c_str()));
    if (names != nullptr && number >= 0 && number < names->GetNumberOfValues()) return names->GetValue(number);
    return fmt::format("{} {}", array, number);
  }

  void read_cells(mesh::NamedMesh& m) {
    vtkDataArray* region = numbers("region");
    if (region == nullptr) region = numbers("label");
    vtkDataArray* surface = numbers("surface");
    std::map<int, std::int32_t> label_of;
    std::map<std::string, std::size_t> surface_of;
    for (vtkIdType e = 0; e < grid_->GetNumberOfCells(); ++e) {
      vtkIdType count = 0;
      const vtkIdType* points = nullptr;
      grid_->GetCellPoints(e, count, points);
      const int type = grid_->GetCellType(e);
      if (type == VTK_TETRA && count == 4) {
        const int number = region == nullptr ? 0 : int(region->GetTuple1(e));
        const auto [it, fresh] = label_of.try_emplace(number, std::int32_t(m.regions.size()));
        if (fresh) m.regions.push_back(region == nullptr ? "" : name_of(region->GetName(), number));
        m.mesh.tets.push_back(
            {checked(points[0], m), checked(points[1], m), checked(points[2], m), checked(points[3], m)});
        m.mesh.labels.push_back(it->second);
      } else if (type == VTK_TRIANGLE && count == 3) {
        vtkDataArray* by = surface != nullptr ? surface : region;
        const std::string name = by == nullptr ? "surface" : name_of(by->GetName(), int(by->GetTuple1(e)));
        const auto [it, fresh] = surface_of.try_emplace(name, m.surfaces.size());
        if (fresh) m.surfaces.push_back({name, {}});
        m.surfaces[it->second].triangles.push_back(
            {checked(points[0], m), checked(points[1], m), checked(points[2], m)});
      } else if (type != VTK_VERTEX && type != VTK_LINE) {
        refuse(fmt::format("cell {} is of VTK type {}; a tetrahedron is 10, a triangle of a surface 5", e, type));
      }
    }
    if (m.mesh.tets.empty()) refuse("has no tetrahedra");
  }

  void read_point_sets(mesh::NamedMesh& m) {
    vtkPointData& data = *grid_->GetPointData();
    for (int k = 0; k < data.GetNumberOfArrays(); ++k) {
      auto* array = data.GetArray(k);
      if (array == nullptr || array->GetName() == nullptr || array->GetNumberOfComponents() != 1 ||
          array->GetDataType() == VTK_FLOAT || array->GetDataType() == VTK_DOUBLE)
        continue;
      mesh::NamedNodes set{array->GetName(), {}};
      for (vtkIdType i = 0; i < array->GetNumberOfTuples(); ++i) {
        if (array->GetTuple1(i) != 0) set.nodes.push_back(std::int32_t(i));
      }
      m.nodes.push_back(std::move(set));
    }
  }

  void read_fields(mesh::NamedMesh& m) {
    vtkFieldData& fields = *grid_->GetFieldData();
    for (int k = 0; k < fields.GetNumberOfArrays(); ++k) {
      auto* array = fields.GetArray(k);
      const std::string key = array != nullptr && array->GetName() != nullptr ? array->GetName() : "";
      const auto index = [&](vtkIdType i, int c) { return checked(vtkIdType(array->GetComponent(i, c)), m); };
      if (key.starts_with(nodes_prefix) && array->GetNumberOfComponents() == 1) {
        mesh::NamedNodes set{key.substr(std::string(nodes_prefix).size()), {}};
        for (vtkIdType i = 0; i < array->GetNumberOfTuples(); ++i) set.nodes.push_back(index(i, 0));
        m.nodes.push_back(std::move(set));
      } else if (key.starts_with(surface_prefix) && array->GetNumberOfComponents() == 3) {
        mesh::NamedSurface s{key.substr(std::string(surface_prefix).size()), {}};
        for (vtkIdType i = 0; i < array->GetNumberOfTuples(); ++i)
          s.triangles.push_back({index(i, 0), index(i, 1), index(i, 2)});
        m.surfaces.push_back(std::move(s));
      }
    }
  }

  std::int32_t checked(vtkIdType node, const mesh::NamedMesh& m) const {
    if (node < 0 || node >= vtkIdType(m.mesh.nodes.size()))
      refuse(fmt::format("names the node {}, of {}", node, m.mesh.nodes.size()));
    return std::int32_t(node);
  }

  fs::path file_;
  vtkSmartPointer<vtkUnstructuredGrid> grid_;
};

}  // namespace

mesh::NamedMesh read_vtu(const fs::path& file) { return VtuFile(file).read(); }

}  // namespace carus::results
