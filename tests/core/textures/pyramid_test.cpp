#include "core/textures/pyramid.h"

#include <gtest/gtest.h>

#include <cmath>

#include "core/image/decoders.h"
#include "tests/core/textures/pyramids.h"
#include "tests/support/random.h"

namespace hyades::core {
namespace {

Vec4 texel(const Texels& level, int x, int y) {
  switch (level.format()) {
    case TexelFormat::bytes:
      return level.texel<TexelFormat::bytes>(x, y);
    case TexelFormat::words:
      return level.texel<TexelFormat::words>(x, y);
    case TexelFormat::halves:
      return level.texel<TexelFormat::halves>(x, y);
    case TexelFormat::floats:
      break;
  }
  return level.texel<TexelFormat::floats>(x, y);
}

Image random_image(int width, int height, std::vector<std::string> channels) {
  test::Random random(7);
  Image image = make_image(width, height, std::move(channels));
  for (float& value : image.data) value = random.uniform();
  return image;
}

/// Of red (or grey) over all texels.
double mean(const Texels& level) {
  double sum = 0.0;
  for (int y = 0; y < level.height(); ++y) {
    for (int x = 0; x < level.width(); ++x) sum += double{texel(level, x, y).x};
  }
  return sum / level.width() / level.height();
}

// Codes of every kind and channel count, as their files mean them.
TEST(Pyramid, FirstLevelIsTheImageInTheSmallestFormThatHoldsIt) {
  test::Random random(8);
  const struct {
    TexelFormat format;
    float (*value)(test::Random&, bool alpha);
  } kinds[] = {
      {TexelFormat::bytes,
       [](test::Random& r, bool alpha) { return linear_of_8_bits(!alpha)[r.bits() % 256]; }},
      {TexelFormat::bytes,
       [](test::Random& r, bool) { return linear_of_8_bits(false)[r.bits() % 256]; }},
      {TexelFormat::words,
       [](test::Random& r, bool alpha) { return linear_of_16_bits(!alpha)[r.bits() % 65536]; }},
      {TexelFormat::words,
       [](test::Random& r, bool) { return linear_of_16_bits(false)[r.bits() % 65536]; }},
      {TexelFormat::halves,
       [](test::Random& r, bool) { return from_half(static_cast<uint16_t>(r.bits() % 0x7C00)); }},
      {TexelFormat::floats, [](test::Random& r, bool) { return r.uniform() - 0.5F; }},
  };
  for (const auto& kind : kinds) {
    for (const auto& channels : std::vector<std::vector<std::string>>{
             {"Y"}, {"Y", "A"}, {"R", "G", "B"}, {"R", "G", "B", "A"}}) {
      Image image = make_image(19, 13, channels);
      const size_t count = channels.size();
      for (size_t i = 0; i < image.data.size(); ++i) {
        image.data[i] = kind.value(random, count % 2 == 0 && i % count == count - 1);
      }
      const ImagePyramid pyramid = *pyramid_of(image, WrapMode::clamp);
      const Texels& level = pyramid.levels()[0];
      EXPECT_EQ(level.format(), kind.format);
      EXPECT_EQ(level.channels(), static_cast<int>(count));
      const auto colors = static_cast<int>(count < 3 ? 1 : 3);
      for (int y = 0; y < 13; ++y) {
        for (int x = 0; x < 19; ++x) {
          const Vec4 found = texel(level, x, 12 - y);
          for (int c = 0; c < 3; ++c) EXPECT_EQ(found[c], image.at(x, y, colors == 1 ? 0 : c));
          EXPECT_EQ(found.w, count % 2 == 0 ? image.at(x, y, colors) : 1.0F);
        }
      }
      EXPECT_EQ(texel(level, -1, 0), Vec4(0.0F));
      EXPECT_EQ(texel(level, 0, -1), Vec4(0.0F));
    }
  }
}

TEST(Pyramid, LevelsHalveToASingleTexel) {
  const ImagePyramid pyramid = *pyramid_of(random_image(21, 6, {"R", "G", "B"}), WrapMode::repeat);
  const std::vector<Vec2i> expected = {{21, 6}, {10, 3}, {5, 1}, {2, 1}, {1, 1}};
  ASSERT_EQ(pyramid.levels().size(), expected.size());
  for (size_t i = 0; i < expected.size(); ++i) {
    EXPECT_EQ(pyramid.levels()[i].width(), expected[i].x);
    EXPECT_EQ(pyramid.levels()[i].height(), expected[i].y);
  }
  EXPECT_TRUE(pyramid_of(Image(), WrapMode::repeat)->levels().empty());
}

TEST(Pyramid, EveryTexelCountsAlikeWhereTheImageRepeats) {
  for (const int side : {64, 37, 3}) {
    const ImagePyramid pyramid =
        *pyramid_of(random_image(side, 2 * side + 1, {"Y"}), WrapMode::repeat);
    for (const Texels& level : pyramid.levels()) {
      EXPECT_NEAR(mean(level), mean(pyramid.levels()[0]), 1e-6) << side;
    }
  }
  // A mirrored one does too, for sides that can be halved.
  const ImagePyramid mirrored = *pyramid_of(random_image(64, 32, {"Y"}), WrapMode::mirror);
  EXPECT_NEAR(mean(mirrored.levels().back()), mean(mirrored.levels()[0]), 1e-6);
}

TEST(Pyramid, WhiteStaysWhite) {
  for (const WrapMode wrap : {WrapMode::repeat, WrapMode::clamp, WrapMode::mirror}) {
    Image image = make_image(23, 17, {"R", "G", "B", "A"});
    for (float& value : image.data) value = 1.0F;
    image.at(3, 4, 3) = 0.5F;  // one hole: colours do not mind
    const ImagePyramid pyramid = *pyramid_of(image, wrap);
    for (const Texels& level : pyramid.levels()) {
      for (int y = 0; y < level.height(); ++y) {
        for (int x = 0; x < level.width(); ++x) EXPECT_NEAR(texel(level, x, y).x, 1.0F, 1e-6F);
      }
    }
  }
}

// The weights 1 3 3 1 along each side, and what lies beyond the edges.
TEST(Pyramid, TentsReachOverTheEdgesAsImagesWrap) {
  Image image = make_image(8, 1, {"Y"});
  for (int x = 0; x < 8; ++x) image.at(x, 0, 0) = static_cast<float>(1 << x);
  const auto first = [&](WrapMode wrap) {
    return texel(pyramid_of(image, wrap)->levels()[1], 0, 0).x;
  };
  EXPECT_FLOAT_EQ(first(WrapMode::repeat), (128.0F + 3 * 1 + 3 * 2 + 4) / 8);
  EXPECT_FLOAT_EQ(first(WrapMode::clamp), (1.0F + 3 * 1 + 3 * 2 + 4) / 8);
  EXPECT_FLOAT_EQ(first(WrapMode::mirror), (1.0F + 3 * 1 + 3 * 2 + 4) / 8);
  EXPECT_FLOAT_EQ(first(WrapMode::black), (0.0F + 3 * 1 + 3 * 2 + 4) / 8);
  const ImagePyramid pyramid = *pyramid_of(image, WrapMode::repeat);
  const Texels& level = pyramid.levels()[1];
  EXPECT_FLOAT_EQ(texel(level, 1, 0).x, (2.0F + 3 * 4 + 3 * 8 + 16) / 8);
  EXPECT_FLOAT_EQ(texel(level, 3, 0).x, (32.0F + 3 * 64 + 3 * 128 + 1) / 8);
}

// Means are those of light: a board of sRGB black and white is 0.5, not the light of code 127.
TEST(Pyramid, MeansAreOfLightAndColoursCountByTheirAlpha) {
  Image board = make_image(4, 4, {"Y"});
  for (int i = 0; i < 16; ++i)
    board.data[static_cast<size_t>(i)] = (i + i / 4) % 2 == 0 ? 0.0F : 1.0F;
  EXPECT_FLOAT_EQ(texel(pyramid_of(board, WrapMode::repeat)->levels().back(), 0, 0).x, 0.5F);

  Image leaf = make_image(2, 2, {"R", "G", "B", "A"});
  leaf.at(0, 0, 1) = 0.8F;  // green, and three texels of nothing
  leaf.at(0, 0, 3) = 1.0F;
  const Vec4 seen = texel(pyramid_of(leaf, WrapMode::repeat)->levels().back(), 0, 0);
  EXPECT_NEAR(seen.y, 0.8F, 1e-3F);
  EXPECT_NEAR(seen.w, 0.25F, 1e-3F);
}

TEST(Pyramid, TakesAboutAsManyBytesAsItsFile) {
  Image image = make_image(256, 256, {"R", "G", "B"});
  const float* table = linear_of_8_bits(true);
  for (size_t i = 0; i < image.data.size(); ++i) image.data[i] = table[i % 256];
  TexelStore store;
  const auto pyramid = ImagePyramid::make(image, WrapMode::repeat, store);
  ASSERT_TRUE(pyramid);
  const uint64_t bytes = store.in_memory();
  EXPECT_GE(bytes, size_t{256} * 256 * 3);
  EXPECT_LE(bytes, size_t{256} * 256 * 3 * 17 / 10);
}

}  // namespace
}  // namespace hyades::core
