// SPDX-License-Identifier: Apache-2.0
#include "carus/imaging/read_labels.hpp"

#include <fmt/format.h>

#include "carus/core/error.hpp"
#include "carus/imaging/bytes.hpp"

namespace carus::imaging {

LabelFile read_labels(const std::filesystem::path& file) {
  const std::string bytes = read_bytes(file), name = file.string();
  const auto folder = file.parent_path();
  if (bytes.starts_with("NRRD")) return read_nrrd(bytes, folder, name);
  if (is_gzip(bytes)) return read_nifti(inflate(bytes, std::size_t(2) << 30, name), name);
  const auto extension = file.extension();
  if (extension == ".mha" || extension == ".mhd") return read_metaimage(bytes, folder, name);
  if (extension == ".nii" || extension == ".gz") return read_nifti(bytes, name);
  throw InputError(fmt::format(
      "{}: is no label volume that can be read; allowed NIfTI (.nii, .nii.gz), NRRD (.nrrd, .nhdr), MetaImage (.mha, "
      ".mhd); DICOM series: convert with any segmentation program",
      name));
}

}  // namespace carus::imaging
