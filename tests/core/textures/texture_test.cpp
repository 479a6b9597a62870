#include "core/textures/texture.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <memory>

#include "core/textures/make_texture.h"
#include "core/textures/noise.h"
#include "tests/support/random.h"

namespace hyades::core {
namespace {

TexturePoint at_uv(float u, float v) { return {.uv = {u, v}}; }

/// 3 x 2 texels, grey: top row 1 2 3, bottom row 4 5 6.
std::shared_ptr<const Image> numbers() {
  auto image = std::make_shared<Image>(
      Image{.width = 3, .height = 2, .channels = {"Y"}, .data = {1, 2, 3, 4, 5, 6}});
  return image;
}

float lookup(WrapMode wrap, TextureFilter filter, float u, float v) {
  return make_image_texture(numbers(), wrap, filter)->scalar(at_uv(u, v));
}

/// Central differences of scalar() by every coordinate against scalar_gradient().
void expect_gradient(const Texture& texture, const TexturePoint& at, float tolerance) {
  const float h = 0x1p-10F;
  const ScalarGradient g = texture.scalar_gradient(at);
  EXPECT_FLOAT_EQ(g.value, texture.scalar(at));
  const auto slope = [&](auto member, int d) {
    TexturePoint high = at;
    TexturePoint low = at;
    (high.*member)[d] += h;
    (low.*member)[d] -= h;
    return (texture.scalar(high) - texture.scalar(low)) / (2.0F * h);
  };
  for (int d = 0; d < 2; ++d) EXPECT_NEAR(g.d_uv[d], slope(&TexturePoint::uv, d), tolerance);
  for (int d = 0; d < 3; ++d) {
    EXPECT_NEAR(g.d_object[d], slope(&TexturePoint::object, d), tolerance);
    EXPECT_NEAR(g.d_world[d], slope(&TexturePoint::world, d), tolerance);
  }
}

TEST(ConstantTexture, IsItsColour) {
  const auto texture = make_constant_texture({0.2F, 0.4F, 0.6F});
  EXPECT_EQ(texture->color(at_uv(3, 4)), Rgb(0.2F, 0.4F, 0.6F));
  EXPECT_EQ(texture->scalar({}), luminance({0.2F, 0.4F, 0.6F}));
  EXPECT_EQ(make_constant_texture(Rgb(0.3F))->scalar({}), 0.3F);
  expect_gradient(*texture, at_uv(0.3F, 0.2F), 0.0F);
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
      EXPECT_NEAR(lookup(WrapMode::repeat, bilinear, u, v), numbers()->at(x, 1 - y, 0), 1e-5F);
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
  const auto texture = make_image_texture(numbers(), WrapMode::repeat, TextureFilter::nearest,
                                          {2.0F, 2.0F}, {0.5F, 0.0F});
  EXPECT_EQ(texture->scalar(at_uv(0.0F, 0.0F)), 5.0F);
  EXPECT_EQ(texture->scalar(at_uv(0.0F, 0.3F)), 2.0F);
}

TEST(ImageTexture, GradientIsThatOfTheInterpolation) {
  test::Random random(1);
  for (const WrapMode wrap :
       {WrapMode::repeat, WrapMode::clamp, WrapMode::mirror, WrapMode::black}) {
    const auto texture =
        make_image_texture(numbers(), wrap, TextureFilter::bilinear, {1.5F, -0.75F}, {0.2F, 0.1F});
    for (int i = 0; i < 300; ++i) {
      const Vec2 uv = 3.0F * random.uniform2() - 1.0F;
      const Vec2 texels = (uv * Vec2(1.5F, -0.75F) + Vec2(0.2F, 0.1F)) * Vec2(3.0F, 2.0F) + 0.5F;
      const Vec2 place = texels - glm::floor(texels);
      if (glm::min(place.x, place.y) < 0.01F || glm::max(place.x, place.y) > 0.99F) continue;
      expect_gradient(*texture, {.uv = uv}, 5e-3F);
    }
  }
  const auto flat = make_image_texture(numbers(), WrapMode::repeat, TextureFilter::nearest);
  EXPECT_EQ(flat->scalar_gradient(at_uv(0.4F, 0.4F)).d_uv, Vec2(0.0F));
}

TEST(ImageTexture, ReadsColourByChannelName) {
  const auto image = std::make_shared<Image>(Image{
      .width = 1, .height = 1, .channels = {"A", "B", "G", "R"}, .data = {0.5F, 0.1F, 0.2F, 0.3F}});
  const auto texture = make_image_texture(image, WrapMode::repeat, TextureFilter::bilinear);
  EXPECT_EQ(texture->color(at_uv(0.7F, 0.1F)), Rgb(0.3F, 0.2F, 0.1F));
  EXPECT_FLOAT_EQ(texture->scalar({}), luminance({0.3F, 0.2F, 0.1F}));
  EXPECT_EQ(make_image_texture(std::make_shared<Image>(), WrapMode::repeat, TextureFilter::bilinear)
                ->color({}),
            Rgb(0.0F));
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

TEST(CheckerTexture, AlternatesInEveryDirection) {
  const auto a = make_constant_texture(Rgb(1.0F));
  const auto b = make_constant_texture(Rgb(2.0F));
  const auto texture = make_checker_texture(a, b, {.mapping = Mapping::world, .scale = Vec3(2.0F)});
  const auto value = [&](float x, float y, float z) {
    return texture->scalar({.world = {x, y, z}});
  };
  EXPECT_EQ(value(0.1F, 0.1F, 0.1F), 1.0F);
  EXPECT_EQ(value(0.6F, 0.1F, 0.1F), 2.0F);
  EXPECT_EQ(value(0.1F, 0.6F, 0.1F), 2.0F);
  EXPECT_EQ(value(0.1F, 0.1F, 0.6F), 2.0F);
  EXPECT_EQ(value(0.6F, 0.6F, 0.1F), 1.0F);
  EXPECT_EQ(value(-0.1F, 0.1F, 0.1F), 2.0F);
  EXPECT_EQ(value(1e6F, 0.1F, 0.1F), 1.0F);
  EXPECT_EQ(value(1e6F + 0.5F, 0.1F, 0.1F), 2.0F);
  const auto flat =
      make_checker_texture(a, b, {.mapping = Mapping::uv, .offset = Vec3(0.0F, 0.0F, 1.0F)});
  EXPECT_EQ(flat->scalar(at_uv(0.5F, 0.5F)), 1.0F);
  EXPECT_EQ(flat->scalar(at_uv(1.5F, 0.5F)), 2.0F);
}

TEST(ScaleTexture, MultipliesAndDifferentiatesProducts) {
  const auto image = make_image_texture(numbers(), WrapMode::repeat, TextureFilter::bilinear);
  const auto noise =
      make_noise_texture(make_constant_texture(Rgb(0.2F)), make_constant_texture(Rgb(1.0F)), {},
                         {.mapping = Mapping::uv, .scale = Vec3(3.0F)});
  const auto texture = make_scale_texture(image, noise);
  const TexturePoint at = at_uv(0.4F, 0.3F);
  EXPECT_FLOAT_EQ(texture->scalar(at), image->scalar(at) * noise->scalar(at));
  expect_gradient(*texture, at, 2e-2F);
  const auto tinted = make_scale_texture(make_constant_texture({1.0F, 2.0F, 3.0F}),
                                         make_constant_texture({0.5F, 0.1F, 2.0F}));
  EXPECT_EQ(tinted->color({}), Rgb(0.5F, 0.2F, 6.0F));
}

TEST(NoiseTexture, BlendsByTheNoise) {
  const Rgb a(0.1F, 0.2F, 0.3F);
  const Rgb b(0.9F, 0.8F, 0.4F);
  test::Random random(2);
  for (const Mapping mapping : {Mapping::uv, Mapping::object, Mapping::world}) {
    const MappingDesc map{.mapping = mapping, .scale = {2.0F, 3.0F, 4.0F}, .offset = Vec3(0.7F)};
    for (const int dimensions : {3, 4}) {
      const NoiseDesc desc{.dimensions = dimensions, .octaves = 3, .time = 0.37F};
      const auto texture =
          make_noise_texture(make_constant_texture(a), make_constant_texture(b), desc, map);
      for (int i = 0; i < 50; ++i) {
        const TexturePoint at{random.uniform2(), random.direction(), 2.0F * random.direction()};
        const Vec3 source = mapping == Mapping::uv       ? Vec3(at.uv, 0.0F)
                            : mapping == Mapping::object ? at.object
                                                         : at.world;
        const Vec3 p = source * map.scale + map.offset;
        const float n = dimensions == 4 ? fbm(Vec4(p, 0.37F), 3, 2.0F, 0.5F).value
                                        : fbm(p, 3, 2.0F, 0.5F).value;
        const float w = 0.5F + 0.5F * n;
        const Rgb expected = (1.0F - w) * a + w * b;
        EXPECT_NEAR(texture->color(at).x, expected.x, 1e-6F);
        EXPECT_NEAR(texture->color(at).z, expected.z, 1e-6F);
        EXPECT_NEAR(texture->scalar(at), luminance(expected), 1e-6F);
        expect_gradient(*texture, at, 3e-2F);
      }
    }
  }
}

// An animation's next frame is a small change, not another picture.
TEST(NoiseTexture, TimeMovesIt) {
  const auto at_time = [](float t) {
    return make_noise_texture(make_constant_texture(Rgb(0.0F)), make_constant_texture(Rgb(1.0F)),
                              {.dimensions = 4, .time = t}, {})
        ->scalar({.object = {0.3F, 0.4F, 0.6F}});
  };
  EXPECT_NE(at_time(0.0F), at_time(0.7F));
  EXPECT_NEAR(at_time(0.2F), at_time(0.21F), 0.02F);
}

}  // namespace
}  // namespace hyades::core
