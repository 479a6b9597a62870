#include "cli/part.h"

#include <gtest/gtest.h>

#include <string>
#include <vector>

namespace hyades::cli {
namespace {

TEST(RenderPart, SamplesAreANumberOrARange) {
  EXPECT_EQ(parse_samples("256")->of, 256U);
  EXPECT_FALSE(parse_samples("256")->range);
  const auto range = parse_samples("16-47");
  ASSERT_TRUE(range && range->range);
  EXPECT_EQ(range->of, 0U);
  EXPECT_EQ(range->range->first, 16U);
  EXPECT_EQ(range->range->last, 47U);
  EXPECT_EQ(parse_samples("0-31/128")->of, 128U);
  for (const char* text : {"", "0", "-", "1-", "-1", "31-0", "0-31/", "0-31/0", "0-31/x", "a",
                           "1.5", "16777217", "0-16777216", "0-4294967296", "0-31/128/2", " 1"}) {
    EXPECT_FALSE(parse_samples(text)) << text;
  }
}

TEST(RenderPart, RangesAreOfWholeBatches) {
  const auto batches = [](uint32_t first, uint32_t last, uint32_t samples) {
    const auto range = batches_of({first, last}, samples);
    return range ? std::to_string(range->first) + "+" + std::to_string(range->count)
                 : range.error().message;
  };
  EXPECT_EQ(batches(0, 15, 64), "0+1");
  EXPECT_EQ(batches(16, 63, 64), "1+3");
  EXPECT_EQ(batches(0, 39, 40), "0+3");
  EXPECT_EQ(batches(32, 39, 40), "2+1");
  EXPECT_EQ(batches(0, 3, 4), "0+1");
  EXPECT_EQ(batches(1, 32, 64),
            "--samples 1-32: films hold whole batches of 16 samples, expected 0-47 or the like");
  EXPECT_EQ(batches(32, 37, 40),
            "--samples 32-37: films hold whole batches of 16 samples, expected 32-39 or the like");
  EXPECT_EQ(batches(0, 64, 64), "--samples 0-64: a pixel has 64 samples, expected at most 63");
}

TEST(RenderPart, TilesAreCountedFromOne) {
  EXPECT_EQ(parse_tile("2/3")->index, 2U);
  EXPECT_EQ(parse_tile("2/3")->count, 3U);
  for (const char* text : {"", "0/3", "4/3", "3", "/", "1/", "/3", "-1/3", "1/3/5", "1/1000001"}) {
    EXPECT_FALSE(parse_tile(text)) << text;
  }
}

TEST(RenderPart, TilesAreTheWholeWithoutOverlapAndAboutAsLargeAsEachOther) {
  const std::vector<core::PixelRect> wholes = {{0, 0, 1920, 1080}, {0, 0, 64, 64},
                                               {7, 3, 960, 541},   {100, 0, 130, 2000},
                                               {0, 0, 257, 16},    {5, 900, 4101, 917}};
  for (const core::PixelRect& whole : wholes) {
    const int64_t most = whole.area() / 256;
    for (const int64_t count : {1L, 2L, 3L, 4L, 5L, 7L, 12L, 16L, 31L, 100L, 1000L, most}) {
      if (count > most) continue;
      std::vector<int> seen(static_cast<size_t>(whole.area()), 0);
      for (int64_t i = 1; i <= count; ++i) {
        const auto tile = tile_of(whole, {static_cast<uint32_t>(i), static_cast<uint32_t>(count)});
        ASSERT_TRUE(tile) << tile.error().message;
        ASSERT_FALSE(tile->empty()) << i << " of " << count;
        ASSERT_TRUE(whole.contains(*tile));
        EXPECT_LT(tile->area() * count, 3 * whole.area()) << i << " of " << count;
        for (int y = tile->y0; y < tile->y1; ++y) {
          for (int x = tile->x0; x < tile->x1; ++x) {
            ++seen[static_cast<size_t>((y - whole.y0) * whole.width() + x - whole.x0)];
          }
        }
      }
      for (const int times : seen) ASSERT_EQ(times, 1) << count;
    }
  }
}

TEST(RenderPart, LargeTilesHaveEdgesThatCutNoChains) {
  for (uint32_t i = 1; i <= 4; ++i) {
    const auto tile = tile_of({0, 0, 1920, 1080}, {i, 4});
    EXPECT_EQ(tile->x0 % 64, 0);
    EXPECT_EQ(tile->y0 % 64, 0);
  }
}

TEST(RenderPart, TooManyTilesAreRefused) {
  const auto tile = tile_of({0, 0, 32, 32}, {1, 5});
  ASSERT_FALSE(tile);
  EXPECT_EQ(tile.error().message, "--tile 1/5: 32 x 32 pixels have at most 4 parts");
}

}  // namespace
}  // namespace hyades::cli
