#include "core/film/film.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <random>
#include <vector>

#include "core/film/black.h"
#include "tests/core/film/film_testing.h"

namespace hyades::core {
namespace {

constexpr float kInfinity = std::numeric_limits<float>::infinity();
TEST(FilmLayout, HasTheChannelsInFixedOrder) {
  const FilmLayout all = make_film_layout(kAllLayers);
  std::vector<std::string> names;
  for (const FilmChannel& c : all.channels) names.push_back(c.name);
  EXPECT_EQ(names, (std::vector<std::string>{"R", "G", "B", "A", "depth.Z", "albedo.R", "albedo.G",
                                             "albedo.B", "normal.X", "normal.Y", "normal.Z",
                                             "moment2.R", "moment2.G", "moment2.B", "samples.N"}));
  EXPECT_EQ(all.deposited, 11);
  EXPECT_EQ(all.depth, 4);
  EXPECT_EQ(all.albedo, 5);
  EXPECT_EQ(all.normal, 8);
  EXPECT_EQ(all.moment2, 11);
  EXPECT_EQ(all.samples, 14);
  const FilmLayout none = make_film_layout({});
  EXPECT_EQ(none.deposited, 4);
  EXPECT_EQ(none.depth, -1);
  EXPECT_EQ(none.moment2, 4);
  EXPECT_EQ(none.samples, 7);
}

TEST(Film, TheSameBitsInAnyOrderAndGrouping) {
  const FilmLayout layout = make_film_layout(kAllLayers);
  const PixelRect window{5, 3, 47, 38};
  const uint32_t batches = 6;
  const std::string expected = render(layout, window, {0, batches}, 90).digest();

  std::mt19937 random(1);
  for (int round = 0; round < 6; ++round) {
    const int side = 5 + static_cast<int>(random() % 20);
    std::vector<Film> parts;
    for (int y = window.y0; y < window.y1; y += side) {
      for (int x = window.x0; x < window.x1; x += side) {
        const PixelRect tile = intersection({x, y, x + side, y + side}, window);
        for (uint32_t first = 0; first < batches;) {
          const uint32_t count = std::min(1 + static_cast<uint32_t>(random() % 3), batches - first);
          parts.push_back(render(layout, tile, {first, count}, 90));
          first += count;
        }
      }
    }
    std::shuffle(parts.begin(), parts.end(), random);
    // Some go into the whole directly, others by way of films of their own.
    Film whole(layout, window);
    Film left(layout, window);
    Film right(layout, window);
    for (const Film& part : parts) {
      Film& into = random() % 3 == 0 ? whole : (random() % 2 == 0 ? left : right);
      ASSERT_TRUE(into.merge(part).ok());
    }
    ASSERT_TRUE(right.merge(left).ok());
    ASSERT_TRUE(whole.merge(right).ok());
    ASSERT_TRUE(whole.check().ok());
    ASSERT_EQ(whole.digest(), expected);
  }
}

TEST(Film, DigestSeesEveryDifference) {
  const FilmLayout layout = make_film_layout(kAllLayers);
  const Film film = render(layout, {0, 0, 4, 4}, {0, 2});
  const std::string digest = film.digest();
  Film other = film;
  other.mutable_plane(2)[5] += {1, 0};
  EXPECT_NE(other.digest(), digest);
  other.mutable_plane(2)[5] -= {1, 0};
  EXPECT_EQ(other.digest(), digest);
  EXPECT_NE(render(layout, {0, 0, 4, 4}, {0, 3}).digest(), digest);
  EXPECT_NE(Film(layout, {0, 0, 4, 4}).digest(), Film(layout, {0, 0, 4, 5}).digest());
  EXPECT_NE(Film(layout, {0, 0, 4, 4}).digest(), Film(make_film_layout({}), {0, 0, 4, 4}).digest());
}

TEST(Film, IsBlackUntilLightReachesAPixel) {
  const PixelRect pixel{2, 1, 3, 2};
  Film film(make_film_layout({.splats = true}), pixel, {0, 0, 4, 4});
  EXPECT_TRUE(is_black(film));
  film.deposit(pixel, 0, 1, std::vector<float>{0, 0, 0, 1});
  EXPECT_TRUE(is_black(film)) << "what covers a pixel is no light";
  Film splat = film;
  splat.deposit_splats({{5, {0, 0, 1e-6F}}});
  EXPECT_FALSE(is_black(splat));
  film.deposit(pixel, 1, 1, std::vector<float>{0, 1e-6F, 0, 1});
  EXPECT_FALSE(is_black(film));
}

TEST(Film, AWrongContributionCanBeSubtracted) {
  const FilmLayout layout = make_film_layout({});
  const PixelRect window{0, 0, 8, 8};
  Film film = render(layout, window, {0, 3});
  const Film before = film;
  const Film wrong = render(layout, window, {7, 2});
  ASSERT_TRUE(film.merge(wrong).ok());
  for (int c = 0; c < static_cast<int>(layout.channels.size()); ++c) {
    for (size_t i = 0; i < film.plane(c).size(); ++i) {
      film.mutable_plane(c)[i] -= wrong.plane(c)[i];
      ASSERT_EQ(film.plane(c)[i], before.plane(c)[i]);
    }
  }
}

TEST(Film, AnErasedTileHasNeverBeenThere) {
  const FilmLayout layout = make_film_layout(kAllLayers);
  const PixelRect window{0, 0, 12, 9};
  Film film(layout, window);
  Film without(layout, window);
  for (const PixelRect& tile : {PixelRect{0, 0, 4, 9}, PixelRect{4, 0, 8, 4}, PixelRect{4, 4, 8, 9},
                                PixelRect{8, 0, 12, 9}}) {
    const Film part = render(layout, tile, {0, 3});
    ASSERT_TRUE(film.merge(part).ok());
    if (tile != PixelRect{4, 4, 8, 9}) {
      ASSERT_TRUE(without.merge(part).ok());
    }
  }
  film.erase({4, 4, 8, 9});
  EXPECT_EQ(film.digest(), without.digest());
  EXPECT_TRUE(film.check().ok());
  // And it can be rendered again.
  ASSERT_TRUE(film.merge(render(layout, {4, 4, 8, 9}, {0, 3})).ok());
  EXPECT_NE(film.digest(), without.digest());
}

TEST(Film, RefusesWhatDoesNotFitAndChangesNothing) {
  const FilmLayout layout = make_film_layout(kAllLayers);
  const PixelRect window{0, 0, 32, 32};
  Film film(layout, window);
  ASSERT_TRUE(film.merge(render(layout, {8, 8, 16, 16}, {1, 2})).ok());
  const std::string before = film.digest();

  // Its first part is new, only its last overlaps.
  Film twice(layout, window);
  ASSERT_TRUE(twice.merge(render(layout, {0, 0, 8, 8}, {0, 1})).ok());
  ASSERT_TRUE(twice.merge(render(layout, {12, 12, 20, 20}, {2, 2})).ok());
  const Status overlap = film.merge(twice);
  ASSERT_FALSE(overlap.ok());
  EXPECT_EQ(overlap.error().message,
            "both films hold batches 2 to 2 of pixels x 12 to 15, y 12 to 15");
  EXPECT_EQ(film.digest(), before);

  EXPECT_FALSE(film.merge(render(layout, {24, 24, 33, 32}, {0, 1})).ok());
  EXPECT_FALSE(film.merge(render(make_film_layout({}), {0, 0, 8, 8}, {0, 1})).ok());
  EXPECT_EQ(film.digest(), before);
  EXPECT_TRUE(film.merge(Film(layout, {})).ok());
  EXPECT_EQ(film.digest(), before);
}

TEST(Film, NormalisedIsTheMean) {
  const FilmLayout layout = make_film_layout(kAllLayers);
  const PixelRect window{10, 20, 13, 22};
  Film film(layout, window);
  // 8 + 4 samples of pixel (11, 21) alone.
  const PixelRect tile{11, 21, 12, 22};
  const std::vector<float> a = {8, 16, 24, 8, 5, 4, 4, 4, 0, -8, 0};
  const std::vector<float> b = {16, 8, 12, 4, 3, 2, 2, 2, 0, -4, 0};
  film.deposit(tile, 0, 8, a);
  film.deposit(tile, 1, 4, b);

  const Image image = film.normalised();
  EXPECT_EQ(image.channels,
            (std::vector<std::string>{"R", "G", "B", "A", "depth.Z", "albedo.R", "albedo.G",
                                      "albedo.B", "normal.X", "normal.Y", "normal.Z", "variance.R",
                                      "variance.G", "variance.B", "samples.N"}));
  ASSERT_EQ(image.width, 3);
  ASSERT_EQ(image.height, 2);
  // R: q = 64/8 + 256/4 = 72, S^2/N = 576/12 = 48, sigma^2 = 24, of the mean 24/12 = 2.
  const std::vector<float> expected = {2, 2, 3, 1, 3, 0.5F, 0.5F, 0.5F, 0, -1, 0, 2, 0, 0, 12};
  for (int c = 0; c < image.channel_count(); ++c) {
    EXPECT_EQ(image.at(1, 1, c), expected[static_cast<size_t>(c)]) << image.channels[c];
    EXPECT_EQ(image.at(0, 0, c), 0.0F);
    EXPECT_EQ(image.at(2, 1, c), 0.0F);
  }
}

TEST(Film, DepthIsTheNearestAndInfiniteWhereNothingWasHit) {
  const FilmLayout layout = make_film_layout({true, false, false});
  Film film(layout, {0, 0, 3, 1});
  const std::vector<float> far = {1, 1, 1, 1, 7, 1, 1, 1, 1, kInfinity, 1, 1, 1, 1, 0.0F};
  const std::vector<float> near = {1, 1, 1, 1, 2, 1, 1, 1, 1, kInfinity, 1, 1, 1, 1, -0.0F};
  Film other = film;
  film.deposit(film.window(), 0, 1, far);
  film.deposit(film.window(), 1, 1, near);
  other.deposit(other.window(), 1, 1, near);
  other.deposit(other.window(), 0, 1, far);
  EXPECT_EQ(film.normalised().at(0, 0, 4), 2.0F);
  EXPECT_EQ(film.normalised().at(1, 0, 4), kInfinity);
  EXPECT_EQ(film.digest(), other.digest()) << "signed zeros depend on the order";
}

/// 20,000 pixels, three channels, 25 batches of samples whose variance is known.
TEST(Film, VarianceOfTheMeanIsUnbiased) {
  const FilmLayout layout = make_film_layout({});
  const uint32_t samples = 16 * 24 + 5;  // the last batch is short
  const PixelRect window{0, 0, 200, 100};
  Film film(layout, window);
  std::mt19937 random(3);
  std::uniform_real_distribution<double> uniform(2.0, 3.0);  // variance 1/12
  std::vector<float> values(static_cast<size_t>(window.area()) * 4);
  for (uint32_t b = 0; b < batch_count(samples); ++b) {
    const uint32_t n = samples_in_batch(b, samples);
    for (float& v : values) {
      double sum = 0.0;
      for (uint32_t i = 0; i < n; ++i) sum += uniform(random);
      v = static_cast<float>(sum);
    }
    film.deposit(window, b, n, values);
  }
  const Image image = film.normalised();
  double mean = 0.0;
  for (int y = 0; y < image.height; ++y) {
    for (int x = 0; x < image.width; ++x) {
      for (int c = 4; c < 7; ++c) mean += image.at(x, y, c) / (3.0 * image.width * image.height);
    }
  }
  // One estimate has a relative standard error of sqrt(2 / 24) = 29 %; the mean of 60,000 has
  // 0.12 %: a 1 % error is eight standard errors away.
  EXPECT_NEAR(mean * samples * 12.0, 1.0, 0.005);
}

TEST(Film, ExtremeDepositsAreClampedNotWrapped) {
  const FilmLayout layout = make_film_layout({});
  Film film(layout, {0, 0, 1, 1});
  const std::vector<float> huge = {3e38F, -3e38F, 1e12F, 1};
  for (uint32_t b = 0; b < 1000; ++b) film.deposit(film.window(), b, 16, huge);
  EXPECT_EQ(to_double(film.sum(0, 0, 0)), 1000.0 * static_cast<double>(kMaxDeposit));
  EXPECT_EQ(to_double(film.sum(0, 0, 1)), -1000.0 * static_cast<double>(kMaxDeposit));
  for (int c = 4; c < 7; ++c) EXPECT_GT(film.sum(0, 0, c).high, 0);
  for (const float v : film.normalised().data) EXPECT_TRUE(std::isfinite(v));
}

TEST(Film, CheckFindsWhatDoesNotAgree) {
  const FilmLayout layout = make_film_layout(kAllLayers);
  const Film good = render(layout, {0, 0, 4, 4}, {0, 2});
  EXPECT_TRUE(good.check().ok());
  Film film = good;
  film.mutable_plane(layout.samples)[3].high = 33;
  EXPECT_FALSE(film.check().ok());
  film = good;
  film.mutable_plane(layout.samples)[3].low = 1;
  EXPECT_FALSE(film.check().ok());
  film = good;
  film.mutable_coverage().add({{3, 0, 5, 4}, {5, 1}});
  EXPECT_FALSE(film.check().ok());
  film = Film(layout, {0, 0, 4, 4});
  EXPECT_TRUE(film.check().ok());
  film.mutable_plane(0)[3].low = 1;
  EXPECT_FALSE(film.check().ok());
}

TEST(Film, CheckRefusesNegativeSumsOfSquares) {
  const FilmLayout layout = make_film_layout(kAllLayers);
  for (int channel = 0; channel < 3; ++channel) {
    Film film = render(layout, {0, 0, 4, 4}, {0, 2});
    film.mutable_plane(layout.moment2 + channel)[7] = {0, -1};
    const Status checked = film.check();
    ASSERT_FALSE(checked.ok()) << channel;
    EXPECT_EQ(checked.error().message, "a sum of squares is negative");
    film.mutable_plane(layout.moment2 + channel)[7] = {};
    EXPECT_TRUE(film.check().ok()) << channel;
  }
}

}  // namespace
}  // namespace hyades::core
