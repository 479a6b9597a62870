// Textures made of textures: their values, and their gradients against differences.

#include <gtest/gtest.h>

#include <memory>

#include "core/textures/make_texture.h"
#include "tests/core/textures/gradients.h"
#include "tests/support/random.h"

namespace hyades::core {
namespace {

/// A smooth colour that varies in space, all its channels differently.
TexturePtr clouds(float time, const Rgb& a = Rgb(0.1F, 0.7F, 0.3F),
                  const Rgb& b = Rgb(0.9F, 0.2F, 0.6F)) {
  const auto plain = make_pattern_texture(
      make_constant_texture(a), make_constant_texture(b),
      make_fractal_pattern(FractalKind::fbm, {.octaves = 1, .time = time}), {});
  const auto tint = make_pattern_texture(
      make_constant_texture({1.0F, 0.4F, 0.7F}), make_constant_texture({0.5F, 1.0F, 0.6F}),
      make_fractal_pattern(FractalKind::fbm, {.octaves = 1, .time = time + 7.0F}),
      {.space = MappingSpace::world});
  return make_scale_texture(plain, tint);
}

Rgb at(const TexturePtr& texture) { return texture->color({}); }
TexturePtr of(const Rgb& color) { return make_constant_texture(color); }

void expect_color(const Rgb& found, const Rgb& expected) {
  for (int c = 0; c < 3; ++c) EXPECT_NEAR(found[c], expected[c], 1e-5F) << c;
}

TEST(Nodes, GradientsAreThoseOfDifferences) {
  const TexturePtr a = clouds(0.1F);
  const TexturePtr b = clouds(3.3F);
  const std::vector<RampStop> stops = {
      {0.1F, of({0.1F, 0.2F, 0.9F})}, {0.35F, b}, {0.8F, of({0.9F, 0.5F, 0.1F})}};
  const struct {
    const char* name;
    TexturePtr texture;
  } nodes[] = {
      {"scale", make_scale_texture(a, b)},
      {"add", make_sum_texture(a, b)},
      {"divide", make_quotient_texture(a, make_sum_texture(b, of({0.5F, 0.7F, 0.9F})))},
      {"min", make_extreme_texture(a, b, false)},
      {"max", make_extreme_texture(a, b, true)},
      {"mix", make_mix_texture(a, b, clouds(5.0F))},
      {"invert", make_invert_texture(a)},
      {"remap", make_remap_texture(a, {0.2F, 0.6F, 0.1F, 0.9F, RemapEnds::clamp})},
      {"smooth", make_remap_texture(a, {0.2F, 0.6F, 0.9F, 0.1F, RemapEnds::smooth})},
      {"open", make_remap_texture(a, {0.2F, 0.6F, -1.0F, 2.0F, RemapEnds::open})},
      {"power", make_power_texture(a, 2.2F)},
      {"threshold", make_threshold_texture(a, 0.4F, 0.3F)},
      {"ramp", make_ramp_texture(a, stops, RampShape::linear)},
      {"smooth ramp", make_ramp_texture(a, stops, RampShape::smooth)},
      {"steps", make_ramp_texture(a, stops, RampShape::steps)},
      {"hue", make_hue_texture(a, {70.0F, 0.6F, 1.3F})},
      {"saturated", make_hue_texture(a, {-200.0F, 3.0F, 0.7F})},
      {"red", make_channel_texture(a, Channel::red)},
      {"luminance", make_channel_texture(a, Channel::luminance)},
      {"twice", make_power_texture(make_hue_texture(make_mix_texture(a, b, b), {40, 1, 1}), 0.7F)},
  };
  for (const auto& node : nodes) {
    SCOPED_TRACE(node.name);
    test::Random random(21);
    int near = 0;
    constexpr int kCount = 200;
    for (int i = 0; i < kCount; ++i) {
      const TexturePoint p{{}, 3.0F * random.direction(), 2.0F * random.direction(), nullptr};
      const Vec4 weights(random.uniform(), random.uniform(), random.uniform(), 0.3F);
      const ScalarGradient g = node.texture->gradient(p, weights);
      const auto value = [&](const TexturePoint& q) {
        return glm::dot(weights, Vec4(node.texture->color(q), node.texture->alpha(q)));
      };
      EXPECT_NEAR(g.value, value(p), 1e-5F);
      float error = 0.0F;
      for (int d = 0; d < 6; ++d) {
        constexpr float kStep = 0x1p-9F;
        TexturePoint high = p;
        TexturePoint low = p;
        (d < 3 ? high.object : high.world)[d % 3] += kStep;
        (d < 3 ? low.object : low.world)[d % 3] -= kStep;
        const float slope = (value(high) - value(low)) / (2.0F * kStep);
        error = std::max(error, std::abs(slope - (d < 3 ? g.d_object : g.d_world)[d % 3]));
      }
      near += error < 0.02F ? 1 : 0;  // but across kinks
    }
    EXPECT_GE(near, kCount * 94 / 100);
  }
}

TEST(Nodes, ArithmeticIsByChannel) {
  const TexturePtr a = of({0.2F, 0.5F, 0.9F});
  const TexturePtr b = of({0.4F, 0.25F, 0.5F});
  expect_color(at(make_scale_texture(a, b)), {0.08F, 0.125F, 0.45F});
  expect_color(at(make_sum_texture(a, b)), {0.6F, 0.75F, 1.4F});
  expect_color(at(make_quotient_texture(a, b)), {0.5F, 2.0F, 1.8F});
  expect_color(at(make_quotient_texture(a, of({0.5F, 0.0F, 1.0F}))), {0.4F, 0.0F, 0.9F});
  expect_color(at(make_extreme_texture(a, b, false)), {0.2F, 0.25F, 0.5F});
  expect_color(at(make_extreme_texture(a, b, true)), {0.4F, 0.5F, 0.9F});
  expect_color(at(make_mix_texture(a, b, of(Rgb(0.25F)))), {0.25F, 0.4375F, 0.8F});
  EXPECT_EQ(at(make_mix_texture(a, b, of(Rgb(3.0F)))), at(b)) << "shares are held within 0..1";
  expect_color(at(make_invert_texture(a)), {0.8F, 0.5F, 0.1F});
  expect_color(at(make_power_texture(a, 2.0F)), {0.04F, 0.25F, 0.81F});
  expect_color(at(make_threshold_texture(a, 0.5F, 0.0F)), {0.0F, 1.0F, 1.0F});
}

TEST(Nodes, RemapHoldsOrGoesOn) {
  const TexturePtr a = of({0.1F, 0.5F, 0.9F});
  expect_color(at(make_remap_texture(a, {0.4F, 0.6F, 2.0F, 4.0F, RemapEnds::clamp})), {2, 3, 4});
  expect_color(at(make_remap_texture(a, {0.4F, 0.6F, 2.0F, 4.0F, RemapEnds::open})), {-1, 3, 7});
  expect_color(at(make_remap_texture(a, {0.3F, 0.7F, 1.0F, 0.0F, RemapEnds::smooth})),
               {1, 0.5F, 0});
  expect_color(at(make_remap_texture(a, {0.5F, 0.5F, 0.0F, 1.0F, RemapEnds::clamp})), {0, 1, 1});
}

TEST(Nodes, RampsGiveTheColoursOfTheirStops) {
  std::vector<RampStop> stops = {
      {1.0F, of({0, 0, 1})}, {0.0F, of({1, 0, 0})}, {0.5F, of({0, 1, 0})}};
  const auto ramp = [&](float x, RampShape shape) {
    return at(make_ramp_texture(of(Rgb(x)), stops, shape));
  };
  expect_color(ramp(-1.0F, RampShape::linear), {1, 0, 0});
  expect_color(ramp(0.25F, RampShape::linear), {0.5F, 0.5F, 0});
  expect_color(ramp(0.5F, RampShape::linear), {0, 1, 0});
  expect_color(ramp(2.0F, RampShape::linear), {0, 0, 1});
  expect_color(ramp(0.625F, RampShape::smooth), {0, 1.0F - 0.15625F, 0.15625F});
  expect_color(ramp(0.99F, RampShape::steps), {0, 1, 0});
}

TEST(Nodes, HueTurnsFromRedToGreenToBlue) {
  const auto turned = [](const Rgb& c, float hue, float saturation, float value) {
    return at(make_hue_texture(of(c), {hue, saturation, value}));
  };
  expect_color(turned({0.8F, 0.2F, 0.2F}, 120, 1, 1), {0.2F, 0.8F, 0.2F});
  expect_color(turned({0.8F, 0.2F, 0.2F}, 240, 1, 1), {0.2F, 0.2F, 0.8F});
  expect_color(turned({0.8F, 0.2F, 0.2F}, 60, 1, 1), {0.8F, 0.8F, 0.2F});
  expect_color(turned({0.8F, 0.2F, 0.4F}, 360, 1, 1), {0.8F, 0.2F, 0.4F});
  expect_color(turned({0.3F, 0.7F, 0.1F}, -35, 0, 2), {1.4F, 1.4F, 1.4F});
  expect_color(turned({0.8F, 0.2F, 0.4F}, 0, 9, 1), {0.8F, 0.0F, 0.8F / 3.0F});
  expect_color(turned(Rgb(0.4F), 77, 2, 1), Rgb(0.4F));
}

}  // namespace
}  // namespace hyades::core
