#include "core/film/film_codec.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <random>

#include "core/base/hash.h"
#include "tests/core/film/film_testing.h"

namespace hyades::core {
namespace {

using Encoded = std::vector<std::byte>;

/// Makes damaged bytes pass the checksum, to get at what lies behind it.
void mend_checksum(Encoded& bytes) {
  if (bytes.size() < 4) return;
  const uint32_t crc = crc32c(std::span(bytes).first(bytes.size() - 4));
  std::copy_n(std::as_bytes(std::span(&crc, 1)).begin(), 4, bytes.end() - 4);
}

Film patchwork() {
  const FilmLayout layout = make_film_layout(kAllLayers);
  Film film(layout, {-4, 10, 28, 30});
  EXPECT_TRUE(film.merge(render(layout, {-4, 10, 5, 20}, {0, 3})).ok());
  EXPECT_TRUE(film.merge(render(layout, {5, 10, 20, 30}, {2, 1})).ok());
  EXPECT_TRUE(film.merge(render(layout, {5, 10, 20, 15}, {4, 4})).ok());
  return film;
}

/// The same with splats; of some pixels one, of others several.
Film splatted_patchwork() {
  LayerSet layers = kAllLayers;
  layers.splats = true;
  const FilmLayout layout = make_film_layout(layers);
  const PixelRect region{-5, 8, 40, 60};
  Film film(layout, {-4, 10, 28, 30}, region);
  EXPECT_TRUE(film.merge(render_with_splats(layout, {-4, 10, 0, 13}, {0, 3}, region)));
  EXPECT_TRUE(film.merge(render_with_splats(layout, {5, 10, 10, 12}, {2, 1}, region)));
  return film;
}

TEST(FilmCodec, GivesBackTheSameFilm) {
  for (const LayerSet& layers : {LayerSet{}, LayerSet{true, false, false}, kAllLayers}) {
    const FilmLayout layout = make_film_layout(layers);
    for (const BatchRange& batches : {BatchRange{0, 1}, BatchRange{3, 5}, BatchRange{0, 0}}) {
      for (const PixelRect& window : {PixelRect{0, 0, 64, 64}, PixelRect{-7, 5, -6, 6},
                                      PixelRect{100, 200, 131, 203}, PixelRect{}}) {
        const Film film = render(layout, window, batches);
        const Encoded bytes = encode_film(film);
        const Result<Film> back = decode_film(bytes);
        ASSERT_TRUE(back.ok()) << back.error().message;
        ASSERT_EQ(back->layout(), film.layout());
        ASSERT_EQ(back->window(), film.window());
        ASSERT_EQ(back->digest(), film.digest());
        ASSERT_EQ(encode_film(*back), bytes);
      }
    }
  }
  for (const Film& film : {patchwork(), splatted_patchwork()}) {
    const Encoded bytes = encode_film(film);
    const Result<Film> back = decode_film(bytes);
    ASSERT_TRUE(back.ok()) << back.error().message;
    EXPECT_EQ(back->digest(), film.digest());
    EXPECT_EQ(encode_film(*back), bytes);
  }
}

TEST(FilmCodec, GivesBackSplatsThatAreFewOrEverywhere) {
  const FilmLayout layout = make_film_layout({.splats = true});
  const PixelRect region{3, 2, 203, 102};
  const PixelRect tile{4, 4, 8, 6};
  for (const BatchRange& batches : {BatchRange{0, 0}, BatchRange{1, 1}, BatchRange{0, 300}}) {
    const Film film = render_with_splats(layout, tile, batches, region);
    // Kept otherwise in memory, the same in bytes.
    Film spread = film;
    spread.mutable_splats().spread();
    const Encoded bytes = encode_film(film);
    EXPECT_EQ(encode_film(spread), bytes);
    const Result<Film> back = decode_film(bytes);
    ASSERT_TRUE(back.ok()) << back.error().message;
    EXPECT_EQ(back->digest(), film.digest());
    EXPECT_EQ(back->splats().region(), region);
    EXPECT_EQ(encode_film(*back), bytes);
  }
}

TEST(FilmCodec, ExtremeSplatsSurvive) {
  const FilmLayout layout = make_film_layout({.splats = true});
  Film film = render(layout, {0, 0, 4, 1}, {0, 1}, 16, {0, 0, 9, 9});
  film.deposit_splats({{0, {3e38F, -3e38F, 1e-40F}},
                       {1, {-1e-40F, 1e-20F, -1e-20F}},
                       {2, {0x1p35F, -0x1p-17F, 0x1.fffffep-18F}},
                       {80, {0.0F, -0.0F, 1.0F}}});
  SplatLayer::Entry odd{3, {}};
  odd.sums.value = {{{0, INT64_MIN}, {~uint64_t{0}, INT64_MAX}, {1, 0}}};
  odd.sums.square = {{{~uint64_t{0}, INT64_MAX}, {1, 0}, {0, 0}}};
  film.mutable_splats().add({odd});
  const Result<Film> back = decode_film(encode_film(film));
  ASSERT_TRUE(back.ok()) << back.error().message;
  EXPECT_EQ(back->digest(), film.digest());
}

TEST(FilmCodec, ASplatTakesAboutTwelveBytesAndItsPlace) {
  const FilmLayout layout = make_film_layout({.splats = true});
  const PixelRect region{0, 0, 1000, 500};
  const Film with = render_with_splats(layout, {0, 0, 16, 16}, {0, 1}, region);
  const Film without = render(layout, {0, 0, 16, 16}, {0, 1}, 1000000, region);
  const double splats = 16.0 * 16 * 32;
  const double size =
      static_cast<double>(encode_film(with).size() - encode_film(without).size()) / splats;
  EXPECT_LT(size, 13.5);
}

TEST(FilmCodec, ExtremeSumsSurvive) {
  constexpr int64_t kMost = 1'099'500'000'000;  // of one batch
  const FilmLayout layout = make_film_layout({});
  Film film = render(layout, {0, 0, 4, 1}, {0, 1});
  film.mutable_plane(0)[0] = {0, -kMost};
  film.mutable_plane(0)[1] = {~uint64_t{0}, kMost - 1};
  film.mutable_plane(1)[0] = {1, 0};
  film.mutable_plane(1)[1] = {0, -1};
  const Result<Film> back = decode_film(encode_film(film));
  ASSERT_TRUE(back.ok()) << back.error().message;
  EXPECT_EQ(back->digest(), film.digest());
}

TEST(FilmCodec, OneBatchTakesAboutFourBytesPerValue) {
  const FilmLayout layout = make_film_layout(kAllLayers);
  const Film film = render(layout, {0, 0, 64, 64}, {5, 1});
  const double values = 64.0 * 64.0 * 14.0;  // samples.N is one number
  const double size = static_cast<double>(encode_film(film).size()) / values;
  EXPECT_LT(size, 4.05);
  EXPECT_LT(encode_film(Film(layout, {0, 0, 64, 64})).size(), 400U) << "an empty film is small";
}

TEST(FilmCodec, TruncationIsRefusedAtEveryLength) {
  for (const Film& film : {render(make_film_layout({}), {0, 0, 6, 5}, {0, 2}),
                           render_with_splats(make_film_layout({.splats = true}), {0, 0, 3, 1},
                                              {0, 2}, {0, 0, 9, 9})}) {
    const Encoded bytes = encode_film(film);
    for (size_t size = 0; size < bytes.size(); ++size) {
      ASSERT_FALSE(decode_film(std::span(bytes).first(size)).ok()) << size;
      Encoded cut(bytes.begin(), bytes.begin() + static_cast<ptrdiff_t>(size));
      mend_checksum(cut);
      ASSERT_FALSE(decode_film(cut).ok()) << size;
    }
  }
}

TEST(FilmCodec, FlippedBitsAreRefused) {
  const std::array<Encoded, 2> films = {encode_film(patchwork()),
                                        encode_film(splatted_patchwork())};
  std::mt19937 random(1);
  for (size_t i = 0; i < 3000; ++i) {
    const Encoded& bytes = films[i % 2];
    Encoded flipped = bytes;
    for (int k = 1 + static_cast<int>(random() % 3); k > 0; --k) {
      flipped[random() % flipped.size()] ^= std::byte{1} << (random() % 8);
    }
    ASSERT_EQ(decode_film(flipped).ok(), flipped == bytes);
  }
}

/// Behind a right checksum (an enemy's, or a bug's): refused or a consistent film, never a crash.
TEST(FilmCodec, HostileBytesAreRefusedOrHarmless) {
  const Encoded plain = encode_film(patchwork());
  const Encoded splatted = encode_film(splatted_patchwork());
  std::mt19937 random(2);
  int refused = 0;
  for (int i = 0; i < 6000; ++i) {
    Encoded hostile = i % 3 == 0 ? plain : splatted;
    // Mostly in the header and coverage, where numbers steer.
    const size_t range = i % 2 == 0 ? std::min<size_t>(300, hostile.size()) : hostile.size();
    for (int k = 1 + static_cast<int>(random() % 4); k > 0; --k) {
      hostile[random() % range] = static_cast<std::byte>(random() % 256);
    }
    if (i % 5 == 0) hostile.resize(random() % hostile.size());
    mend_checksum(hostile);
    const Result<Film> film = decode_film(hostile);
    refused += film.ok() ? 0 : 1;
    ASSERT_TRUE(!film.ok() || film->check().ok());
  }
  EXPECT_GT(refused, 3000);
}

TEST(FilmCodec, ClaimsAreCheckedBeforeMemoryIsTaken) {
  const FilmLayout layout = make_film_layout({});
  Encoded bytes = encode_film(Film(layout, {0, 0, 4, 4}));
  const int32_t huge = 1 << 23;
  std::copy_n(std::as_bytes(std::span(&huge, 1)).begin(), 4, bytes.begin() + 16);
  std::copy_n(std::as_bytes(std::span(&huge, 1)).begin(), 4, bytes.begin() + 20);
  mend_checksum(bytes);
  EXPECT_NE(decode_film(bytes).error().message.find("the limit is"), std::string::npos);

  const int32_t large = 8192;
  std::copy_n(std::as_bytes(std::span(&large, 1)).begin(), 4, bytes.begin() + 16);
  std::copy_n(std::as_bytes(std::span(&large, 1)).begin(), 4, bytes.begin() + 20);
  mend_checksum(bytes);
  EXPECT_NE(decode_film(bytes).error().message.find("cannot hold"), std::string::npos);

  // Splats of more pixels than there are, or than the bytes can hold: their number is behind the
  // window and the region.
  for (const uint32_t count : {uint32_t{17}, uint32_t{1000001}}) {
    Encoded many = encode_film(Film(make_film_layout({.splats = true}), {0, 0, 4, 4},
                                    {0, 0, count == 17 ? 4 : 1000, count == 17 ? 4 : 2000}));
    std::copy_n(std::as_bytes(std::span(&count, 1)).begin(), 4, many.begin() + 40);
    mend_checksum(many);
    EXPECT_NE(decode_film(many).error().message.find(count == 17 ? "more splats than pixels"
                                                                 : "cannot hold"),
              std::string::npos)
        << decode_film(many).error().message;
  }

  // A real film that is large and black has the padding that its size asks for.
  const Film black(layout, {0, 0, 2048, 1024});
  const Encoded padded = encode_film(black);
  EXPECT_GT(padded.size(), 40000U);
  const Result<Film> back = decode_film(padded);
  ASSERT_TRUE(back.ok()) << back.error().message;
  EXPECT_EQ(back->window(), black.window());
  EXPECT_FALSE(decode_film(padded, {uint64_t{1} << 20U}).ok());
}

TEST(FilmCodec, ANewerVersionIsNamed) {
  Encoded bytes = encode_film(patchwork());
  EXPECT_EQ(bytes[4], std::byte{1}) << "as builds that know no splats can read";
  bytes[4] = std::byte{2};
  mend_checksum(bytes);
  EXPECT_NE(decode_film(bytes).error().message.find("unknown layers"), std::string::npos);
  bytes[4] = std::byte{4};
  EXPECT_NE(decode_film(bytes).error().message.find("format version 4; this build knows 3"),
            std::string::npos);
}

TEST(FilmCodec, FilmsThatDoNotAgreeWithThemselvesAreRefused) {
  Film film = patchwork();
  film.mutable_coverage().add({{0, 10, 28, 11}, {100, 1}});
  EXPECT_FALSE(decode_film(encode_film(film)).ok()) << "more batches than samples";
  film = patchwork();
  film.mutable_coverage().add({{27, 29, 29, 30}, {100, 1}});
  EXPECT_FALSE(decode_film(encode_film(film)).ok()) << "outside the window";
  film = Film(make_film_layout({.splats = true}), {0, 0, 2, 2});
  film.deposit_splats({{1, {1, 1, 1}}});
  EXPECT_FALSE(decode_film(encode_film(film)).ok()) << "splats of no batch";
}

}  // namespace
}  // namespace hyades::core
