#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>
#include <functional>
#include <limits>

#include "core/image/read_image.h"
#include "core/lights/make_light.h"
#include "tests/core/lights/sky_checks.h"
#include "tests/support/means.h"
#include "tests/support/quadrature.h"
#include "tests/support/shared_assets.h"

namespace hyades::core {
namespace {

using Painter = std::function<Rgb(int, int)>;

std::shared_ptr<Image> paint(int width, int height, const Painter& painter) {
  auto image = std::make_shared<Image>();
  image->width = width;
  image->height = height;
  image->channels = {"R", "G", "B"};
  for (int y = 0; y < height; ++y) {
    for (int x = 0; x < width; ++x) {
      const Rgb c = painter(x, y);
      image->data.insert(image->data.end(), {c.x, c.y, c.z});
    }
  }
  return image;
}

std::shared_ptr<Image> noise(int width, int height) {
  auto random = std::make_shared<test::Random>(29);
  return paint(width, height, [=](int, int) {
    const float r = random->uniform();
    const float g = random->uniform();
    return Rgb(r * r * r * r, g, random->uniform());
  });
}

LightPtr sky(std::shared_ptr<const Image> image, float turn = 0.0F, const Rgb& scale = Rgb(1.0F)) {
  return make_environment_light(std::move(image), turn, scale, 2.0F);
}

/// Wherever a sky shines, it can be chosen.
void expect_no_light_without_density(const Light& light) {
  test::Random random(31);
  for (int i = 0; i < 200000; ++i) {
    const Vec3 d = random.direction();
    if (is_black(seen(light, d))) continue;
    ASSERT_GT(light.pdf_direct({}, d, {}), 0.0F) << d.x << ' ' << d.y << ' ' << d.z;
  }
}

double true_irradiance(const Light& light, const Vec3& n) {
  return test::integrate_sphere(
      [&](const Vec3& d) {
        return static_cast<double>(luminance(seen(light, d)) * std::max(glm::dot(d, n), 0.0F));
      },
      -1.0, 1.0, 1e-3, 64);
}

TEST(ConstantEnvironment, GivesPiTimesItsRadiance) {
  const auto light = make_environment_light(nullptr, 0.3F, Rgb(1, 2, 3), 5.0F);
  const double l = static_cast<double>(luminance(Rgb(1, 2, 3)));
  EXPECT_TRUE(light->is_infinite());
  EXPECT_EQ(seen(*light, {0, 1, 0}), Rgb(1, 2, 3));
  EXPECT_NEAR(light->power(), 4.0 * M_PI * l * M_PI * 25.0, 1.0);
  EXPECT_TRUE(test::mean_is(test::irradiance(*light, {0, 0, 0}, {0, 0, 1}, 600000), M_PI * l));
  expect_sampled_right(*light, 1);
}

TEST(ConstantEnvironment, WithoutRadianceGivesNothing) {
  const auto light = make_environment_light(nullptr, 0.0F, Rgb(0.0F), 5.0F);
  EXPECT_FALSE(light->sample_direct({}, 0.0F, 0.5F, {0.5F, 0.5F}));
  EXPECT_EQ(light->pdf_direct({}, {0, 1, 0}, {}), 0.0F);
  EXPECT_EQ(light->power(), 0.0F);
}

TEST(ImageEnvironment, FollowsItsDirectionConvention) {
  // Four columns, three rows; u = atan2(z, x) / 2pi + 0.5, v from the top.
  const auto image = paint(4, 3, [](int x, int y) {
    return Rgb(static_cast<float>(x + 1), static_cast<float>(y + 1), 1.0F);
  });
  const auto light = sky(image);
  const auto towards = [](float u, float v) {
    const float phi = 2.0F * kPi * (u - 0.5F);
    const float theta = kPi * v;
    return Vec3(std::sin(theta) * std::cos(phi), std::cos(theta), std::sin(theta) * std::sin(phi));
  };
  for (int y = 0; y < 3; ++y) {
    for (int x = 0; x < 4; ++x) {
      const Rgb c = seen(*light, towards((static_cast<float>(x) + 0.5F) / 4.0F,
                                         (static_cast<float>(y) + 0.5F) / 3.0F));
      EXPECT_NEAR(c.x, static_cast<float>(x + 1), 1e-4F);
      EXPECT_NEAR(c.y, static_cast<float>(y + 1), 1e-4F);
    }
  }
  // +x is the middle of the picture, +z three quarters of the way to the right.
  EXPECT_NEAR(seen(*light, {1, 0, 0}).x, 2.5F, 1e-4F);
  EXPECT_NEAR(seen(*light, {0, 0, 1}).x, 3.5F, 1e-4F);
  EXPECT_NEAR(seen(*light, {0, 0, -1}).x, 1.5F, 1e-4F);
  EXPECT_NEAR(seen(*light, {-1, 0, 0}).x, 2.5F, 1e-4F);  // between the last and the first: the seam
  EXPECT_NEAR(seen(*light, {0, 1, 0}).y, 1.0F, 1e-4F);
  EXPECT_NEAR(seen(*light, {0, -1, 0}).y, 3.0F, 1e-4F);
}

TEST(ImageEnvironment, TurnsCounterClockwiseSeenFromAbove) {
  const auto image = noise(16, 8);
  const auto straight = sky(image);
  const float angle = 0.7F;
  const auto turned = sky(image, angle);
  test::Random random(2);
  for (int i = 0; i < 1000; ++i) {
    const Vec3 d = random.direction();
    // A right-handed turn about +y by `angle`.
    const Vec3 moved(std::cos(angle) * d.x + std::sin(angle) * d.z, d.y,
                     -std::sin(angle) * d.x + std::cos(angle) * d.z);
    const Rgb a = seen(*straight, d);
    const Rgb b = seen(*turned, moved);
    EXPECT_NEAR(a.x, b.x, 1e-4F);
    EXPECT_NEAR(a.y, b.y, 1e-4F);
    EXPECT_NEAR(straight->pdf_direct({}, d, {}), turned->pdf_direct({}, moved, {}), 1e-4F);
  }
}

TEST(ImageEnvironment, SamplesNoise) {
  expect_sampled_right(*sky(noise(16, 8), 1.1F, Rgb(3, 2, 1)), 3);
  expect_no_light_without_density(*sky(noise(16, 8)));
}

TEST(ImageEnvironment, SamplesOneBrightPixelAnywhere) {
  const Vec2i places[] = {{5, 3}, {0, 4}, {15, 2}, {7, 0}, {2, 7}};  // middle, seam, both poles
  uint64_t seed = 10;
  for (const Vec2i& p : places) {
    const auto image = paint(
        16, 8, [&](int x, int y) { return x == p.x && y == p.y ? Rgb(83000.0F) : Rgb(0.0F); });
    const auto light = sky(image, 0.4F);
    expect_sampled_right(*light, seed++);
    expect_no_light_without_density(*light);
  }
}

TEST(ImageEnvironment, SamplesAHalfBlackSky) {
  for (const bool below : {false, true}) {
    const auto image = paint(16, 8, [&](int x, int y) {
      return (below ? y >= 4 : x < 8) ? Rgb(0.0F) : Rgb(1.0F + static_cast<float>(x));
    });
    expect_sampled_right(*sky(image), 20);
    expect_no_light_without_density(*sky(image));
  }
}

TEST(ImageEnvironment, SamplesTheSmallestPictures) {
  expect_sampled_right(*sky(noise(1, 1)), 30);
  expect_sampled_right(*sky(noise(2, 1)), 31);
  expect_sampled_right(*sky(noise(1, 5)), 32);
}

TEST(ImageEnvironment, IrradianceIsThatOfThePicture) {
  const auto light = sky(noise(32, 16), 0.2F, Rgb(2.0F));
  for (const Vec3& n : {Vec3(0, 1, 0), Vec3(1, 0, 0), glm::normalize(Vec3(-1, -1, 0.3F))}) {
    EXPECT_TRUE(
        test::mean_is(test::irradiance(*light, {0, 0, 0}, n, 600000), true_irradiance(*light, n)));
  }
  // Power: the integral over all directions through a disc of the world's radius.
  const double integral = test::integrate_sphere(
      [&](const Vec3& d) { return static_cast<double>(luminance(seen(*light, d))); }, -1.0, 1.0,
      1e-3, 32);
  EXPECT_NEAR(static_cast<double>(light->power()) / (M_PI * 4.0 * integral), 1.0, 1e-2);
}

TEST(ImageEnvironment, ConstantPictureIsAConstantSky) {
  const auto light = sky(paint(64, 32, [](int, int) { return Rgb(0.5F); }));
  test::Random random(41);
  for (int i = 0; i < 10000; ++i) {
    ASSERT_NEAR(light->pdf_direct({}, random.direction(), {}), 0.25F * kInvPi, 2e-5F);
  }
}

LightPtr sky_by_excess(std::shared_ptr<const Image> image) {
  return make_environment_light(std::move(image), 0.3F, Rgb(2, 1, 3), 2.0F, SkyDensity::excess);
}

TEST(SkyByExcess, ChoosesWhereItIsBrighterThanItsMean) {
  const auto image = paint(16, 8, [](int x, int y) { return Rgb(static_cast<float>(x * y)); });
  const auto light = sky_by_excess(image);
  const auto whole = make_environment_light(image, 0.3F, Rgb(2, 1, 3), 2.0F);
  expect_sampled_right(*light, 50);
  // Its own scale does not count.
  const double mean = test::integrate_sphere(
                          [&](const Vec3& d) {
                            return static_cast<double>(luminance(seen(*whole, d) / Rgb(2, 1, 3)));
                          },
                          -1.0, 1.0, 1e-3, 32) /
                      (4.0 * M_PI);
  test::Random random(51);
  int chosen = 0;
  int bright = 0;
  for (int i = 0; i < 20000; ++i) {
    const Vec3 d = random.direction();
    ASSERT_EQ(seen(*light, d), seen(*whole, d));
    const bool can = light->pdf_direct({}, d, {}) > 0.0F;
    const bool brighter =
        static_cast<double>(luminance(seen(*light, d) / Rgb(2, 1, 3))) > 1.01 * mean;
    EXPECT_TRUE(can || !brighter) << d.x << ' ' << d.y << ' ' << d.z;
    chosen += can ? 1 : 0;
    bright += brighter ? 1 : 0;
  }
  // A cell with one corner above the mean has a density everywhere.
  EXPECT_GT(bright, 5000);
  EXPECT_LT(chosen, 13000);
  EXPECT_GT(light->power(), 0.05F * whole->power());
  EXPECT_LT(light->power(), 0.5F * whole->power());
}

TEST(SkyByExcess, KnowsHowMuchThatIs) {
  // The northern half is twice as bright as the southern: mean 1.5, a sixth of all is above it.
  const auto image = paint(64, 512, [](int, int y) { return Rgb(y < 256 ? 2.0F : 1.0F); });
  const float share = sky_by_excess(image)->power() /
                      make_environment_light(image, 0.3F, Rgb(2, 1, 3), 2.0F)->power();
  EXPECT_NEAR(share, 1.0F / 6.0F, 1e-3F);
  const auto light = sky_by_excess(image);
  EXPECT_NEAR(light->pdf_direct({}, {0.0F, 0.8F, 0.6F}, {}), 0.5F * kInvPi, 1e-3F);
  EXPECT_EQ(light->pdf_direct({}, {0.0F, -0.8F, 0.6F}, {}), 0.0F);
}

TEST(SkyByExcess, AnEvenSkyIsNeverChosen) {
  const auto even = paint(64, 32, [](int, int) { return Rgb(0.7F, 0.31F, 0.123F); });
  for (const auto& image : {even, std::shared_ptr<Image>()}) {
    const auto light = sky_by_excess(image);
    EXPECT_EQ(light->power(), 0.0F);
    EXPECT_EQ(light->pdf_direct({}, {0, 1, 0}, {}), 0.0F);
    EXPECT_FALSE(light->sample_direct({}, 0.0F, 0.5F, {0.5F, 0.5F}));
    EXPECT_GT(min_component(seen(*light, {0, 1, 0})), 0.1F);
  }
}

TEST(ImageEnvironment, CountsBrokenPixelsAsBlack) {
  const float inf = std::numeric_limits<float>::infinity();
  const auto light = sky(paint(4, 2, [&](int x, int y) {
    if (x == 0) return Rgb(std::nanf(""));
    if (x == 1) return Rgb(-1.0F);
    return x == 2 && y == 0 ? Rgb(inf) : Rgb(1.0F);
  }));
  EXPECT_TRUE(std::isfinite(light->power()));
  test::Random random(42);
  for (int i = 0; i < 1000; ++i) {
    const auto s = light->sample_direct({}, 0.0F, random.uniform(), random.uniform2());
    if (s) test::expect_sound(*s);
    EXPECT_GE(min_component(seen(*light, random.direction())), 0.0F);
  }
}

TEST(ImageEnvironment, BlackPictureGivesNothing) {
  const auto light = sky(paint(4, 2, [](int, int) { return Rgb(0.0F); }));
  EXPECT_FALSE(light->sample_direct({}, 0.0F, 0.5F, {0.5F, 0.5F}));
  EXPECT_EQ(light->pdf_direct({}, {0, 1, 0}, {}), 0.0F);
  EXPECT_EQ(light->power(), 0.0F);
}

TEST(ImageEnvironment, GreyPicturesWork) {
  auto image = std::make_shared<Image>();
  image->width = 2;
  image->height = 1;
  image->channels = {"Y"};
  image->data = {1.0F, 3.0F};
  EXPECT_NEAR(seen(*sky(image), {0, 0, -1}).z, 1.0F, 1e-4F);
  EXPECT_NEAR(seen(*sky(image), {0, 0, 1}).x, 3.0F, 1e-4F);
}

TEST(ImageEnvironment, ConvergesUnderAMeasuredSun) {
  const std::string path = test::shared_file("assets/hdri/kloppenheim_05_1k.hdr");
  HYADES_SKIP_WITHOUT(path);
  auto image = read_image_file(path);
  ASSERT_TRUE(image) << image.error().message;
  const auto light = sky(std::make_shared<Image>(std::move(*image)));
  // The truth by brute force: the middle of each quarter of a pixel stands for its solid angle.
  constexpr int kColumns = 2048;
  constexpr int kRows = 1024;
  double expected = 0.0;
  for (int y = 0; y < kRows / 2; ++y) {
    const double theta = M_PI * (y + 0.5) / kRows;
    const double weight =
        std::sin(theta) * std::cos(theta) * (M_PI / kRows) * (2 * M_PI / kColumns);
    for (int x = 0; x < kColumns; ++x) {
      const double phi = 2.0 * M_PI * (x + 0.5) / kColumns;
      const Vec3d d(std::sin(theta) * std::cos(phi), std::cos(theta),
                    std::sin(theta) * std::sin(phi));
      expected += static_cast<double>(luminance(seen(*light, Vec3(d)))) * weight;
    }
  }
  const auto up = test::irradiance(*light, {0, 0, 0}, {0, 1, 0}, 200000);
  EXPECT_TRUE(test::mean_is(up, expected));
  // With density in proportion to luminance only the cosine varies, between 0 and 1.
  EXPECT_LT(std::sqrt(up.variance()) / up.mean(), 0.8);
  expect_no_light_without_density(*light);
}

}  // namespace
}  // namespace hyades::core
