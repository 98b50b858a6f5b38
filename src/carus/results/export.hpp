// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <map>
#include <string>
#include <vector>

#include "carus/anatomy/anatomy.hpp"

namespace carus::results {

/// Surface of the tets with one label as binary STL [mm, RAS].
void write_stl(const mesh::TetMesh& mesh, const mesh::Triangles& triangles, const std::filesystem::path& file);
/// A body as VTU [m, RAS] in double precision: cell data "label", field data "nodes:NAME" and "surface:NAME" for its
/// named nodes and surfaces, and with `wall` cell data "meridian", "normal", "s", "dome". Sets without members are left
/// out.
void write_body(const anatomy::Body& body, const std::vector<anatomy::WallFrame>& wall,
                const std::filesystem::path& file);
/// {"name": {"x": ..., "y": ..., "z": ...}} [mm, RAS]; "vulva_normal" is a unit vector.
void write_landmarks(const anatomy::Anatomy& anatomy, const std::filesystem::path& file);

/// `LABEL.stl` per organ part, `BODY.vtu` per body, `landmarks.json`, and `anatomy.json` with all else that
/// read_anatomy needs, landmarks in SI and the keys that it was meshed with among it; the names of all files written.
std::vector<std::string> export_anatomy(const anatomy::Anatomy& anatomy, const std::map<std::string, std::string>& keys,
                                        const std::filesystem::path& folder);

inline constexpr const char* anatomy_file = "anatomy.json";
inline constexpr const char* anatomy_format = "carus anatomy 1";
inline constexpr const char *nodes_prefix = "nodes:", *surface_prefix = "surface:";

}  // namespace carus::results
