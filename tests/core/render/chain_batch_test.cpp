#include "core/render/chain_batch.h"

#include <gtest/gtest.h>

namespace hyades::core {
namespace {

TEST(PixelsOfChains, AreThoseOfTheCropWhereItCutsNone) {
  const PixelRect region{10, 4, 290, 196};
  EXPECT_EQ(pixels_of_chains(region, region), 280U * 192U);
  EXPECT_EQ(pixels_of_chains({10, 4, 128, 128}, region), 118U * 124U);
  EXPECT_EQ(pixels_of_chains({64, 128, 290, 196}, region), 226U * 68U);
  EXPECT_EQ(pixels_of_chains({64, 64, 128, 192}, region), 64U * 128U);
}

TEST(PixelsOfChains, OfCropsThatCutThemAddUpToTheRegion) {
  const PixelRect region{10, 4, 290, 196};
  const uint64_t north = pixels_of_chains({10, 4, 290, 100}, region);
  EXPECT_EQ(north, 280U * 124U);  // down to y = 128, where the next ones begin
  EXPECT_EQ(north + pixels_of_chains({10, 100, 290, 196}, region), 280U * 192U);
  EXPECT_EQ(pixels_of_chains({70, 70, 120, 120}, region), 0U);
}

}  // namespace
}  // namespace hyades::core
