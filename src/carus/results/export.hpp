// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "carus/anatomy/anatomy.hpp"

namespace carus::results {

/// Surface of the tets with one label as binary STL [mm, RAS].
void write_stl(const mesh::TetMesh& mesh, const mesh::Triangles& triangles, const std::filesystem::path& file);
/// A body as VTU [m, RAS] with cell data "label".
void write_body(const anatomy::Body& body, const std::filesystem::path& file);
/// {"name": {"x": ..., "y": ..., "z": ...}} [mm, RAS]; "vulva_normal" is a unit vector.
void write_landmarks(const anatomy::Anatomy& anatomy, const std::filesystem::path& file);

/// `LABEL.stl` per organ part, `BODY.vtu` per body, `landmarks.json`; the names of all files written.
std::vector<std::string> export_anatomy(const anatomy::Anatomy& anatomy, const std::filesystem::path& folder);

}  // namespace carus::results
