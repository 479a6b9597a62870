#include "core/geometry/obj_vertices.h"

#include <algorithm>
#include <atomic>
#include <cstddef>
#include <tuple>

#include "core/geometry/chunks.h"

namespace hyades::core {
namespace {

/// The corners of each position, in no order: those of v lie from starts[v] to starts[v + 1].
struct CornersOfPositions {
  std::vector<uint32_t> starts;
  std::vector<uint32_t> corners;
};

CornersOfPositions gather_corners(const std::vector<ObjCorner>& corners, size_t positions) {
  CornersOfPositions out{std::vector<uint32_t>(positions + 1),
                         std::vector<uint32_t>(corners.size())};
  const auto add_one = [&](int32_t v) {
    std::atomic_ref<uint32_t> count(out.starts[static_cast<size_t>(v)]);
    return count.fetch_add(1, std::memory_order_relaxed);
  };
  const auto for_corners = [&](const auto& body) {
    for_chunks(corners.size(), [&](size_t begin, size_t end) {
      for (size_t c = begin; c < end; ++c) body(c);
    });
  };
  for_corners([&](size_t c) { add_one(corners[c].v); });
  // Ends after all counts, which the second round makes starts: each corner takes the last place.
  uint32_t sum = 0;
  for (uint32_t& start : out.starts) start = sum += start;
  for_corners([&](size_t c) {
    std::atomic_ref<uint32_t> end(out.starts[static_cast<size_t>(corners[c].v)]);
    out.corners[end.fetch_sub(1, std::memory_order_relaxed) - 1] = static_cast<uint32_t>(c);
  });
  return out;
}

}  // namespace

ObjVertices number_vertices(const std::vector<ObjCorner>& corners, size_t positions,
                            std::span<const size_t> part_ends) {
  CornersOfPositions by_position = gather_corners(corners, positions);
  ObjVertices out;
  // At first, the vertex of a corner is told by the first corner that has it too.
  out.of_corner.resize(corners.size());
  const auto key = [&](uint32_t c) { return std::tuple(corners[c].vt, corners[c].vn, c); };
  const auto same = [&](uint32_t a, uint32_t b) {
    return corners[a].vt == corners[b].vt && corners[a].vn == corners[b].vn;
  };
  for_chunks(positions, [&](size_t begin, size_t end) {
    for (size_t v = begin; v < end; ++v) {
      const std::span<uint32_t> here(by_position.corners.data() + by_position.starts[v],
                                     by_position.corners.data() + by_position.starts[v + 1]);
      std::sort(here.begin(), here.end(), [&](uint32_t a, uint32_t b) { return key(a) < key(b); });
      uint32_t first = 0;
      size_t part_end = 0;
      for (size_t i = 0; i < here.size(); ++i) {
        const uint32_t c = here[i];
        if (i == 0 || c >= part_end || !same(c, first)) {
          first = c;
          part_end = *std::upper_bound(part_ends.begin(), part_ends.end(), size_t{c});
        }
        out.of_corner[c] = first;
      }
    }
  });

  std::vector<uint32_t> starts(chunk_count(corners.size()) + 1);  // by chunks of corners: vertices
  for_chunks(corners.size(), [&](size_t begin, size_t end) {
    uint32_t& count = starts[begin / kChunk + 1];
    for (size_t c = begin; c < end; ++c) count += out.of_corner[c] == c ? 1 : 0;
  });
  for (size_t i = 1; i < starts.size(); ++i) starts[i] += starts[i - 1];
  out.first.resize(starts.back());
  std::vector<uint32_t>& number = by_position.corners;  // of a vertex's first corner; done with it
  for_chunks(corners.size(), [&](size_t begin, size_t end) {
    uint32_t next = starts[begin / kChunk];
    for (size_t c = begin; c < end; ++c) {
      if (out.of_corner[c] != c) continue;
      out.first[next] = static_cast<uint32_t>(c);
      number[c] = next++;
    }
  });
  for_chunks(corners.size(), [&](size_t begin, size_t end) {
    for (size_t c = begin; c < end; ++c) out.of_corner[c] = number[out.of_corner[c]];
  });
  return out;
}

}  // namespace hyades::core
