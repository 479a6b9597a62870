#include <gtest/gtest.h>

#include <cmath>

#include "core/lights/make_light.h"
#include "tests/core/lights/light_checks.h"
#include "tests/support/means.h"

namespace hyades::core {
namespace {

constexpr double kPiD = 3.141592653589793;

std::optional<LightSample> first_sample(const Light& light, const Vec3& from) {
  return light.sample_direct(from, 0.0F, 0.5F, {0.5F, 0.5F});
}

TEST(PointLight, ShinesWithItsPowerOverTheSphere) {
  const auto light = make_point_light({1, 2, 3}, Rgb(4, 8, 12) * kPi);
  const auto s = first_sample(*light, {1, 2, 1});
  ASSERT_TRUE(s);
  test::expect_sound(*s);
  EXPECT_TRUE(s->delta);
  EXPECT_EQ(s->pdf, 1.0F);
  EXPECT_FLOAT_EQ(s->distance, 2.0F);
  EXPECT_EQ(s->direction, Vec3(0, 0, 1));
  EXPECT_EQ(s->position, Vec3(1, 2, 3));
  EXPECT_NEAR(s->radiance.x, 0.25F, 1e-6F);  // P / (4 pi d^2)
  EXPECT_NEAR(s->radiance.y, 0.5F, 1e-6F);
  EXPECT_NEAR(s->radiance.z, 0.75F, 1e-6F);
  EXPECT_NEAR(light->power(), luminance(Rgb(4, 8, 12) * kPi), 1e-3F);
  EXPECT_EQ(light->pdf_direct({0, 0, 0}, {0, 0, 1}, {}), 0.0F);
  EXPECT_TRUE(is_black(light->radiance({}, {0, 0, 1})));
  EXPECT_FALSE(light->is_infinite());
}

TEST(PointLight, IsTheSameInAllDirections) {
  const auto light = make_point_light({0, 0, 0}, Rgb(1.0F));
  test::Random random(3);
  for (int i = 0; i < 100000; ++i) {
    const auto s = first_sample(*light, 3.0F * random.direction());
    ASSERT_TRUE(s);  // rounding of the cosine must not make the last direction dark
    ASSERT_NEAR(s->radiance.y, 1.0 / (4.0 * kPiD * 9.0), 1e-8);
  }
}

TEST(PointLight, GivesNothingAtItsOwnPlaceOrWithoutPower) {
  EXPECT_FALSE(first_sample(*make_point_light({1, 1, 1}, Rgb(1.0F)), {1, 1, 1}));
  EXPECT_FALSE(first_sample(*make_point_light({1, 1, 1}, Rgb(0.0F)), {0, 0, 0}));
}

TEST(SpotLight, FadesSmoothlyBetweenItsCones) {
  const float inner = std::cos(0.3F);
  const float outer = std::cos(0.5F);
  const auto light = make_spot_light({0, 5, 0}, {0, -1, 0}, Rgb(4.0F * kPi), inner, outer);
  const auto intensity = [&](float cosine) {
    const float sine = std::sqrt(1.0F - cosine * cosine);
    const auto s = first_sample(*light, Vec3(0, 5, 0) + 2.0F * Vec3(sine, -cosine, 0));
    return s ? s->radiance.x * 4.0F : 0.0F;
  };
  EXPECT_NEAR(intensity(1.0F), 1.0F, 1e-5F);
  EXPECT_NEAR(intensity(inner + 1e-3F), 1.0F, 1e-5F);
  EXPECT_EQ(intensity(outer - 1e-3F), 0.0F);
  EXPECT_EQ(intensity(-1.0F), 0.0F);
  EXPECT_NEAR(intensity(0.5F * (inner + outer)), 0.5F, 1e-3F);
  EXPECT_NEAR(intensity(0.75F * inner + 0.25F * outer), 0.84375F, 1e-3F);  // 3 t^2 - 2 t^3
  float last = 1.1F;
  for (int i = 0; i <= 20; ++i) {
    const float here = intensity(inner + (outer - inner) * static_cast<float>(i) / 20.0F);
    EXPECT_LE(here, last + 1e-6F);
    last = here;
  }
}

TEST(SpotLight, PowerIsTheFluxItSends) {
  const auto light = make_spot_light({0, 0, 0}, {0, 0, 1}, Rgb(100.0F), 0.9F, 0.4F);
  test::Moments flux;  // over directions: 4 pi times the mean intensity, at distance 1
  test::Random random(11);
  for (int i = 0; i < 1'000'000; ++i) {
    const auto s = first_sample(*light, random.direction());
    flux.add(s ? 4.0 * kPiD * static_cast<double>(luminance(s->radiance)) : 0.0);
  }
  EXPECT_TRUE(test::mean_is(flux, static_cast<double>(light->power())));
}

TEST(SpotLight, HasAHardEdgeWhereTheConesAreOne) {
  const auto light = make_spot_light({0, 0, 0}, {0, 0, 1}, Rgb(1.0F), 0.8F, 0.8F);
  EXPECT_TRUE(first_sample(*light, {0, 0.55F, 0.83F}));
  EXPECT_FALSE(first_sample(*light, {0, 0.65F, 0.75F}));
  // An inner cone wider than the outer one counts as equal to it.
  const auto crossed = make_spot_light({0, 0, 0}, {0, 0, 1}, Rgb(1.0F), 0.8F, 0.9F);
  EXPECT_TRUE(first_sample(*crossed, {0, 0.55F, 0.83F}));
}

TEST(SunLight, WithoutSizeIsADirection) {
  const Vec3 travels = glm::normalize(Vec3(1, -2, 0.5F));
  const auto light = make_sun_light(travels, Rgb(3, 2, 1), 0.0F, 10.0F);
  const auto s = first_sample(*light, {5, 6, 7});
  ASSERT_TRUE(s);
  test::expect_sound(*s);
  EXPECT_TRUE(s->delta);
  EXPECT_EQ(s->pdf, 1.0F);
  EXPECT_EQ(s->direction, -travels);
  EXPECT_EQ(s->radiance, Rgb(3, 2, 1));
  EXPECT_EQ(s->distance, kInfinity);
  EXPECT_TRUE(light->is_infinite());
  EXPECT_TRUE(is_black(light->radiance({}, travels)));
  EXPECT_EQ(light->pdf_direct({}, -travels, {}), 0.0F);
  EXPECT_NEAR(light->power(), luminance(Rgb(3, 2, 1)) * kPiD * 100.0, 0.1);
}

TEST(SunLight, GivesAFacingSurfaceItsIrradiance) {
  for (const float degrees : {0.53F, 5.0F, 60.0F, 180.0F}) {
    const Vec3 travels = glm::normalize(Vec3(0.2F, -1, 0.4F));
    const auto light = make_sun_light(travels, Rgb(2.0F), degrees * kPi / 180.0F, 1.0F);
    const auto facing = test::irradiance(*light, {0, 0, 0}, -travels, 100000);
    // Of a small disc the cosine varies less than float can tell: no statistics there.
    if (degrees < 10.0F) {
      EXPECT_NEAR(facing.mean(), 2.0, 1e-5) << degrees;
    } else {
      EXPECT_TRUE(test::mean_is(facing, 2.0)) << degrees;
    }
  }
}

TEST(SunLight, IsDarkerAtItsRimAndGivesItsIrradianceAllTheSame) {
  const float radius = 0.3F;
  const auto light = make_sun_light({0, -1, 0}, Rgb(2.0F), 2.0F * radius, {0.5F, 1.0F, 2.0F}, 1.0F);
  test::Moments channels[3];
  test::Random random(3);
  for (int i = 0; i < 100'000; ++i) {
    const auto s = light->sample_direct({}, 0.0F, 0.0F, random.uniform2());
    ASSERT_TRUE(s);
    EXPECT_EQ(s->radiance, light->radiance({}, -s->direction));
    for (int c = 0; c < 3; ++c)
      channels[c].add(static_cast<double>(s->radiance[c] * s->direction.y / s->pdf));
  }
  for (const test::Moments& channel : channels) EXPECT_TRUE(test::mean_is(channel, 2.0));
  const auto seen = [&](float share) {  // at this share of the radius
    const float sine = share * std::sin(radius);
    return light->radiance({}, {sine, -std::sqrt(1.0F - sine * sine), 0.0F});
  };
  EXPECT_NEAR(seen(0.8F).z / seen(0.0F).z, 0.36F, 1e-3F);  // cosine 0.6, squared
  EXPECT_NEAR(seen(0.8F).y / seen(0.0F).y, 0.6F, 1e-3F);
  EXPECT_EQ(seen(1.01F), Rgb(0.0F));
}

TEST(SunLight, DiscIsSeenAndSampledAlike) {
  for (const float degrees : {0.1F, 0.53F, 20.0F, 180.0F}) {
    const float radius = 0.5F * degrees * kPi / 180.0F;
    const Vec3 to_sun = glm::normalize(Vec3(-0.3F, 0.8F, -0.1F));
    const auto light = make_sun_light(-to_sun, Rgb(1, 2, 3), 2.0F * radius, 1.0F);
    const double half_sine = std::sin(0.5 * static_cast<double>(radius));
    // A cone with 1.3 times the disc's solid angle, so that its edge is in the picture.
    const double one_minus_cos = 2.0 * half_sine * half_sine;
    const test::ConeView view{Frame::around(to_sun), 1.3 * one_minus_cos};
    EXPECT_TRUE(test::directions_follow(
        [&](test::Random& random) -> std::optional<Vec3> {
          const auto s = light->sample_direct({1, 2, 3}, 0.0F, random.uniform(), random.uniform2());
          if (!s) return std::nullopt;
          return view.spread(s->direction);
        },
        [&](const Vec3& e) {
          return view.density(
              static_cast<double>(light->pdf_direct({1, 2, 3}, view.gather(e), {})));
        },
        test::sphere_test(1e-4, 1, 4)))
        << degrees;
    test::Random random(5);
    for (int i = 0; i < 1000; ++i) {
      const auto s = light->sample_direct({1, 2, 3}, 0.0F, random.uniform(), random.uniform2());
      ASSERT_TRUE(s);
      test::expect_sound(*s);
      // Only at the very rim may rounding of the direction decide.
      const double across = glm::length(glm::cross(Vec3d(s->direction), Vec3d(to_sun)));
      if (across > std::sin(static_cast<double>(radius)) * (1.0 - 2e-3)) continue;
      EXPECT_NEAR(light->pdf_direct({}, s->direction, {}) / s->pdf, 1.0F, 1e-4F);
      EXPECT_EQ(light->radiance({}, -s->direction), s->radiance);
    }
    EXPECT_TRUE(is_black(light->radiance({}, to_sun)));
    EXPECT_EQ(light->pdf_direct({}, -to_sun, {}), 0.0F);
  }
}

TEST(SunLight, WithoutIrradianceGivesNothing) {
  EXPECT_FALSE(first_sample(*make_sun_light({0, -1, 0}, Rgb(0.0F), 0.01F, 1.0F), {0, 0, 0}));
}

}  // namespace
}  // namespace hyades::core
