#include "core/textures/texture.h"

#include <gtest/gtest.h>

#include <cmath>
#include <memory>

#include "core/textures/make_texture.h"
#include "core/textures/noise.h"
#include "tests/core/textures/gradients.h"
#include "tests/core/textures/pyramids.h"
#include "tests/support/random.h"

namespace hyades::core {
namespace {

TexturePoint point_at(float u, float v) { return {.uv = {u, v}}; }

TEST(ConstantTexture, IsItsColour) {
  const auto texture = make_constant_texture({0.2F, 0.4F, 0.6F});
  EXPECT_EQ(texture->color(point_at(3, 4)), Rgb(0.2F, 0.4F, 0.6F));
  EXPECT_EQ(texture->scalar({}), luminance({0.2F, 0.4F, 0.6F}));
  EXPECT_EQ(make_constant_texture(Rgb(0.3F))->scalar({}), 0.3F);
  expect_gradient(*texture, point_at(0.3F, 0.2F), 0.0F);
}

TEST(CheckerTexture, AlternatesInEveryDirection) {
  const auto a = make_constant_texture(Rgb(1.0F));
  const auto b = make_constant_texture(Rgb(2.0F));
  const auto texture =
      make_checker_texture(a, b, {.space = MappingSpace::world, .scale = Vec3(2.0F)});
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
      make_checker_texture(a, b, {.space = MappingSpace::uv, .offset = Vec3(0.0F, 0.0F, 1.0F)});
  EXPECT_EQ(flat->scalar(point_at(0.5F, 0.5F)), 1.0F);
  EXPECT_EQ(flat->scalar(point_at(1.5F, 0.5F)), 2.0F);
}

TEST(PatternTexture, BlendsByTheNoise) {
  const Rgb a(0.1F, 0.2F, 0.3F);
  const Rgb b(0.9F, 0.8F, 0.4F);
  test::Random random(2);
  for (const MappingSpace space : {MappingSpace::uv, MappingSpace::object, MappingSpace::world}) {
    const MappingDesc map{.space = space, .scale = {2.0F, 3.0F, 4.0F}, .offset = Vec3(0.7F)};
    for (const int dimensions : {3, 4}) {
      FractalDesc desc{.octaves = 3, .time = std::nullopt};
      if (dimensions == 4) desc.time = 0.37F;
      const auto texture = make_pattern_texture(make_constant_texture(a), make_constant_texture(b),
                                                make_fractal_pattern(FractalKind::fbm, desc), map);
      for (int i = 0; i < 50; ++i) {
        const TexturePoint at{random.uniform2(), random.direction(), 2.0F * random.direction()};
        const Vec3 source = space == MappingSpace::uv       ? Vec3(at.uv, 0.0F)
                            : space == MappingSpace::object ? at.object
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
TEST(PatternTexture, TimeMovesIt) {
  const auto at_time = [](float t) {
    return make_pattern_texture(make_constant_texture(Rgb(0.0F)), make_constant_texture(Rgb(1.0F)),
                                make_fractal_pattern(FractalKind::fbm, {.time = t}), {})
        ->scalar({.object = {0.3F, 0.4F, 0.6F}});
  };
  EXPECT_NE(at_time(0.0F), at_time(0.7F));
  EXPECT_NEAR(at_time(0.2F), at_time(0.21F), 0.02F);
}

}  // namespace
}  // namespace hyades::core
