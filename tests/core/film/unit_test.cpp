#include "core/film/unit.h"

#include <gtest/gtest.h>

namespace hyades::core {
namespace {

TEST(Unit, SamplesOfAUnitAreTheSumOverItsBatchesAndPixels) {
  const PixelRect tile{3, 4, 8, 6};
  for (const uint32_t samples : {0U, 1U, 15U, 16U, 17U, 40U, 64U}) {
    for (uint32_t first = 0; first < 5; ++first) {
      for (uint32_t count = 0; count < 5; ++count) {
        const BatchRange batches{first, count};
        uint64_t sum = 0;
        for (uint32_t batch = first; batch < first + count; ++batch) {
          sum += samples_in_batch(batch, samples) * static_cast<uint64_t>(tile.area());
        }
        EXPECT_EQ(samples_in(tile, batches, samples), sum)
            << samples << " samples, batches from " << first << ", " << count;
      }
    }
  }
}

}  // namespace
}  // namespace hyades::core
