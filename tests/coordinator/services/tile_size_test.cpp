#include <gtest/gtest.h>

#include "coordinator/controller/active_job.h"
#include "coordinator/scheduler/tile_grid.h"

namespace hyades::coordinator {
namespace {

TEST(TileSize, IsLargeWhereUnitsWouldBeShort) {
  EXPECT_EQ(tile_size_of({0, 0, 1920, 1080}, 64, false, false), 64);
  EXPECT_EQ(tile_size_of({0, 0, 800, 450}, 256, false, false), 64);
}

TEST(TileSize, IsSmallWhereThereAreManySamples) {
  EXPECT_EQ(tile_size_of({0, 0, 1920, 1080}, 4096, false, false), 32);
}

TEST(TileSize, IsSmallWhereManyThreadsWouldGetNothing) {
  EXPECT_EQ(tile_size_of({0, 0, 192, 108}, 96, false, false), 32);
  EXPECT_EQ(tile_size_of({10, 10, 138, 138}, 256, false, false), 32);  // a crop of a large frame
}

TEST(TileSize, IsLargerStillWhereEveryUnitHasALayerOverTheFrame) {
  EXPECT_EQ(tile_size_of({0, 0, 1920, 1080}, 4096, true, false), 128);
  EXPECT_EQ(tile_size_of({0, 0, 192, 108}, 96, true, false), 128);
}

TEST(TileSize, IsThatOfASingleMachineWhereTilesAreJudged) {
  EXPECT_EQ(tile_size_of({0, 0, 1920, 1080}, 64, false, true), kTile);
}

}  // namespace
}  // namespace hyades::coordinator
