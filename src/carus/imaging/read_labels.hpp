// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

#include "carus/imaging/label_volume.hpp"

namespace carus::imaging {

/// A label volume and what its reader had to assume.
struct LabelFile {
  LabelVolume volume;
  std::vector<std::string> notes;
};

/// Label volume of a file: NIfTI-1 (.nii, .nii.gz), NRRD (.nrrd, .nhdr, .seg.nrrd) or MetaImage (.mha, .mhd), by what
/// its first bytes say. Orientation, oblique and anisotropic voxels as the file states them, turned into RAS and
/// metres. Throws InputError for whatever else is in the file: truncated or lying headers, images that are no labels,
/// orientation that the file does not state. Reads at most 2 GiB.
LabelFile read_labels(const std::filesystem::path& file);

/// The three formats, from the file's bytes. `folder` is where a header's separate data file may lie; `name` begins
/// messages.
LabelFile read_nifti(std::string_view bytes, const std::string& name);
LabelFile read_nrrd(std::string_view bytes, const std::filesystem::path& folder, const std::string& name);
LabelFile read_metaimage(std::string_view bytes, const std::filesystem::path& folder, const std::string& name);

}  // namespace carus::imaging
