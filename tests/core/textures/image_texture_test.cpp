#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <memory>

#include "core/textures/make_texture.h"
#include "tests/core/textures/gradients.h"
#include "tests/core/textures/pyramids.h"
#include "tests/support/random.h"

namespace hyades::core {
namespace {

TexturePoint at_uv(float u, float v) { return {.uv = {u, v}}; }

/// 3 x 2 texels, grey: top row 1 2 3, bottom row 4 5 6.
Image numbers() { return {.width = 3, .height = 2, .channels = {"Y"}, .data = {1, 2, 3, 4, 5, 6}}; }

TexturePtr texture_of(const Image& image, WrapModes wrap, TextureFilter filter,
                      const Vec3& scale = Vec3(1.0F), const Vec3& offset = Vec3(0.0F)) {
  ImageTextureDesc desc;
  desc.filter = filter;
  desc.mapping.scale = scale;
  desc.mapping.offset = offset;
  return make_image_texture(pyramid_of(image, wrap), desc);
}

float lookup(WrapModes wrap, TextureFilter filter, float u, float v) {
  return texture_of(numbers(), wrap, filter)->scalar(at_uv(u, v));
}

TEST(ImageTexture, OriginIsTheLowerLeftCorner) {
  for (const WrapMode wrap : {WrapMode::repeat, WrapMode::clamp, WrapMode::mirror}) {
    EXPECT_EQ(lookup(wrap, TextureFilter::nearest, 0.0F, 0.0F), 4.0F);
    EXPECT_EQ(lookup(wrap, TextureFilter::nearest, 0.99F, 0.01F), 6.0F);
    EXPECT_EQ(lookup(wrap, TextureFilter::nearest, 0.01F, 0.99F), 1.0F);
    EXPECT_EQ(lookup(wrap, TextureFilter::nearest, 0.99F, 0.99F), 3.0F);
    EXPECT_EQ(lookup(wrap, TextureFilter::nearest, 0.5F, 0.49F), 5.0F);
  }
}

TEST(ImageTexture, BilinearMeetsTexelsAtTheirCentresAndBlendsBetween) {
  const auto bilinear = TextureFilter::bilinear;
  for (int x = 0; x < 3; ++x) {
    for (int y = 0; y < 2; ++y) {
      const float u = (static_cast<float>(x) + 0.5F) / 3.0F;
      const float v = (static_cast<float>(y) + 0.5F) / 2.0F;
      EXPECT_NEAR(lookup(WrapMode::repeat, bilinear, u, v), numbers().at(x, 1 - y, 0), 1e-5F);
    }
  }
  EXPECT_NEAR(lookup(WrapMode::clamp, bilinear, 1.0F / 3.0F, 0.25F), 4.5F, 1e-5F);
  EXPECT_NEAR(lookup(WrapMode::clamp, bilinear, 0.5F, 0.5F), 3.5F, 1e-5F);
  EXPECT_NEAR(lookup(WrapMode::clamp, bilinear, 1.0F / 3.0F, 0.375F), 0.75F * 4.5F + 0.25F * 1.5F,
              1e-5F);
}

TEST(ImageTexture, EdgesWrapAsTheModeSays) {
  const auto bilinear = TextureFilter::bilinear;
  const auto nearest = TextureFilter::nearest;
  // On the left edge, in the middle of the bottom row's height.
  EXPECT_NEAR(lookup(WrapMode::repeat, bilinear, 0.0F, 0.25F), 5.0F, 1e-5F);  // 4 and 6
  EXPECT_NEAR(lookup(WrapMode::clamp, bilinear, 0.0F, 0.25F), 4.0F, 1e-5F);
  EXPECT_NEAR(lookup(WrapMode::mirror, bilinear, 0.0F, 0.25F), 4.0F, 1e-5F);
  EXPECT_NEAR(lookup(WrapMode::black, bilinear, 0.0F, 0.25F), 2.0F, 1e-5F);  // 4 and nothing
  EXPECT_NEAR(lookup(WrapMode::repeat, bilinear, 0.5F, 0.0F), 3.5F, 1e-5F);  // 5 and 2
  EXPECT_NEAR(lookup(WrapMode::black, bilinear, 0.5F, 0.0F), 2.5F, 1e-5F);
  // Outside.
  EXPECT_EQ(lookup(WrapMode::repeat, nearest, 1.1F, 0.1F), 4.0F);
  EXPECT_EQ(lookup(WrapMode::repeat, nearest, -0.1F, -0.9F), 6.0F);
  EXPECT_EQ(lookup(WrapMode::clamp, nearest, 7.0F, -3.0F), 6.0F);
  EXPECT_EQ(lookup(WrapMode::mirror, nearest, 1.1F, 0.1F), 6.0F);
  EXPECT_EQ(lookup(WrapMode::mirror, nearest, -0.4F, 0.1F), 5.0F);
  EXPECT_EQ(lookup(WrapMode::mirror, nearest, 2.1F, 1.1F), 1.0F);
  EXPECT_EQ(lookup(WrapMode::black, nearest, 1.1F, 0.5F), 0.0F);
  EXPECT_EQ(lookup(WrapMode::black, nearest, 0.5F, -0.1F), 0.0F);
}

TEST(ImageTexture, ScaleAndOffsetApplyToUv) {
  const auto texture = texture_of(numbers(), WrapMode::repeat, TextureFilter::nearest,
                                  {2.0F, 2.0F, 1.0F}, {0.5F, 0.0F, 0.0F});
  EXPECT_EQ(texture->scalar(at_uv(0.0F, 0.0F)), 5.0F);
  EXPECT_EQ(texture->scalar(at_uv(0.0F, 0.3F)), 2.0F);
}

TEST(ImageTexture, WrapsAlongUAndVMayDiffer) {
  const WrapModes across(WrapMode::repeat, WrapMode::clamp);
  EXPECT_EQ(lookup(across, TextureFilter::nearest, 1.01F, 0.01F), 4.0F);
  EXPECT_EQ(lookup(across, TextureFilter::nearest, 0.01F, 1.25F), 1.0F);
  const WrapModes up(WrapMode::clamp, WrapMode::repeat);
  EXPECT_EQ(lookup(up, TextureFilter::nearest, 1.01F, 0.01F), 6.0F);
  EXPECT_EQ(lookup(up, TextureFilter::nearest, 0.01F, 1.25F), 4.0F);
}

TEST(ImageTexture, GradientIsThatOfTheInterpolation) {
  test::Random random(1);
  for (const WrapMode wrap :
       {WrapMode::repeat, WrapMode::clamp, WrapMode::mirror, WrapMode::black}) {
    const auto texture = texture_of(numbers(), wrap, TextureFilter::bilinear, {1.5F, -0.75F, 1.0F},
                                    {0.2F, 0.1F, 0.0F});
    for (int i = 0; i < 300; ++i) {
      const Vec2 uv = 3.0F * random.uniform2() - 1.0F;
      const Vec2 texels = (uv * Vec2(1.5F, -0.75F) + Vec2(0.2F, 0.1F)) * Vec2(3.0F, 2.0F) + 0.5F;
      const Vec2 place = texels - glm::floor(texels);
      if (glm::min(place.x, place.y) < 0.01F || glm::max(place.x, place.y) > 0.99F) continue;
      expect_gradient(*texture, {.uv = uv}, 5e-3F);
    }
  }
  const auto flat = texture_of(numbers(), WrapMode::repeat, TextureFilter::nearest);
  EXPECT_EQ(flat->scalar_gradient(at_uv(0.4F, 0.4F)).d_uv, Vec2(0.0F));
}

TEST(ImageTexture, ReadsColourByChannelName) {
  const Image image{
      .width = 1, .height = 1, .channels = {"A", "B", "G", "R"}, .data = {0.5F, 0.1F, 0.2F, 0.3F}};
  const auto texture = texture_of(image, WrapMode::repeat, TextureFilter::bilinear);
  EXPECT_EQ(texture->color(at_uv(0.7F, 0.1F)), Rgb(0.3F, 0.2F, 0.1F));
  EXPECT_FLOAT_EQ(texture->scalar({}), luminance({0.3F, 0.2F, 0.1F}));
  EXPECT_EQ(texture_of(Image(), WrapMode::repeat, TextureFilter::bilinear)->color({}), Rgb(0.0F));
}

TEST(ImageTexture, HugeCoordinatesAreHarmless) {
  for (const WrapMode wrap :
       {WrapMode::repeat, WrapMode::clamp, WrapMode::mirror, WrapMode::black}) {
    for (const float x : {1e6F, -1e6F, 1e18F, -3e38F, std::numeric_limits<float>::infinity(),
                          std::numeric_limits<float>::quiet_NaN()}) {
      for (const TextureFilter filter : {TextureFilter::bilinear, TextureFilter::nearest}) {
        const float value = lookup(wrap, filter, x, x);
        EXPECT_TRUE(value >= 0.0F && value <= 6.0F) << x;
      }
    }
  }
}

/// Pixels of one width wherever one looks, straight down on surfaces or from the side.
class Wide final : public PixelView {
 public:
  Wide(const Vec3& direction, float width) : cone_{direction, width} {}
  PixelCone pixel_at(const Vec3& /*point*/, float /*time*/) const override { return cone_; }

 private:
  PixelCone cone_;
};

/// A board of black and white texels, 64 x 64, on a surface with one repeat per metre.
Image board() {
  Image image = make_image(64, 64, {"Y"});
  for (int y = 0; y < 64; ++y) {
    for (int x = 0; x < 64; ++x) image.at(x, y, 0) = static_cast<float>((x + y) % 2);
  }
  return image;
}

/// The variance of what is read of `image` where pixels are `texels` wide, seen along `direction`.
double spread(const Image& image, TextureFilter filter, const Vec3& direction, float texels) {
  ImageTextureDesc desc;
  desc.filter = filter;
  desc.view = std::make_shared<Wide>(direction, texels / 64.0F / kSpanPerPixel);
  const auto texture = make_image_texture(pyramid_of(image, WrapMode::repeat), desc);
  SurfacePoint surface;
  test::Random random(4);
  double sum = 0.0;
  double squares = 0.0;
  constexpr int kCount = 4000;
  for (int i = 0; i < kCount; ++i) {
    const double value = texture->scalar({.uv = random.uniform2(), .surface = &surface});
    sum += value / kCount;
    squares += value * value / kCount;
  }
  EXPECT_NEAR(sum, 0.5, 0.03);
  return squares - sum * sum;
}

TEST(ImageTexture, IsReadNoFinerThanAPixelCovers) {
  const Vec3 down(0.0F, 0.0F, -1.0F);
  const auto trilinear = TextureFilter::trilinear;
  const auto anisotropic = TextureFilter::anisotropic;
  const double whole = spread(board(), TextureFilter::bilinear, down, 8.0F);
  EXPECT_GT(whole, 0.02);
  EXPECT_NEAR(spread(board(), trilinear, down, 0.9F), whole, 1e-6);
  EXPECT_NEAR(spread(board(), anisotropic, down, 0.9F), whole, 1e-6);
  EXPECT_LT(spread(board(), trilinear, down, 2.0F), 0.01 * whole);
  EXPECT_LT(spread(board(), anisotropic, down, 2.0F), 0.01 * whole);
  EXPECT_LT(spread(board(), trilinear, down, 1e9F), 1e-9);
}

// Stripes that run along the line of sight: what is covered is long, but not wide.
TEST(ImageTexture, AnisotropicStaysSharpAcrossTheLineOfSight) {
  Image stripes = make_image(64, 64, {"Y"});
  for (int y = 0; y < 64; ++y) {
    for (int x = 0; x < 64; ++x) stripes.at(x, y, 0) = static_cast<float>(y / 4 % 2);
  }
  const Vec3 grazing = glm::normalize(Vec3(1.0F, 0.0F, -0.1F));
  const double sharp = spread(stripes, TextureFilter::bilinear, grazing, 1.0F);
  EXPECT_LT(spread(stripes, TextureFilter::trilinear, grazing, 1.0F), 0.3 * sharp);
  EXPECT_GT(spread(stripes, TextureFilter::anisotropic, grazing, 1.0F), 0.9 * sharp);
  // Along them the long side counts.
  const Vec3 across = glm::normalize(Vec3(0.0F, 1.0F, -0.1F));
  EXPECT_LT(spread(stripes, TextureFilter::anisotropic, across, 1.0F), 0.1 * sharp);
}

TEST(ImageTexture, GradientIsThatOfWhatIsReadOfSmallerSizes) {
  test::Random random(5);
  Image image = make_image(32, 32, {"R", "G", "B"});
  for (float& x : image.data) x = random.uniform();
  const auto pyramid = pyramid_of(image, WrapMode::repeat);
  SurfacePoint surface;
  for (const TextureFilter filter : {TextureFilter::trilinear, TextureFilter::anisotropic}) {
    ImageTextureDesc desc;
    desc.filter = filter;
    desc.mapping.scale = {1.5F, -0.75F, 1.0F};
    desc.view = std::make_shared<Wide>(glm::normalize(Vec3(0.5F, 0.3F, -0.4F)), 0.3F);
    const auto texture = make_image_texture(pyramid, desc);
    int near = 0;
    for (int i = 0; i < 100; ++i) {
      const TexturePoint at{.uv = random.uniform2(), .surface = &surface};
      const ScalarGradient g = texture->scalar_gradient(at);
      EXPECT_FLOAT_EQ(g.value, texture->scalar(at));
      const float h = 0x1p-13F;
      const auto value = [&](float u, float v) {
        return texture->scalar({.uv = at.uv + Vec2(u, v), .surface = &surface});
      };
      const Vec2 slope((value(h, 0) - value(-h, 0)) / (2 * h),
                       (value(0, h) - value(0, -h)) / (2 * h));
      near += glm::length(slope - g.d_uv) < 5e-3F ? 1 : 0;  // but where a texel's edge lies between
    }
    EXPECT_GE(near, 95);
  }
}

TEST(ImageTexture, AlphaIsThatOfTheFileAndOneWithoutIt) {
  const Image image{.width = 2, .height = 1, .channels = {"Y", "A"}, .data = {0.5F, 0, 0.25F, 1}};
  const auto texture = texture_of(image, WrapMode::clamp, TextureFilter::bilinear);
  EXPECT_EQ(texture->alpha(at_uv(0.1F, 0.5F)), 0.0F);
  EXPECT_FLOAT_EQ(texture->alpha(at_uv(0.5F, 0.5F)), 0.5F);
  EXPECT_EQ(texture->alpha(at_uv(0.9F, 0.5F)), 1.0F);
  const auto leaf = make_channel_texture(texture, Channel::alpha);
  EXPECT_FLOAT_EQ(leaf->scalar(at_uv(0.6F, 0.5F)), 0.7F);
  EXPECT_NEAR(leaf->scalar_gradient(at_uv(0.6F, 0.5F)).d_uv.x, 2.0F, 1e-4F);
  EXPECT_EQ(texture_of(numbers(), WrapMode::clamp, TextureFilter::bilinear)->alpha({}), 1.0F);
}

// Tiles in their places, each with its own picture; nothing where there is none.
TEST(UdimTexture, ReadsTheTileOfItsSquare) {
  std::vector<UdimTile> tiles;
  for (const int number : {1001, 1012, 1100}) {
    Image image = make_image(4, 4, {"Y"});
    for (float& value : image.data) value = static_cast<float>(number);
    ImageTextureDesc desc;
    desc.mapping.offset = -Vec3((number - 1001) % 10, (number - 1001) / 10, 0.0F);
    tiles.push_back({number, make_image_texture(pyramid_of(image, WrapMode::clamp), desc)});
  }
  const auto texture = make_udim_texture(std::move(tiles), {.space = MappingSpace::uv});
  EXPECT_EQ(texture->scalar(at_uv(0.5F, 0.99F)), 1001.0F);
  EXPECT_EQ(texture->scalar(at_uv(1.01F, 1.01F)), 1012.0F);
  EXPECT_EQ(texture->scalar(at_uv(10.0F, 10.0F)), 1100.0F);
  EXPECT_EQ(texture->alpha(at_uv(1.5F, 1.5F)), 1.0F);
  for (const Vec2 outside : {Vec2(1.5F, 0.5F), Vec2(-0.1F, 0.5F), Vec2(10.1F, 9.5F), Vec2(NAN)}) {
    EXPECT_EQ(texture->scalar({.uv = outside}), 0.0F);
    EXPECT_EQ(texture->alpha({.uv = outside}), 0.0F);
  }
}

}  // namespace
}  // namespace hyades::core
