#include "coordinator/scheduler/tile_grid.h"

#include <algorithm>
#include <bit>
#include <numeric>
#include <utility>

#include "core/base/hash.h"

namespace hyades::coordinator {
namespace {

/// Position of cell (x, y) along the Hilbert curve over a square of `side` cells, a power of two.
uint64_t hilbert_index(uint32_t side, uint32_t x, uint32_t y) {
  uint64_t index = 0;
  for (uint32_t s = side / 2; s > 0; s /= 2) {
    const uint32_t right = (x & s) ? 1 : 0;
    const uint32_t lower = (y & s) ? 1 : 0;
    index += uint64_t{s} * s * ((3 * right) ^ lower);
    if (lower == 0) {
      if (right == 1) {
        x = side - 1 - x;
        y = side - 1 - y;
      }
      std::swap(x, y);
    }
  }
  return index;
}

}  // namespace

TileGrid::TileGrid(core::PixelRect region, int32_t tile_size, uint64_t shuffle)
    : region_(region),
      x0_(tile_begin(region.x0, tile_size)),
      y0_(tile_begin(region.y0, tile_size)),
      tile_size_(tile_size),
      columns_(static_cast<uint32_t>((region.x1 - x0_ + tile_size - 1) / tile_size)),
      rows_(static_cast<uint32_t>((region.y1 - y0_ + tile_size - 1) / tile_size)) {
  const uint32_t side = std::bit_ceil(std::max(columns_, rows_));
  std::vector<uint64_t> rank(size());
  for (uint32_t i = 0; i < size(); ++i) {
    rank[i] = shuffle != 0 ? core::hash_combine(shuffle, i)
                           : hilbert_index(side, i % columns_, i / columns_);
  }
  order_.resize(size());
  std::iota(order_.begin(), order_.end(), 0U);
  std::sort(order_.begin(), order_.end(),
            [&](uint32_t a, uint32_t b) { return rank[a] != rank[b] ? rank[a] < rank[b] : a < b; });
}

core::PixelRect TileGrid::tile(uint32_t index) const {
  const int32_t x = x0_ + static_cast<int32_t>(index % columns_) * tile_size_;
  const int32_t y = y0_ + static_cast<int32_t>(index / columns_) * tile_size_;
  return core::intersection(region_, {x, y, x + tile_size_, y + tile_size_});
}

std::optional<uint32_t> TileGrid::index_of(const core::PixelRect& rect) const {
  if (rect.empty() || !region_.contains(rect)) return std::nullopt;
  const uint32_t column = static_cast<uint32_t>((rect.x0 - x0_) / tile_size_);
  const uint32_t row = static_cast<uint32_t>((rect.y0 - y0_) / tile_size_);
  const uint32_t index = row * columns_ + column;
  if (tile(index) != rect) return std::nullopt;
  return index;
}

}  // namespace hyades::coordinator
