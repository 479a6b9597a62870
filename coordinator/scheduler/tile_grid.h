#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "core/base/rect.h"

namespace hyades::coordinator {

/// Where the tile that pixel `at` (row or column) lies in begins. Tiles begin at multiples of their
/// size in the full frame, whatever part of it is rendered, so that films of one crop are of use to
/// another.
inline int32_t tile_begin(int32_t at, int32_t tile_size) {
  const int32_t past = at % tile_size;
  return past < 0 ? at - past - tile_size : at - past;
}

/// Pixels along the side of a tile where nothing speaks for another size.
inline constexpr int32_t kTile = 32;

/// How many samples a job takes of which so many are done and so many were found not needed, while
/// of `left` that is not known yet: as large a part of these as of the others.
inline uint64_t expected_samples(uint64_t done, uint64_t spared, uint64_t left) {
  if (spared == 0) return done + left;
  const double part =
      static_cast<double>(done) / (static_cast<double>(done) + static_cast<double>(spared));
  return done + static_cast<uint64_t>(part * static_cast<double>(left));
}

/// Pixels along the side of a tile of films with splats. Their layer lies over the frame however
/// small the tile is, so that a unit should be of many samples.
inline constexpr int32_t kSplatTile = 128;

/// How a frame's pixels are cut into tiles, and in which order the tiles are leased: along a
/// Hilbert curve, so that what is rendered together lies together; or shuffled, which must not
/// change any picture and exists so that tests can show it.
class TileGrid {
 public:
  TileGrid() = default;
  /// `region` must not be empty, `tile_size` is in pixels and at least 1. A `shuffle` other than 0
  /// is the seed of a random order.
  TileGrid(core::PixelRect region, int32_t tile_size, uint64_t shuffle = 0);

  /// How many tiles there are.
  uint32_t size() const { return columns_ * rows_; }
  /// The pixels of the tile, cut off where the region ends; `index` is below size().
  core::PixelRect tile(uint32_t index) const;
  /// The index of exactly this rectangle, if it is a tile of the grid.
  std::optional<uint32_t> index_of(const core::PixelRect& tile) const;
  /// All indices, in the order in which they are leased.
  const std::vector<uint32_t>& order() const { return order_; }

 private:
  core::PixelRect region_;
  int32_t x0_ = 0;  ///< where the first column and row begin, perhaps outside the region
  int32_t y0_ = 0;
  int32_t tile_size_ = 1;
  uint32_t columns_ = 0;
  uint32_t rows_ = 0;
  std::vector<uint32_t> order_;
};

}  // namespace hyades::coordinator
