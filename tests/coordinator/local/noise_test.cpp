#include "coordinator/local/noise.h"

#include <gtest/gtest.h>

#include <cmath>

#include "tests/coordinator/local/fake_render.h"

namespace hyades::coordinator {
namespace {

core::Film film_of(const core::PixelRect& window, uint32_t samples) {
  return fake_film({1, window, {0, core::batch_count(samples)}}, samples);
}

TEST(Noise, IsTheRelativeStandardError) {
  // Samples are uniform in [0, 1): mean 1/2, variance 1/12. The estimate itself has a relative
  // standard deviation of about 1 / sqrt(2 * 39 batches * 3 channels * 4000 pixels) = 0.1 %.
  constexpr uint32_t kSamples = 640;
  const double truth = std::sqrt(1.0 / 12 / kSamples) / 0.5;
  EXPECT_NEAR(estimate_noise(film_of({3, 5, 67, 69}, kSamples)) / truth, 1.0, 0.01);
}

TEST(Noise, FallsWithTheRootOfTheSamples) {
  const double few = estimate_noise(film_of({0, 0, 64, 64}, 64));
  const double many = estimate_noise(film_of({0, 0, 64, 64}, 1024));
  EXPECT_NEAR(few / many, 4.0, 0.2);
}

TEST(Noise, IsUnknownWithoutTwoBatches) {
  EXPECT_EQ(estimate_noise(film_of({0, 0, 64, 64}, 16)), -1);
  EXPECT_EQ(estimate_noise(film_of({0, 0, 3, 3}, 640)), -1) << "too few pixels";
  EXPECT_EQ(estimate_noise(core::Film{}), -1);
}

TEST(Noise, LooksAtSomePixelsOfABigFilm) {
  core::Film film(core::make_film_layout({}), {0, 0, 3000, 2000});
  EXPECT_EQ(estimate_noise(film), -1);
}

TEST(Noise, IsThatOfSplatsToo) {
  const core::PixelRect region{0, 0, 8, 8};
  core::Film film(core::make_film_layout({.splats = true}), region);
  const std::vector<float> white(64 * 4, 16.0F);
  for (uint32_t b = 0; b < 4; ++b) film.deposit(region, b, 16, white);
  EXPECT_EQ(estimate_noise(film), 0.0);
  // Every pixel gets 64 splats of 4096 light paths, so that 64 give as much as the camera's.
  std::vector<core::PixelSplat> splats;
  for (uint32_t i = 0; i < 64 * 64; ++i) splats.push_back({i % 64, {64, 64, 64}});
  film.deposit_splats(splats);
  EXPECT_NEAR(estimate_noise(film), std::sqrt(1.0 / 64) / 2, 1e-6);
}

}  // namespace
}  // namespace hyades::coordinator
