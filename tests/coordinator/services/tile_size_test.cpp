#include <gtest/gtest.h>

#include "coordinator/brain/job_desk.h"

namespace hyades::coordinator {
namespace {

TEST(TileSize, IsLargeWhereUnitsWouldBeShort) {
  EXPECT_EQ(tile_size_of({0, 0, 1920, 1080}, 64), 64);
  EXPECT_EQ(tile_size_of({0, 0, 800, 450}, 256), 64);
}

TEST(TileSize, IsSmallWhereThereAreManySamples) {
  EXPECT_EQ(tile_size_of({0, 0, 1920, 1080}, 4096), 32);
}

TEST(TileSize, IsSmallWhereManyThreadsWouldGetNothing) {
  EXPECT_EQ(tile_size_of({0, 0, 192, 108}, 96), 32);
  EXPECT_EQ(tile_size_of({10, 10, 138, 138}, 256), 32);  // a crop of a large frame
}

}  // namespace
}  // namespace hyades::coordinator
