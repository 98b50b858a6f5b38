// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <map>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "carus/report/coding.hpp"
#include "carus/report/fields.hpp"
#include "carus/report/frame_file.hpp"

namespace carus::report {

/// Integers coded as docs/reference/report_format.md says.
struct Packed {
  int planes = 1, order = 1;
  std::size_t raw = 0;  ///< bytes before deflate
  std::string bytes;    ///< zlib stream
};
Packed pack(std::span<const std::int32_t> values, int level);

/// Frames coded one after the other: `frames` are the quantised values of each, `base` what the first is relative to
/// (empty: zeros). Order 1: differences to the frame before; 2: to the line through the two before.
Packed pack_frames(const std::vector<std::vector<std::int32_t>>& frames, const std::vector<std::int32_t>& base,
                   int order, int level);
/// The inverse.
std::vector<std::vector<std::int32_t>> unpack_frames(const Packed& packed, std::size_t frames,
                                                     const std::vector<std::int32_t>& base, std::size_t values);

struct PackedField {
  Packed data;
  float min = 0, max = 0;
};
/// Frames that are decoded together.
struct Chunk {
  std::vector<double> times;  ///< [s of labour]
  std::size_t entries = 0;    ///< frames of the index it was made from, unreadable ones among them
  Packed position;
  std::vector<PackedField> fields;  ///< by Fields::kinds()
};

struct PackOptions {
  std::size_t frames_per_chunk = 24;
  double quantum = 2e-5;  ///< [m]
  int level = 6;          ///< of deflate
};

/// The 3-D half of a run. Reads every frame once; update() adds those that a run in progress has written since.
class FramePacker {
 public:
  using Materials = std::optional<std::map<std::string, material::Material>>;
  FramePacker(std::filesystem::path pvd, Materials materials, PackOptions options = {});

  /// Frames that cannot be read are left out and named in notes(). Throws InputError if the index cannot be read.
  void update();

  [[nodiscard]] bool empty() const { return chunks_.empty(); }
  [[nodiscard]] const FrameMesh& mesh() const { return *mesh_; }
  [[nodiscard]] const std::vector<FieldKind>& kinds() const { return fields_->kinds(); }
  [[nodiscard]] const Packed& corners() const { return corners_; }
  [[nodiscard]] const Packed& region() const { return region_; }
  [[nodiscard]] const Packed& rest() const { return rest_; }
  [[nodiscard]] const std::vector<Chunk>& chunks() const { return chunks_; }
  [[nodiscard]] const std::vector<std::string>& notes() const { return notes_; }
  [[nodiscard]] const PackOptions& options() const { return options_; }

 private:
  void find_mesh(const std::vector<FrameEntry>& entries);
  [[nodiscard]] Chunk make_chunk(std::span<const FrameEntry> entries, std::vector<std::string>& notes) const;

  std::filesystem::path pvd_;
  Materials materials_;
  PackOptions options_;
  std::unique_ptr<FrameMesh> mesh_;
  std::unique_ptr<Fields> fields_;
  std::vector<std::int32_t> rest_quantised_;
  Packed corners_, region_, rest_;
  std::vector<Chunk> chunks_;
  std::vector<std::vector<std::string>> chunk_notes_;
  std::vector<FrameEntry> known_;
  std::vector<std::string> notes_;
};

}  // namespace carus::report
