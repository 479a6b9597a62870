#pragma once

#include <cstdint>
#include <vector>

#include "core/base/rect.h"
#include "core/film/film.h"
#include "core/film/film_info.h"

namespace hyades::core {

/// Pixels along the side of the tiles that are judged. They begin at multiples of it in the full
/// frame, and end where what the job renders ends.
inline constexpr int32_t kJudgedTile = 32;

/// When tiles are judged, and when they have samples enough.
struct NoiseThreshold {
  NoiseAim aim;
  /// After so many batches each tile is judged; ascending, all fewer than the job has. Fixed, so
  /// that how many batches of a tile are there tells all that was ever decided about it.
  std::vector<uint32_t> rounds;

  bool adaptive() const { return !rounds.empty(); }
};

/// The threshold of a job with so many samples per pixel: the first round is after aim.min_samples
/// of them, at least two batches; each of the others after half as many again. Not adaptive where
/// there is no aim, or too few samples for a round.
NoiseThreshold make_noise_threshold(const NoiseAim& aim, uint32_t samples);

/// Side of the blocks by which tile_noise() judges, pixels.
inline constexpr int32_t kNoiseBlock = 8;

/// The noise of the worst of the tile's blocks of 8 x 8 pixels: the root mean square of the
/// standard errors of its pixels' luminances, over L or the root of L, whichever is more, where L
/// is the block's mean luminance; all of it 2^exposure times as bright. (In a picture for a display
/// a step of the root of L is as visible in the dark as in the light; Cycles judges alike.)
/// Infinite where a pixel holds fewer than two batches. The tile lies within the film's window, and
/// films with splats are not judged by it.
double tile_noise(const Film& film, const PixelRect& tile, float exposure);

/// The noise of a picture in one number: the mean of that of its blocks, as tile_noise() has it,
/// over at most 256 of them all over the film's window. -1 where fewer than three quarters of them
/// have two batches of every pixel: the tiles that are rendered first, an even sky say, tell little
/// of the others. Knows splats. Costs well below a millisecond.
double picture_noise(const Film& film, float exposure);

/// Whether the tile has samples enough.
bool is_clean(const Film& film, const PixelRect& tile, const NoiseThreshold& threshold);

/// The tiles of `crop`, what a job with so many samples per pixel renders, of which `film` has not
/// all that they need by an adaptive `threshold`.
std::vector<PixelRect> unfinished_tiles(const Film& film, const PixelRect& crop, uint32_t samples,
                                        const NoiseThreshold& threshold);

}  // namespace hyades::core
