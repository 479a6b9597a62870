#include "core/film/splats.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <map>
#include <random>

#include "tests/core/film/film_testing.h"

namespace hyades::core {
namespace {

constexpr PixelRect kSplatted{3, 2, 43, 32};

std::vector<PixelSplat> random_splats(std::mt19937& random, size_t count,
                                      const PixelRect& region = kSplatted) {
  std::vector<PixelSplat> splats(count);
  for (PixelSplat& splat : splats) {
    splat.pixel = static_cast<uint32_t>(random() % static_cast<uint64_t>(region.area()));
    for (float& v : splat.value) {
      v = std::ldexp(static_cast<float>(random() % 0x1000000),
                     static_cast<int>(random() % 40) - 40);
    }
    if (random() % 8 == 0) splat.value[1] = -splat.value[1];
  }
  return splats;
}

TEST(SplatLayer, HoldsTheSumsOfItsSplats) {
  SplatLayer layer(kSplatted);
  EXPECT_TRUE(layer.empty());
  layer.deposit({{41, {1, 2, 3}}, {0, {0.5F, 0, 0}}, {41, {10, -20, 30}}});
  EXPECT_EQ(layer.count(), 2U);
  const SplatLayer::Sums sums = layer.at(4, 3);
  EXPECT_EQ(to_double(sums.value[0]), 11.0);
  EXPECT_EQ(to_double(sums.value[1]), -18.0);
  EXPECT_EQ(to_double(sums.square[1]) * kSplatSquareUnit, 404.0);
  EXPECT_EQ(layer.at(3, 2), SplatSums::of({0.5F, 0, 0}));
  EXPECT_EQ(layer.at(42, 31), SplatLayer::Sums{});
}

TEST(SplatLayer, TheSameBitsInAnyOrderAndGrouping) {
  std::mt19937 random(5);
  for (const size_t count : {30U, 300U, 3000U}) {  // sparse, in between, all pixels
    std::vector<PixelSplat> splats = random_splats(random, count);
    SplatLayer once(kSplatted);
    once.deposit(splats);
    std::map<uint32_t, SplatLayer::Sums> expected;
    for (const PixelSplat& splat : splats) expected[splat.pixel] += SplatSums::of(splat.value);
    EXPECT_EQ(once.count(), expected.size());
    for (const auto& [pixel, sums] : expected) {
      const auto width = static_cast<uint32_t>(kSplatted.width());
      ASSERT_EQ(once.at(kSplatted.x0 + static_cast<int>(pixel % width),
                        kSplatted.y0 + static_cast<int>(pixel / width)),
                sums);
    }
    for (int round = 0; round < 8; ++round) {
      std::shuffle(splats.begin(), splats.end(), random);
      std::vector<SplatLayer> parts(3, SplatLayer(kSplatted));
      for (size_t first = 0; first < splats.size();) {
        const size_t last = std::min(first + 1 + random() % count, splats.size());
        const std::vector<PixelSplat> piece(splats.begin() + static_cast<ptrdiff_t>(first),
                                            splats.begin() + static_cast<ptrdiff_t>(last));
        SplatLayer part(kSplatted);
        part.deposit(piece);
        SplatLayer& into = parts[random() % 3];
        if (random() % 2 == 0) {
          into.deposit(piece);
        } else {
          into.merge(part);
        }
        first = last;
      }
      parts[1].merge(parts[2]);
      parts[0].merge(parts[1]);
      ASSERT_EQ(parts[0].digest(), once.digest()) << count;
      ASSERT_EQ(parts[0].count(), once.count());
    }
  }
}

TEST(SplatLayer, ADigestSeesPixelsAndValues) {
  const auto digest = [](std::vector<PixelSplat> splats) {
    SplatLayer layer(kSplatted);
    layer.deposit(std::move(splats));
    return layer.digest();
  };
  const std::string one = digest({{7, {1, 2, 3}}});
  EXPECT_NE(digest({{8, {1, 2, 3}}}), one);
  EXPECT_NE(digest({{7, {1, 2, 3.0000002F}}}), one);
  EXPECT_NE(digest({{7, {0.5F, 1, 1.5F}}, {7, {0.5F, 1, 1.5F}}}), one) << "other squares";
  EXPECT_EQ(digest({{7, {1, 2, 3}}, {9, {0, 0, 0}}}), one) << "black is nothing";
}

TEST(SplatLayer, HoldsTheBrightestSplatsThatCount) {
  SplatLayer layer(kSplatted);
  const float brightest = kMaxDeposit / 32;
  for (int i = 0; i < 1000; ++i) layer.deposit({{1, {brightest, -brightest, 3e38F}}});
  const SplatLayer::Sums sums = layer.at(4, 2);
  EXPECT_EQ(to_double(sums.value[0]), 1000.0 * static_cast<double>(brightest));
  EXPECT_EQ(to_double(sums.value[1]), -1000.0 * static_cast<double>(brightest));
  EXPECT_NEAR(to_double(sums.square[1]) * kSplatSquareUnit / 1000.0 /
                  (static_cast<double>(brightest) * static_cast<double>(brightest)),
              1.0, 1e-6);
  EXPECT_TRUE(layer.check().ok());
}

const FilmLayout kLayout = make_film_layout({.depth = true, .splats = true});

TEST(FilmWithSplats, TheSameBitsInAnyOrderAndGrouping) {
  std::string expected;
  std::mt19937 random(1);
  for (int round = 0; round < 6; ++round) {
    const int side = round == 0 ? 64 : 5 + static_cast<int>(random() % 20);
    std::vector<Film> parts;
    for (int y = kSplatted.y0; y < kSplatted.y1; y += side) {
      for (int x = kSplatted.x0; x < kSplatted.x1; x += side) {
        const PixelRect tile = intersection({x, y, x + side, y + side}, kSplatted);
        for (uint32_t b = 0; b < 4; ++b) {
          parts.push_back(render_with_splats(kLayout, tile, {b, 1}, kSplatted));
        }
      }
    }
    std::shuffle(parts.begin(), parts.end(), random);
    Film whole(kLayout, kSplatted);
    Film other(kLayout, kSplatted);
    for (const Film& part : parts) ASSERT_TRUE((random() % 2 == 0 ? whole : other).merge(part));
    ASSERT_TRUE(whole.merge(other));
    ASSERT_TRUE(whole.check());
    if (round == 0) expected = whole.digest();
    EXPECT_EQ(whole.digest(), expected);
  }
}

TEST(FilmWithSplats, TheirSumIsDividedByAllSamples) {
  Film film(kLayout, {3, 2, 5, 3}, kSplatted);
  const std::vector<float> values = {8, 16, 24, 8, 5, 8, 16, 24, 8, 5};
  film.deposit(film.window(), 0, 8, values);
  film.deposit(film.window(), 1, 2, values);
  film.deposit_splats({{1, {40, 0, -20}}, {1, {60, 0, 0}}, {77, {1000, 0, 0}}});
  FilmLayout plain_layout = make_film_layout({.depth = true});
  Film plain(plain_layout, film.window());
  plain.deposit(film.window(), 0, 8, values);
  plain.deposit(film.window(), 1, 2, values);
  const Image with = film.normalised();
  const Image without = plain.normalised();
  ASSERT_EQ(with.channels, without.channels);
  for (int c = 0; c < with.channel_count(); ++c) {
    EXPECT_EQ(with.at(0, 0, c), without.at(0, 0, c));
  }
  // Two pixels with ten samples each: twenty light paths.
  EXPECT_EQ(with.at(1, 0, 0), without.at(1, 0, 0) + 100.0F / 20);
  EXPECT_EQ(with.at(1, 0, 1), without.at(1, 0, 1));
  EXPECT_FLOAT_EQ(with.at(1, 0, 2), without.at(1, 0, 2) - 20.0F / 20);
  EXPECT_EQ(with.at(1, 0, 3), without.at(1, 0, 3)) << "alpha knows no splats";
  EXPECT_EQ(with.at(1, 0, 4), without.at(1, 0, 4));
  EXPECT_FLOAT_EQ(with.at(1, 0, 5), without.at(1, 0, 5) + (1600.0F + 3600) / 400);
  EXPECT_FLOAT_EQ(with.at(1, 0, 7), without.at(1, 0, 7) + 1.0F);
}

TEST(FilmWithSplats, RefusesOthersThatDoNotFit) {
  Film film(kLayout, kSplatted);
  const Film part = render_with_splats(kLayout, {3, 2, 9, 9}, {0, 1}, kSplatted);
  EXPECT_TRUE(film.merge(part));
  EXPECT_FALSE(film.merge(part)) << "a batch counts once";
  const PixelRect other = {3, 2, 44, 32};
  const Status refused = film.merge(render_with_splats(kLayout, {9, 2, 12, 9}, {0, 1}, other));
  ASSERT_FALSE(refused.ok());
  EXPECT_EQ(refused.error().message, "the films' splats belong to different parts of the frame");
  EXPECT_FALSE(film.merge(render(make_film_layout({.depth = true}), {9, 2, 12, 9}, {0, 1})));
}

TEST(FilmWithSplats, CheckFindsWhatDoesNotAgree) {
  Film film(kLayout, {3, 2, 9, 9}, kSplatted);
  EXPECT_TRUE(film.check());
  film.deposit_splats({{1, {1, 1, 1}}});
  EXPECT_FALSE(film.check()) << "splats of no batch";
  Film good = render_with_splats(kLayout, {3, 2, 9, 9}, {0, 1}, kSplatted);
  EXPECT_TRUE(good.check());
  SplatLayer::Entry negative{5, {}};
  negative.sums.square[1].high = -1000000;
  good.mutable_splats().add({negative});
  EXPECT_FALSE(good.check());
  EXPECT_FALSE(Film(kLayout, {0, 0, 9, 9}, kSplatted).check()) << "a window beyond the region";
}

TEST(FilmWithSplats, CanBeErasedAsAWhole) {
  Film film = render_with_splats(kLayout, kSplatted, {0, 3}, kSplatted);
  film.erase(kSplatted);
  EXPECT_EQ(film.digest(), Film(kLayout, kSplatted).digest());
  ASSERT_TRUE(film.merge(render_with_splats(kLayout, kSplatted, {0, 3}, kSplatted)));
  EXPECT_EQ(film.digest(), render_with_splats(kLayout, kSplatted, {0, 3}, kSplatted).digest());
}

}  // namespace
}  // namespace hyades::core
