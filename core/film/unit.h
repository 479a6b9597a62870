#pragma once

#include <algorithm>
#include <cstdint>

#include "core/base/rect.h"

namespace hyades::core {

/// Samples of one pixel that are summed in double, in order, by one thread, then rounded once.
/// Batch b of a pixel holds samples [16 b, 16 b + 16); the last batch of a job may hold fewer.
inline constexpr uint32_t kBatchSamples = 16;

/// No job has more batches per pixel (samples are counted in 32 bits).
inline constexpr uint32_t kMaxBatches = uint32_t{1} << 28U;

/// Batches [first, first + count).
struct BatchRange {
  uint32_t first = 0;
  uint32_t count = 0;
  uint32_t end() const { return first + count; }
  friend bool operator==(const BatchRange&, const BatchRange&) = default;
};

/// The smallest thing that one thread renders: some batches of a tile of a frame.
struct Unit {
  int32_t frame = 0;
  PixelRect tile;
  BatchRange batches;
  friend bool operator==(const Unit&, const Unit&) = default;
};

/// How many batches `samples` per pixel make.
constexpr uint32_t batch_count(uint32_t samples) {
  return (samples + kBatchSamples - 1) / kBatchSamples;
}

/// How many samples batch `batch` holds where a pixel has `samples` in all.
constexpr uint32_t samples_in_batch(uint32_t batch, uint32_t samples) {
  const uint32_t begin = batch * kBatchSamples;
  return begin >= samples ? 0 : (samples - begin < kBatchSamples ? samples - begin : kBatchSamples);
}

/// How many samples a unit takes where a pixel has `samples` in all.
inline uint64_t samples_in(const PixelRect& tile, const BatchRange& batches, uint32_t samples) {
  const auto until = [&](uint64_t batch) {
    return std::min<uint64_t>(batch * kBatchSamples, samples);
  };
  return (until(batches.end()) - until(batches.first)) * static_cast<uint64_t>(tile.area());
}

}  // namespace hyades::core
