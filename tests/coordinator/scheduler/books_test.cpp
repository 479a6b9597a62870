// The scheduler's parts: how a frame is cut into tiles, bits per batch, and how long units are.
#include <gtest/gtest.h>

#include <chrono>
#include <cstdint>
#include <cstdlib>
#include <random>
#include <set>
#include <vector>

#include "coordinator/scheduler/batch_map.h"
#include "coordinator/scheduler/run_length.h"
#include "coordinator/scheduler/tile_grid.h"

namespace hyades::coordinator {
namespace {

TEST(TileGrid, CoversEveryPixelOnce) {
  const core::PixelRect region{-3, 5, 40, 31};
  for (const uint64_t shuffle : {0, 1}) {
    for (const int32_t size : {1, 7, 16, 100}) {
      const TileGrid grid(region, size, shuffle);
      std::set<std::pair<int, int>> pixels;
      int64_t area = 0;
      for (const uint32_t i : grid.order()) {
        const core::PixelRect tile = grid.tile(i);
        area += tile.area();
        ASSERT_TRUE(region.contains(tile));
        ASSERT_EQ(grid.index_of(tile), i);
        for (int y = tile.y0; y < tile.y1; ++y) {
          for (int x = tile.x0; x < tile.x1; ++x) pixels.emplace(x, y);
        }
      }
      EXPECT_EQ(area, region.area());
      EXPECT_EQ(static_cast<int64_t>(pixels.size()), region.area());
    }
  }
}

TEST(TileGrid, TilesLieAlikeWhateverPartIsRendered) {
  const TileGrid whole({-40, -40, 80, 80}, 16);
  for (const core::PixelRect region :
       {core::PixelRect{-40, -40, 80, 80}, core::PixelRect{3, 5, 40, 31},
        core::PixelRect{-7, -17, -1, 20}, core::PixelRect{32, 16, 33, 17}}) {
    const TileGrid part(region, 16);
    for (const uint32_t i : part.order()) {
      bool within = false;
      for (const uint32_t k : whole.order()) {
        within = within || core::intersection(whole.tile(k), region) == part.tile(i);
      }
      EXPECT_TRUE(within);
    }
  }
}

TEST(TileGrid, ConsecutiveTilesAreNeighbours) {
  const TileGrid grid({0, 0, 128, 128}, 8);
  for (size_t i = 1; i < grid.order().size(); ++i) {
    const core::PixelRect a = grid.tile(grid.order()[i - 1]);
    const core::PixelRect b = grid.tile(grid.order()[i]);
    EXPECT_EQ(std::abs(a.x0 - b.x0) + std::abs(a.y0 - b.y0), 8);
  }
}

TEST(TileGrid, KnowsItsTilesFromOthers) {
  const TileGrid grid({0, 0, 50, 50}, 20);
  EXPECT_TRUE(grid.index_of({40, 40, 50, 50}));
  for (const core::PixelRect& r :
       {core::PixelRect{40, 40, 60, 60}, core::PixelRect{0, 0, 20, 10},
        core::PixelRect{10, 0, 30, 20}, core::PixelRect{0, 0, 0, 0}, core::PixelRect{0, 0, 40, 20},
        core::PixelRect{20, 20, 10, 10}}) {
    EXPECT_FALSE(grid.index_of(r));
  }
}

TEST(BatchMap, AgreesWithOneBoolPerBatch) {
  std::mt19937 random(1);
  constexpr uint32_t kBatches = 150;
  BatchMap a(2, kBatches);
  BatchMap b(2, kBatches);
  std::vector<bool> plain_a(kBatches);
  std::vector<bool> plain_b(kBatches);
  for (int i = 0; i < 20'000; ++i) {
    const uint32_t first = uint32_t(random() % kBatches);
    const core::BatchRange range{first, 1 + uint32_t(random() % (kBatches - first))};
    BatchMap& map = i % 2 == 0 ? a : b;
    std::vector<bool>& plain = i % 2 == 0 ? plain_a : plain_b;
    const bool set = random() % 3 == 0;
    // Short changes, so that there are many runs.
    const core::BatchRange change{first, std::min(range.count, 1 + uint32_t(random() % 9))};
    if (set) {
      map.set(1, change);
    } else {
      map.clear(1, change);
    }
    for (uint32_t n = change.first; n < change.end(); ++n) plain[n] = set;

    uint32_t count = 0;
    uint32_t free = 0;
    std::optional<core::BatchRange> run;
    for (uint32_t n = range.first; n < range.end(); ++n) {
      count += plain_a[n];
      const bool is_free = !plain_a[n] && !plain_b[n];
      free += is_free;
      if (is_free && !run) run = core::BatchRange{n, 0};
      if (is_free && run && run->end() == n) ++run->count;
    }
    ASSERT_EQ(a.count(1, range), count);
    ASSERT_EQ(BatchMap::count_free(a, b, 1, range), free);
    ASSERT_EQ(BatchMap::first_free(a, b, 1, range), run);
  }
  EXPECT_EQ(a.count(0, {0, kBatches}), 0U) << "another tile was touched";
}

TEST(RunLength, IsWhatTakesTheUnitsTime) {
  constexpr Duration kUnit = std::chrono::milliseconds(500);
  constexpr uint64_t kPlenty = 1'000'000'000;
  EXPECT_EQ(run_length(0.125, kUnit, kPlenty, 4), 4U);
  EXPECT_EQ(run_length(10, kUnit, kPlenty, 4), 1U) << "a batch is not divided";
  EXPECT_EQ(run_length(1e-12, kUnit, kPlenty, 4), 1'000'000U);
}

TEST(RunLength, LetsTheThreadsEndTogetherWhereLittleIsLeft) {
  constexpr Duration kUnit = std::chrono::milliseconds(500);
  EXPECT_EQ(run_length(0.125, kUnit, 48, 4), 3U) << "four runs for each thread";
  EXPECT_EQ(run_length(0.125, kUnit, 3, 4), 1U);
  EXPECT_EQ(run_length(0.125, kUnit, 0, 4), 1U);
  EXPECT_EQ(run_length(0.125, kUnit, 8, 0), 2U) << "nobody is there yet: as for one thread";
}

}  // namespace
}  // namespace hyades::coordinator
