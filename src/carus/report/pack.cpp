// SPDX-License-Identifier: Apache-2.0
#include "carus/report/pack.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "carus/core/error.hpp"
#include "carus/core/parallel.hpp"

namespace carus::report {
namespace {

/// x of all nodes, then y, then z.
template <class Points>
std::vector<std::int32_t> quantised(const Points& x, const Quantiser& q) {
  std::vector<std::int32_t> out(3 * x.size());
  for (std::size_t k = 0; k < 3; ++k) {
    for (std::size_t i = 0; i < x.size(); ++i) out[k * x.size() + i] = q(double(x[i][int(k)]));
  }
  return out;
}

/// What the k-th frame is relative to at value i.
std::int32_t predicted(const std::vector<std::vector<std::int32_t>>& frames, const std::vector<std::int32_t>& base,
                       int order, std::size_t k, std::size_t i) {
  if (k == 0) return base.empty() ? 0 : base[i];
  if (order == 2 && k >= 2) return 2 * frames[k - 1][i] - frames[k - 2][i];
  return frames[k - 1][i];
}

Packed pack_mesh_corners(const FrameMesh& m, int level) {
  std::vector<std::int32_t> d;
  d.reserve(4 * m.tets.size());
  std::array<std::int32_t, 4> before{};
  for (const auto& t : m.tets) {
    for (std::size_t k = 0; k < 4; ++k) d.push_back(t[k] - before[k]);
    before = t;
  }
  return pack(d, level);
}

std::vector<std::int32_t> steps(std::vector<std::int32_t> v) {
  for (std::size_t i = v.size(); i-- > 1;) v[i] -= v[i - 1];
  return v;
}

}  // namespace

Packed pack(std::span<const std::int32_t> values, int level) {
  const auto planes = to_planes(values);
  return {planes.planes, 1, planes.bytes.size(), deflate(planes.bytes, level)};
}

Packed pack_frames(const std::vector<std::vector<std::int32_t>>& frames, const std::vector<std::int32_t>& base,
                   int order, int level) {
  std::vector<std::int32_t> d;
  if (!frames.empty()) d.reserve(frames.size() * frames[0].size());
  for (std::size_t k = 0; k < frames.size(); ++k) {
    for (std::size_t i = 0; i < frames[k].size(); ++i) d.push_back(frames[k][i] - predicted(frames, base, order, k, i));
  }
  Packed p = pack(d, level);
  p.order = order;
  return p;
}

std::vector<std::vector<std::int32_t>> unpack_frames(const Packed& packed, std::size_t count,
                                                     const std::vector<std::int32_t>& base, std::size_t values) {
  const auto raw = inflate(packed.bytes, packed.raw);
  const auto d = from_planes(raw, packed.planes, count * values);
  std::vector<std::vector<std::int32_t>> frames;
  for (std::size_t k = 0; k < count; ++k) {
    frames.emplace_back(values);
    for (std::size_t i = 0; i < values; ++i)
      frames[k][i] = predicted(frames, base, packed.order, k, i) + d[k * values + i];
  }
  return frames;
}

FramePacker::FramePacker(std::filesystem::path pvd, Materials materials, PackOptions options)
    : pvd_(std::move(pvd)), materials_(std::move(materials)), options_(options) {}

void FramePacker::find_mesh(const std::vector<FrameEntry>& entries) {
  for (const auto& entry : entries) {
    try {
      mesh_ = std::make_unique<FrameMesh>(read_frame_mesh(entry.file));
      break;
    } catch (const InputError& e) {
      // Named again, once, where its chunk is made.
    }
  }
  if (!mesh_) return;
  fields_ = std::make_unique<Fields>(*mesh_, materials_);
  rest_quantised_ = quantised(mesh_->nodes, Quantiser(options_.quantum, "rest position"));
  rest_ = pack(steps(rest_quantised_), options_.level);
  region_ = pack(steps(mesh_->labels), options_.level);
  corners_ = pack_mesh_corners(*mesh_, options_.level);
}

void FramePacker::update() {
  const auto entries = read_frame_index(pvd_);
  const auto same = [](const FrameEntry& a, const FrameEntry& b) { return a.time == b.time && a.file == b.file; };
  const bool goes_on =
      entries.size() >= known_.size() && std::equal(known_.begin(), known_.end(), entries.begin(), same);
  if (!goes_on)
    mesh_.reset(), fields_.reset(), chunks_.clear(), chunk_notes_.clear();  // the folder holds another run now
  known_ = entries;
  if (!mesh_) find_mesh(entries);

  const std::size_t size = options_.frames_per_chunk, count = mesh_ ? (entries.size() + size - 1) / size : 0;
  std::size_t whole = 0;  // chunks that stay as they are
  while (whole < chunks_.size() && chunks_[whole].entries == std::min(size, entries.size() - whole * size)) ++whole;
  chunks_.resize(count), chunk_notes_.resize(count);
  parallel::for_chunks(count - whole, 1, [&](std::size_t begin, std::size_t end, std::size_t) {
    for (std::size_t c = whole + begin; c < whole + end; ++c) {
      chunk_notes_[c].clear();
      const auto first = c * size;
      chunks_[c] =
          make_chunk(std::span(entries).subspan(first, std::min(size, entries.size() - first)), chunk_notes_[c]);
    }
  });
  notes_.clear();
  for (const auto& list : chunk_notes_) notes_.insert(notes_.end(), list.begin(), list.end());
  if (!mesh_ && !entries.empty())
    notes_.push_back(fmt::format("{}: none of its {} frames can be read; there is nothing to show in 3-D",
                                 pvd_.string(), entries.size()));
}

Chunk FramePacker::make_chunk(std::span<const FrameEntry> entries, std::vector<std::string>& notes) const {
  Chunk chunk;
  chunk.entries = entries.size();
  const auto& kinds = fields_->kinds();
  std::vector<std::vector<std::int32_t>> positions;
  std::vector<std::vector<std::vector<std::int32_t>>> values(kinds.size());
  chunk.fields.resize(kinds.size());
  for (const auto& entry : entries) {
    try {
      const auto state = read_frame_state(entry.file, mesh_->nodes.size(), mesh_->tets.size());
      auto position = quantised(state.x, Quantiser(options_.quantum, entry.file.string()));
      std::vector<std::vector<std::int32_t>> fields;
      for (std::size_t k = 0; k < kinds.size(); ++k) {
        const Quantiser q(kinds[k].quantum, entry.file.string() + ": " + kinds[k].name);
        auto& own = fields.emplace_back();
        for (const float v : fields_->values(k, state)) {
          own.push_back(q(double(v) - kinds[k].offset));
          auto& f = chunk.fields[k];
          const bool first = chunk.times.empty() && own.size() == 1;
          f.min = first ? v : std::min(f.min, v), f.max = first ? v : std::max(f.max, v);
        }
      }
      positions.push_back(std::move(position));
      for (std::size_t k = 0; k < kinds.size(); ++k) values[k].push_back(std::move(fields[k]));
      chunk.times.push_back(entry.time);
    } catch (const InputError& e) {
      notes.push_back(fmt::format("Frame at {:.1f} s left out: {}", entry.time, e.what()));
    }
  }
  // Motion is smooth and packs better about a line; fields flicker and do not.
  chunk.position = pack_frames(positions, rest_quantised_, 2, options_.level);
  for (std::size_t k = 0; k < kinds.size(); ++k) chunk.fields[k].data = pack_frames(values[k], {}, 1, options_.level);
  return chunk;
}

}  // namespace carus::report
