#include "core/film/coverage_gaps.h"

#include <algorithm>
#include <cstddef>
#include <utility>

#include <fmt/format.h>

namespace hyades::core {
namespace {

constexpr size_t kMostNamed = 5;

/// The canonical form is nested: runs of rows, in them runs of columns, in those runs of batches.
/// Walks one run after the other and keeps what lies between.
class Walk {
 public:
  Walk(const PixelRect& crop, uint32_t batches) : crop_(crop), batches_(batches) {}

  std::vector<CoverageBox> gaps_between(const std::vector<CoverageBox>& boxes) {
    int32_t y = crop_.y0;
    for (size_t i = 0; i < boxes.size();) {
      const PixelRect& rows = boxes[i].tile;
      keep({crop_.x0, y, crop_.x1, rows.y0}, {0, batches_});
      i = columns(boxes, i);
      y = rows.y1;
    }
    keep({crop_.x0, y, crop_.x1, crop_.y1}, {0, batches_});
    return std::move(gaps_);
  }

 private:
  /// The boxes of the rows of boxes[begin]; returns the first that is none of them.
  size_t columns(const std::vector<CoverageBox>& boxes, size_t begin) {
    const PixelRect rows = boxes[begin].tile;
    int32_t x = crop_.x0;
    size_t i = begin;
    while (i < boxes.size() && boxes[i].tile.y0 == rows.y0) {
      const PixelRect tile = boxes[i].tile;
      keep({x, rows.y0, tile.x0, rows.y1}, {0, batches_});
      uint32_t batch = 0;
      for (; i < boxes.size() && boxes[i].tile == tile; ++i) {
        const BatchRange& held = boxes[i].batches;
        keep(tile, {batch, held.first - batch});
        batch = held.end();
      }
      keep(tile, {batch, batches_ - std::min(batch, batches_)});
      x = tile.x1;
    }
    keep({x, rows.y0, crop_.x1, rows.y1}, {0, batches_});
    return i;
  }

  void keep(const PixelRect& tile, const BatchRange& batches) {
    if (!tile.empty() && batches.count > 0) gaps_.push_back({tile, batches});
  }

  const PixelRect crop_;
  const uint32_t batches_;
  std::vector<CoverageBox> gaps_;
};

}  // namespace

std::vector<CoverageBox> gaps(const Coverage& held, const PixelRect& crop, uint32_t batches) {
  return Walk(crop, batches).gaps_between(held.canonical());
}

std::string describe_gaps(const std::vector<CoverageBox>& gaps, uint32_t samples) {
  std::string text;
  for (size_t i = 0; i < std::min(gaps.size(), kMostNamed); ++i) {
    const auto& [tile, batches] = gaps[i];
    const uint64_t end = std::min<uint64_t>(uint64_t{batches.end()} * kBatchSamples, samples);
    text += fmt::format("{}pixels x {} to {}, y {} to {}: samples {} to {}", i == 0 ? "" : "; ",
                        tile.x0, tile.x1 - 1, tile.y0, tile.y1 - 1,
                        uint64_t{batches.first} * kBatchSamples, end - 1);
  }
  if (gaps.size() > kMostNamed) text += fmt::format("; and {} more", gaps.size() - kMostNamed);
  return text;
}

}  // namespace hyades::core
