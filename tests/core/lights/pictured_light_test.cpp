// Lights of which a picture says how much goes where: projectors and goniometric lights.

#include <gtest/gtest.h>

#include <cmath>

#include "core/base/elementary.h"
#include "tests/core/lights/emission_checks.h"

namespace hyades::core {
namespace {

const Vec3 kAt(1, 2, 3);
const Rgb kPower(4.0F * kPi);

/// Right, up and forward of a light that looks along -z, as a camera does.
const Mat3 kAhead(Vec3(1, 0, 0), Vec3(0, 1, 0), Vec3(0, 0, -1));

std::shared_ptr<const Image> picture(int width, int height, std::vector<float> values) {
  auto image = std::make_shared<Image>(make_image(width, height, {"R", "G", "B"}));
  image->data = std::move(values);
  return image;
}

/// Red, green over blue, white.
std::shared_ptr<const Gobo> four_colors() {
  return std::make_shared<const Gobo>(picture(2, 2, {1, 0, 0, 0, 1, 0, 0, 0, 1, 1, 1, 1}));
}

/// What arrives one length from the light, in `direction` of it.
Rgb arriving(const Light& light, const Vec3& direction) {
  const auto s = light.sample_direct(kAt + glm::normalize(direction), 0.0F, 0.5F, {0.5F, 0.5F});
  return s ? s->radiance : Rgb(0.0F);
}

bool near(const Rgb& a, const Rgb& b, float slack = 1e-4F) {
  return max_component(glm::abs(a - b)) < slack;
}

TEST(Projector, ThrowsItsPictureUprightAndTheRightWayRound) {
  // tan(fov / 2) = 1: the corners are at (+-1, +-1, -1).
  const LightPtr light = make_projector_light(kAt, kAhead, kPower, 0.5F * kPi, four_colors());
  EXPECT_TRUE(near(arriving(*light, {-0.9F, 0.9F, -1}), {1, 0, 0}));
  EXPECT_TRUE(near(arriving(*light, {0.9F, 0.9F, -1}), {0, 1, 0}));
  EXPECT_TRUE(near(arriving(*light, {-0.9F, -0.9F, -1}), {0, 0, 1}));
  EXPECT_TRUE(near(arriving(*light, {0.9F, -0.9F, -1}), {1, 1, 1}));
  EXPECT_TRUE(near(arriving(*light, {0, 0, -1}), {0.5F, 0.5F, 0.5F}));
  for (const Vec3 outside :
       {Vec3(1.01F, 0, -1), Vec3(0, -1.01F, -1), Vec3(0, 0, 1), Vec3(0, 1, 0)}) {
    EXPECT_EQ(arriving(*light, outside), Rgb(0.0F));
    EXPECT_EQ(light->pdf_outward(Vec3(0.0F), glm::normalize(outside)), 0.0F);
  }
  const Mat3 mirrored(-kAhead[0], kAhead[1], kAhead[2]);
  const LightPtr other = make_projector_light(kAt, mirrored, kPower, 0.5F * kPi, four_colors());
  EXPECT_TRUE(near(arriving(*other, {0.9F, 0.9F, -1}), {1, 0, 0}));
}

TEST(Projector, ItsAngleIsAcrossTheShorterSide) {
  const float fov = 0.6F;
  const float half = std::tan(0.5F * fov);
  const std::vector<float> white(6, 1.0F);
  const LightPtr wide = make_projector_light(kAt, kAhead, kPower, fov,
                                             std::make_shared<const Gobo>(picture(2, 1, white)));
  EXPECT_TRUE(near(arriving(*wide, {1.99F * half, 0, -1}), Rgb(1.0F)));
  EXPECT_EQ(arriving(*wide, {2.01F * half, 0, -1}), Rgb(0.0F));
  EXPECT_EQ(arriving(*wide, {0, 1.01F * half, -1}), Rgb(0.0F));
  const LightPtr high = make_projector_light(kAt, kAhead, kPower, fov,
                                             std::make_shared<const Gobo>(picture(1, 2, white)));
  EXPECT_TRUE(near(arriving(*high, {0, 1.99F * half, -1}), Rgb(1.0F)));
  EXPECT_EQ(arriving(*high, {1.01F * half, 0, -1}), Rgb(0.0F));
}

TEST(Projector, FallsOffWithTheSquareOfTheDistance) {
  const LightPtr light = make_projector_light(kAt, kAhead, kPower, 1.0F, four_colors());
  const auto s = light->sample_direct(kAt + Vec3(0, 0, -2), 0.0F, 0.5F, {0.5F, 0.5F});
  ASSERT_TRUE(s);
  EXPECT_TRUE(near(s->radiance, Rgb(0.125F)));
  EXPECT_TRUE(s->delta);
  EXPECT_EQ(s->distance, 2.0F);
  EXPECT_EQ(s->position, kAt);
}

/// A white one of 90 degrees lights a sixth of the sphere: a side of a cube.
TEST(Projector, PowerIsThatOfItsSolidAngle) {
  const auto white = std::make_shared<const Gobo>(
      std::make_shared<const Image>(Image{64, 64, {"Y"}, std::vector<float>(64 * 64, 1.0F)}));
  EXPECT_NEAR(make_projector_light(kAt, kAhead, kPower, 0.5F * kPi, white)->power(),
              4.0F * kPi / 6.0F, 1e-3F);
}

TEST(Goniometric, SendsWhatItsPictureSaysInEachDirection) {
  // Left to right azimuths -135, -45, 45 and 135 degrees of atan2(z, x); two rows.
  std::vector<float> values;
  for (int i = 0; i < 8; ++i) {
    for (int c = 0; c < 3; ++c) values.push_back(static_cast<float>(i + 1));
  }
  const auto map = std::make_shared<const EnvironmentMap>(picture(4, 2, values));
  const LightPtr light = make_goniometric_light(kAt, Mat3(1.0F), kPower, map);
  EXPECT_TRUE(near(arriving(*light, {-1, 1.4142F, -1}), Rgb(1.0F), 1e-2F));
  EXPECT_TRUE(near(arriving(*light, {1, 1.4142F, -1}), Rgb(2.0F), 1e-2F));
  EXPECT_TRUE(near(arriving(*light, {1, -1.4142F, 1}), Rgb(7.0F), 1e-2F));
  // Turned by a quarter about y, x becomes -z.
  const Mat3 turned(Vec3(0, 0, -1), Vec3(0, 1, 0), Vec3(1, 0, 0));
  const LightPtr other = make_goniometric_light(kAt, turned, kPower, map);
  EXPECT_TRUE(near(arriving(*other, {-1, 1.4142F, -1}), Rgb(2.0F), 1e-2F));
}

struct Case {
  const char* name;
  LightPtr light;
};

std::vector<Case> cases() {
  test::Random random(3);
  const auto noise = [&](int width, int height, float black) {
    std::vector<float> values;
    for (int i = 0; i < width * height * 3; ++i) {
      values.push_back(random.uniform() < black ? 0.0F : random.uniform());
    }
    return picture(width, height, std::move(values));
  };
  const Vec3 forward = glm::normalize(Vec3(1, -2, 0.5F));
  const Frame frame = Frame::around(forward);
  const Mat3 axes(frame.s, frame.t, frame.n);
  const Mat3 mirrored(-frame.s, frame.t, frame.n);
  const Rgb power(40, 20, 10);
  return {
      {"narrow", make_projector_light(kAt, axes, power, 0.3F,
                                      std::make_shared<const Gobo>(noise(5, 3, 0.2F)))},
      {"wide and mirrored", make_projector_light(kAt, mirrored, power, 2.2F,
                                                 std::make_shared<const Gobo>(noise(3, 4, 0.5F)))},
      {"one pixel", make_projector_light(kAt, axes, power, 1.0F,
                                         std::make_shared<const Gobo>(noise(1, 1, 0.0F)))},
      {"goniometric",
       make_goniometric_light(kAt, mirrored, power,
                              std::make_shared<const EnvironmentMap>(noise(8, 5, 0.3F)))},
  };
}

TEST(PicturedLights, EmissionFollowsItsDensity) {
  for (const auto& [name, light] : cases()) {
    SCOPED_TRACE(name);
    const auto cone = light->bounds()->normals;
    const test::ConeView view{Frame::around(cone.axis),
                              std::min(1.3 * (1.0 - static_cast<double>(cone.cosine)), 2.0)};
    EXPECT_TRUE(test::directions_follow(
        [&](test::Random& random) -> std::optional<Vec3> {
          const auto s = emitted(*light, 0.3F, random);
          if (!s) return std::nullopt;
          return view.spread(s->direction);
        },
        [&](const Vec3& e) {
          return view.density(static_cast<double>(light->pdf_outward(Vec3(0.0F), view.gather(e))));
        },
        test::sphere_test(1e-3, 29, 4)));
  }
}

TEST(PicturedLights, EmitWhatArrives) {
  for (const auto& [name, light] : cases()) {
    SCOPED_TRACE(name);
    test::Random random(31);
    test::Moments flux;
    for (int i = 0; i < 100000; ++i) {
      const auto s = emitted(*light, 0.3F, random);
      if (!s) {
        flux.add(0.0);
        continue;
      }
      flux.add(static_cast<double>(luminance(s->weight)));
      ASSERT_EQ(s->on.position, kAt);
      ASSERT_EQ(s->on.ng, Vec3(0.0F));
      ASSERT_EQ(s->on.time, 0.3F);
      ASSERT_EQ(s->pdf_place, 1.0F);
      ASSERT_EQ(light->pdf_outward(Vec3(0.0F), s->direction), s->pdf_direction);
      const Rgb seen = arriving(*light, s->direction);
      const Rgb sent = s->weight * s->pdf_direction;
      // Near a border rounding of the place decides.
      if (is_black(seen)) continue;
      ASSERT_TRUE(near(sent, seen, 1e-2F * max_component(seen) + 1e-3F));
    }
    // Slides are added up over a grid, and maps as if cosines were linear within a row.
    EXPECT_NEAR(flux.mean() / static_cast<double>(light->power()), 1.0, 0.01);
  }
}

TEST(PicturedLights, WithoutLightThereIsNone) {
  test::Random random(41);
  const auto black = picture(2, 1, std::vector<float>(6, 0.0F));
  const LightPtr lights[] = {
      make_projector_light(kAt, kAhead, kPower, 1.0F, std::make_shared<const Gobo>(black)),
      make_goniometric_light(kAt, kAhead, kPower, std::make_shared<const EnvironmentMap>(black)),
      make_projector_light(kAt, kAhead, Rgb(0.0F), 1.0F, four_colors())};
  for (const LightPtr& light : lights) {
    EXPECT_FALSE(emitted(*light, 0.0F, random));
    EXPECT_FALSE(light->bounds());
    EXPECT_EQ(arriving(*light, {0, 0, -1}), Rgb(0.0F));
    EXPECT_EQ(light->pdf_outward(Vec3(0.0F), {0, 0, -1}), 0.0F);
  }
}

}  // namespace
}  // namespace hyades::core
