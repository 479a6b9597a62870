#include "core/film/coverage_gaps.h"

#include <gtest/gtest.h>

#include <set>
#include <tuple>

namespace hyades::core {
namespace {

/// Single (pixel, batch) pairs of boxes.
std::set<std::tuple<int, int, uint32_t>> pairs_of(const std::vector<CoverageBox>& boxes) {
  std::set<std::tuple<int, int, uint32_t>> pairs;
  for (const auto& [tile, batches] : boxes) {
    for (int y = tile.y0; y < tile.y1; ++y) {
      for (int x = tile.x0; x < tile.x1; ++x) {
        for (uint32_t b = batches.first; b < batches.end(); ++b) {
          EXPECT_TRUE(pairs.emplace(x, y, b).second) << "twice";
        }
      }
    }
  }
  return pairs;
}

TEST(CoverageGaps, AreAllThatIsNotHeld) {
  const PixelRect crop{3, 2, 15, 11};
  constexpr uint32_t kBatches = 5;
  for (uint32_t seed = 1; seed < 60; ++seed) {
    uint32_t state = seed * 2654435761U;
    const auto below = [&](int32_t n) {
      state = state * 1664525U + 1013904223U;
      return static_cast<int32_t>((state >> 16U) % static_cast<uint32_t>(n));
    };
    Coverage held;
    for (int i = 0; i < static_cast<int>(seed) % 14; ++i) {
      const int32_t x = 3 + below(12);
      const int32_t y = 2 + below(9);
      const auto first = static_cast<uint32_t>(below(kBatches));
      const CoverageBox box{
          intersection(crop, {x, y, x + 1 + below(6), y + 1 + below(5)}),
          {first, 1 + static_cast<uint32_t>(below(static_cast<int32_t>(kBatches - first)))}};
      if (!held.overlap(box)) held.add(box);
    }
    auto all = pairs_of(held.boxes());
    const auto missing = pairs_of(gaps(held, crop, kBatches));
    EXPECT_EQ(missing.size() + all.size(), static_cast<size_t>(crop.area()) * kBatches) << seed;
    all.insert(missing.begin(), missing.end());
    EXPECT_EQ(all.size(), static_cast<size_t>(crop.area()) * kBatches) << seed;
  }
}

TEST(CoverageGaps, NothingIsMissingOfAWhole) {
  Coverage held;
  held.add({{0, 0, 8, 8}, {0, 3}});
  EXPECT_TRUE(gaps(held, {0, 0, 8, 8}, 3).empty());
  EXPECT_EQ(gaps(Coverage(), {0, 0, 8, 8}, 3), (std::vector<CoverageBox>{{{0, 0, 8, 8}, {0, 3}}}));
}

TEST(CoverageGaps, AreToldInSamplesAndTheLastBatchMayBeShort) {
  EXPECT_EQ(describe_gaps({{{0, 0, 64, 32}, {1, 2}}}, 40),
            "pixels x 0 to 63, y 0 to 31: samples 16 to 39");
  const CoverageBox one{{0, 0, 1, 1}, {0, 1}};
  const std::string many = describe_gaps(std::vector<CoverageBox>(8, one), 16);
  EXPECT_NE(many.find("; and 3 more"), std::string::npos) << many;
}

}  // namespace
}  // namespace hyades::core
