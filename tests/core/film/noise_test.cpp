#include "core/film/noise.h"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <cstdint>
#include <limits>
#include <vector>

#include "core/base/hash.h"

namespace hyades::core {
namespace {

/// Samples of a pixel are uniform in [0, 2 `mean`), so that they have the variance mean² / 3.
Film film_of(const PixelRect& window, uint32_t samples, double mean = 0.5) {
  Film film(make_film_layout({}), window);
  std::vector<float> values(static_cast<size_t>(window.area()) * 4);
  for (uint32_t b = 0; b < batch_count(samples); ++b) {
    size_t i = 0;
    for (int64_t pixel = 0; pixel < window.area(); ++pixel) {
      for (uint32_t c = 0; c < 4; ++c) {
        double sum = 0;
        for (uint32_t s = 0; s < kBatchSamples; ++s) {
          const uint64_t h = hash_combine(static_cast<uint64_t>(pixel), b << 8U | c << 6U | s);
          sum += 2 * mean * static_cast<double>(h >> 11U) * 0x1p-53;
        }
        values[i++] = static_cast<float>(sum);
      }
    }
    film.deposit(window, b, kBatchSamples, values);
  }
  return film;
}

/// What film_of() has in truth: the standard error of its pixels.
double error_of(uint32_t samples, double mean) { return mean / std::sqrt(3.0 * samples); }

TEST(PictureNoise, IsTheMeanOfItsBlocks) {
  // 64 blocks of 64 pixels, each with 39 differences of three channels: good to 0.2 %.
  const Film film = film_of({3, 5, 67, 69}, 640);
  EXPECT_NEAR(picture_noise(film, 0) / (error_of(640, 0.5) / std::sqrt(0.5)), 1.0, 0.01);
}

TEST(PictureNoise, FallsWithTheRootOfTheSamples) {
  const double few = picture_noise(film_of({0, 0, 64, 64}, 64), 0);
  const double many = picture_noise(film_of({0, 0, 64, 64}, 1024), 0);
  EXPECT_NEAR(few / many, 4.0, 0.2);
}

TEST(PictureNoise, IsUnknownWithoutTwoBatches) {
  EXPECT_EQ(picture_noise(film_of({0, 0, 64, 64}, 16), 0), -1);
  EXPECT_EQ(picture_noise(Film{}, 0), -1);
}

TEST(PictureNoise, IsKnownOnceMostOfThePictureIsThere) {
  Film film(make_film_layout({}), {0, 0, 300, 200});
  EXPECT_EQ(picture_noise(film, 0), -1);
  ASSERT_TRUE(film.merge(film_of({0, 0, 150, 200}, 64)).ok());
  EXPECT_EQ(picture_noise(film, 0), -1) << "of an even half";
  ASSERT_TRUE(film.merge(film_of({150, 0, 250, 200}, 64)).ok());
  EXPECT_NEAR(picture_noise(film, 0) / picture_noise(film_of({0, 0, 250, 200}, 64), 0), 1.0, 0.05);
}

TEST(PictureNoise, IsThatOfSplatsToo) {
  const PixelRect region{0, 0, 8, 8};
  Film film(make_film_layout({.splats = true}), region);
  const std::vector<float> white(64 * 4, 16.0F);
  for (uint32_t b = 0; b < 4; ++b) film.deposit(region, b, 16, white);
  EXPECT_EQ(picture_noise(film, 0), 0.0);
  // Every pixel gets 64 splats of 4096 light paths, so that 64 give as much as the camera's.
  std::vector<PixelSplat> splats;
  for (uint32_t i = 0; i < 64 * 64; ++i) splats.push_back({i % 64, {64, 64, 64}});
  film.deposit_splats(std::move(splats));
  EXPECT_NEAR(picture_noise(film, 0), std::sqrt(1.0 / 64) / 2, 1e-6);
}

TEST(TileNoise, IsTheErrorOverTheRootOfWhatIsShown) {
  // The mean over a block of 64 pixels with 39 differences of three channels each is good to about
  // 1 %; the worst of 16 blocks is some 2 % above.
  const PixelRect tile{3, 5, 35, 37};
  const Film film = film_of(tile, 640);
  EXPECT_NEAR(tile_noise(film, tile, 0) / (error_of(640, 0.5) / std::sqrt(0.5)), 1.02, 0.03);
}

TEST(TileNoise, IsTheErrorOverWhatIsShownWhereThatIsBright) {
  const PixelRect tile{0, 0, 16, 16};
  const Film film = film_of(tile, 640, 4.0);
  EXPECT_NEAR(tile_noise(film, tile, 0) / (error_of(640, 4.0) / 4.0), 1.02, 0.03);
}

TEST(TileNoise, IsThatOfThePictureWithItsExposure) {
  const PixelRect tile{0, 0, 16, 16};
  EXPECT_NEAR(
      tile_noise(film_of(tile, 64, 0.5), tile, -3) / tile_noise(film_of(tile, 64, 0.0625), tile, 0),
      1.0, 1e-6);
}

TEST(TileNoise, IsThatOfTheWorstBlock) {
  const PixelRect tile{0, 0, 32, 32};
  Film film(make_film_layout({}), tile);
  std::vector<float> values(static_cast<size_t>(tile.area()) * 4, 16.0F);
  for (uint32_t b = 0; b < 4; ++b) {
    // One pixel flickers by its own brightness: its mean has the standard error 1/2 / sqrt(3),
    // its block's mean square is a 64th of that.
    const size_t at = (static_cast<size_t>(9) * 32 + 20) * 4;
    for (size_t c = 0; c < 3; ++c) values[at + c] = b % 2 == 0 ? 0.0F : 32.0F;
    film.deposit(tile, b, kBatchSamples, values);
  }
  EXPECT_NEAR(tile_noise(film, tile, 0), 1 / std::sqrt(3.0) / 8, 1e-6);
  EXPECT_EQ(tile_noise(film, {0, 16, 32, 32}, 0), 0.0);
}

TEST(TileNoise, OfWhatIsBlackIsNone) {
  const PixelRect tile{0, 0, 8, 8};
  EXPECT_EQ(tile_noise(film_of(tile, 64, 0.0), tile, 0), 0.0);
}

TEST(TileNoise, IsNotKnownOfOneBatch) {
  const PixelRect tile{0, 0, 8, 8};
  EXPECT_EQ(tile_noise(film_of(tile, 16), tile, 0), std::numeric_limits<double>::infinity());
}

TEST(NoiseThreshold, IsLookedAtAfterEveryHalfAsManyBatchesMore) {
  EXPECT_EQ(make_noise_threshold({0.02F, 0, 32}, 512).rounds,
            (std::vector<uint32_t>{2, 3, 4, 6, 9, 13, 19, 28}));
  EXPECT_EQ(make_noise_threshold({0.02F, 0, 100}, 512).rounds,
            (std::vector<uint32_t>{7, 10, 15, 22}));
  EXPECT_TRUE(make_noise_threshold({0.02F, 0, 512}, 512).rounds.empty());
  EXPECT_TRUE(make_noise_threshold({0, 0, 32}, 512).rounds.empty());
}

TEST(NoiseThreshold, IsReachedWhereNoBlockIsNoisier) {
  const PixelRect tile{0, 0, 16, 16};
  const Film film = film_of(tile, 64);
  const auto noise = static_cast<float>(tile_noise(film, tile, 0));
  EXPECT_TRUE(is_clean(film, tile, make_noise_threshold({noise * 1.001F, 0, 32}, 512)));
  EXPECT_FALSE(is_clean(film, tile, make_noise_threshold({noise * 0.999F, 0, 32}, 512)));
}

TEST(UnfinishedTiles, AreThoseThatAreNoisyOrHaveNoRound) {
  const PixelRect crop{10, 0, 74, 20};  // tiles begin at 10, 32 and 64
  const std::array<PixelRect, 3> tiles = {PixelRect{10, 0, 32, 20}, PixelRect{32, 0, 64, 20},
                                          PixelRect{64, 0, 74, 20}};
  const NoiseThreshold threshold = make_noise_threshold({0.1F, 0, 32}, 512);
  const auto unfinished = [&](uint32_t first, uint32_t second, uint32_t third) {
    Film film(make_film_layout({}), crop);
    const std::array<uint32_t, 3> samples = {first, second, third};
    for (size_t i = 0; i < 3; ++i) {
      if (samples[i] == 0) continue;
      EXPECT_TRUE(film.merge(film_of(tiles[i], samples[i])).ok());
    }
    return unfinished_tiles(film, crop, 512, threshold);
  };
  // 64 samples have a noise of 0.051.
  EXPECT_TRUE(unfinished(64, 96, 512).empty());
  EXPECT_EQ(unfinished(64, 80, 64), std::vector{tiles[1]}) << "five batches are no round";
  EXPECT_EQ(unfinished(0, 64, 16), (std::vector{tiles[0], tiles[2]}));
  const NoiseThreshold strict = make_noise_threshold({0.03F, 0, 32}, 512);
  EXPECT_EQ(unfinished_tiles(film_of(crop, 64), crop, 512, strict).size(), 3U);
  EXPECT_TRUE(unfinished_tiles(film_of(crop, 512), crop, 512, strict).empty());
}

}  // namespace
}  // namespace hyades::core
