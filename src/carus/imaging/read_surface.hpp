// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <string>
#include <string_view>

#include "carus/imaging/frame.hpp"
#include "carus/mesh/surface.hpp"

namespace carus::imaging {

/// A file of triangles, and what its author has to say about it since such files do not.
struct SurfaceSource {
  std::filesystem::path file;
  std::string unit, frame;  ///< see convention(); empty for glTF: metres and LSA, as its specification says
  std::string part;         ///< of a glTF file: only the node or mesh of this name; empty: all
};

/// The closed surface of a file, in RAS and metres: STL, OBJ, PLY, VTP, glTF and GLB, by the name's extension. Polygons
/// are cut into triangles. Repaired where that is safe (mesh::closed), else refused with place and count. Throws
/// InputError for whatever else is in the file.
mesh::Closed read_surface(const SurfaceSource& source);

/// The readers, in the file's own coordinates; nothing is checked but that the file is what it claims. `name` begins
/// messages.
mesh::Surface read_stl(const std::filesystem::path& file);
mesh::Surface read_vtp(const std::filesystem::path& file);
mesh::Surface read_ply(std::string_view bytes, const std::string& name);
mesh::Surface read_obj(std::string_view bytes, const std::string& name);
mesh::Surface read_gltf(std::string_view bytes, const std::filesystem::path& folder, const std::string& part,
                        const std::string& name);

}  // namespace carus::imaging
