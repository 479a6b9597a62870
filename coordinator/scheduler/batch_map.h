#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <vector>

#include "core/film/unit.h"

namespace hyades::coordinator {

/// One bit per (tile, batch) of a frame. A tile's bits take memory once one of them was set: frames
/// are opened before anybody works at them.
class BatchMap {
 public:
  BatchMap(uint32_t tiles, uint32_t batches);

  /// Bytes that it takes when every tile has bits that are set.
  static uint64_t memory(uint64_t tiles, uint64_t batches);

  /// Sets the bits of the range to one.
  void set(uint32_t tile, core::BatchRange range);
  /// Sets the bits of the range to zero.
  void clear(uint32_t tile, core::BatchRange range);
  /// How many bits of the range are set.
  uint32_t count(uint32_t tile, core::BatchRange range) const;

  /// The first run within `range` whose bits are zero in both maps (of the same shape).
  static std::optional<core::BatchRange> first_free(const BatchMap& a, const BatchMap& b,
                                                    uint32_t tile, core::BatchRange range);
  /// How many bits of the range are zero in both maps.
  static uint32_t count_free(const BatchMap& a, const BatchMap& b, uint32_t tile,
                             core::BatchRange range);

 private:
  using Words = std::vector<uint64_t>;

  Words& words_to_set(uint32_t tile);
  /// The bits of word `word` of the tile.
  uint64_t bits(uint32_t tile, size_t word) const {
    const Words& words = words_[tile];
    return words.empty() ? 0 : words[word];
  }

  size_t words_per_tile_;
  std::vector<Words> words_;  ///< by tile; empty: none is set
};

}  // namespace hyades::coordinator
