#pragma once

#include <cstdint>
#include <optional>
#include <string>

#include "core/base/rect.h"
#include "core/base/result.h"
#include "core/film/unit.h"

namespace hyades::cli {

/// Samples first to last of every pixel, counted from 0.
struct SampleRange {
  uint32_t first = 0;
  uint32_t last = 0;
};

/// Samples that a pixel has at most.
inline constexpr uint32_t kMostSamples = 1U << 24U;

/// What --samples says: how many a pixel gets, and which of them are rendered.
struct SamplesOption {
  uint32_t of = 0;  ///< 0: as many as the job says
  std::optional<SampleRange> range;
};

/// "256", "0-31" or "0-31/256"; the error says what was expected.
core::Result<SamplesOption> parse_samples(const std::string& text);

/// The batches that `range` of `samples` per pixel are; an error where they are not whole ones.
core::Result<core::BatchRange> batches_of(const SampleRange& range, uint32_t samples);

/// Part `index` of `count`, counted from 1.
struct TileOption {
  uint32_t index = 1;
  uint32_t count = 1;
};

/// "2/3"; the error says what was expected.
core::Result<TileOption> parse_tile(const std::string& text);

/// That part of `whole`: all of them together are the whole, no two overlap, and they are about as
/// large as each other. Edges are at multiples of 64 where that costs little, for chains of mlt
/// stand for blocks of so many pixels. An error where the parts would be too small.
core::Result<core::PixelRect> tile_of(const core::PixelRect& whole, const TileOption& option);

}  // namespace hyades::cli
