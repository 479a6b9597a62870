#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <vector>

#include "core/film/unit.h"

namespace hyades::coordinator {

/// One bit per (tile, batch) of a frame.
class BatchMap {
 public:
  BatchMap(uint32_t tiles, uint32_t batches);

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
  size_t word(uint32_t tile, uint32_t batch) const { return tile * words_per_tile_ + batch / 64; }

  size_t words_per_tile_;
  std::vector<uint64_t> words_;
};

}  // namespace hyades::coordinator
