// SPDX-License-Identifier: Apache-2.0
#include "carus/imaging/read_surface.hpp"

#include <fmt/format.h>

#include <Eigen/LU>

#include "carus/core/error.hpp"
#include "carus/imaging/bytes.hpp"
#include "carus/imaging/text_header.hpp"

namespace carus::imaging {

mesh::Closed read_surface(const SurfaceSource& source) {
  const auto& file = source.file;
  const std::string name = file.string(), kind = lower(file.extension().string());
  const bool gltf = kind == ".glb" || kind == ".gltf";
  if (!gltf && !source.part.empty())
    throw InputError(fmt::format("{}: part \"{}\"; only glTF files have named parts", name, source.part));
  const auto c = convention(gltf && source.unit.empty() ? "m" : source.unit,
                            gltf && source.frame.empty() ? "LSA" : source.frame, name);
  mesh::Surface s;
  if (kind == ".stl")
    s = read_stl(file);
  else if (kind == ".vtp")
    s = read_vtp(file);
  else if (kind == ".ply")
    s = read_ply(read_bytes(file), name);
  else if (kind == ".obj")
    s = read_obj(read_bytes(file), name);
  else if (gltf)
    s = read_gltf(read_bytes(file), file.parent_path(), source.part, name);
  else
    throw InputError(fmt::format("{}: surfaces are read from .stl, .obj, .ply, .vtp, .glb and .gltf files", name));
  for (auto& x : s.nodes) x = c.unit * (c.to_ras * x);
  if (c.to_ras.determinant() < 0)
    for (auto& t : s.triangles) std::swap(t[1], t[2]);
  return mesh::closed(std::move(s), name);
}

}  // namespace carus::imaging
