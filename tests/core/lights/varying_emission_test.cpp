// Lamps whose light differs from place to place: T1 and T2 of how places are chosen, power and
// irradiance against integrals, and what choosing bright places is good for.

#include <gtest/gtest.h>

#include <cmath>

#include "tests/core/lights/emission_checks.h"
#include "tests/core/materials/test_textures.h"

namespace hyades::core {
namespace {

/// `low`, and a bright spot of width `width` around uv (0.7, 0.3).
TexturePtr spot(float low, float width) {
  return function_texture([low, width](const TexturePoint& at) {
    const Vec2 d = (at.uv - Vec2(0.7F, 0.3F)) / width;
    ScalarGradient g;
    g.value = low + 4.0F * std::exp(-glm::dot(d, d));
    return g;
  });
}

/// Twelve by twelve cells, whose edges are some of those that the charts' cells have.
SurfaceEmission spotted(bool two_sided = false, float low = 0.3F, float width = 0.2F) {
  SurfaceEmission emission{kRadiance, two_sided};
  emission.texture = spot(low, width);
  emission.look_ups = 4 * 12 * 12;
  return emission;
}

/// The integral of the luminance that leaves along the normal, as rays find it, over the surface.
double brightness(const Lamp& lamp, const test::SurfaceChart& chart) {
  const auto cells =
      chart_shares(lamp, chart, 0.0F, [&](const SurfacePoint& on, const Vec3d&, const Vec3d&) {
        return static_cast<double>(luminance(lamp.light->radiance(on, on.ng)));
      });
  return std::accumulate(cells.begin(), cells.end(), 0.0);
}

TEST(VaryingEmission, ChoosesPlacesAsItSays) {
  for (const LampCase& lamp_case : lamps()) {
    for (const bool stretched : {false, true}) {
      SCOPED_TRACE(std::string(lamp_case.name) + (stretched ? ", stretched" : ""));
      const Lamp lamp(lamp_case.shape, {stretched ? skewed() : skewed_but_round()},
                      spotted(stretched));
      expect_emission_follows(lamp, *lamp_case.chart, stretched, 10);
      expect_emission_agrees(
          lamp, brightness(lamp, *lamp_case.chart) * M_PI * (stretched ? 2.0 : 1.0), 0.0F, 40000);
    }
  }
}

TEST(VaryingEmission, PowerIsTheIntegralOfWhatLeaves) {
  for (const LampCase& lamp_case : lamps()) {
    SCOPED_TRACE(lamp_case.name);
    SurfaceEmission emission = spotted();
    emission.look_ups = 1U << 16U;
    emission.cutout = make_cutout(make_black(), {0.0F, object_slope({0.4F, 0.3F, 0.9F})});
    const Lamp lamp(lamp_case.shape, {skewed()}, emission);
    const double power = brightness(lamp, *lamp_case.chart) * M_PI;
    EXPECT_NEAR(static_cast<double>(lamp.light->power()) / power, 1.0, 5e-3);

    const std::array<uint32_t, 2> parts{0, 0};
    for (const LightPtr& part : make_area_lights(*lamp.world, parts, emission, 60.0F)) {
      EXPECT_NEAR(part->power(), 30.0F, 1e-3F);
      SurfacePoint on = lamp.light->sample_emission(0, 0.7F, {0.4F, 0.4F}, {0.4F, 0.4F})->on;
      EXPECT_NEAR(luminance(part->radiance(on, on.ng)) / luminance(lamp.light->radiance(on, on.ng)),
                  30.0F / lamp.light->power(), 1e-3F);
    }
  }
}

TEST(VaryingEmission, RectangleIsSeenAsItSaysNearAndFar) {
  const Mat4 tilted = glm::rotate(moved({0.3F, -0.2F, 0.1F}), 0.8F, glm::normalize(Vec3(1, 2, 3)));
  const Lamp lamp(mesh(make_rectangle({1.5F, 0.8F})), {tilted}, spotted(true));
  const test::BoxChart chart({1.5, 0.0, 0.8});
  for (const Vec3& local :
       {Vec3(0, 30, 2), Vec3(1, 6, 3), Vec3(0.1F, -0.5F, 0), Vec3(-2, 1, 0.3F)}) {
    const Vec3 from = transform_point(tilted, local);
    expect_places_follow(lamp, chart, from, 4);
    expect_samples_agree_with_rays(lamp, from, 0.0F, false);
  }
}

TEST(VaryingEmission, OtherShapesAreSeenAsTheySay) {
  for (const LampCase& lamp_case : lamps()) {
    SCOPED_TRACE(lamp_case.name);
    const Lamp lamp(lamp_case.shape, {skewed_but_round()}, spotted(true));
    for (const Vec3& from : {Vec3(0.3F, 1.9F, 1.1F), Vec3(0.25F, -0.3F, 0.2F)}) {
      expect_samples_agree_with_rays(lamp, from, 0.0F, false);
      expect_places_follow(lamp, *lamp_case.chart, from, 10);
    }
  }
}

/// Light on a plane in the lamp's view, by charts, in the mean of samples.
TEST(VaryingEmission, LightsAPlaneAsItsIntegralSays) {
  const auto lit = [](const Lamp& lamp, const test::SurfaceChart& chart, const Vec3& from,
                      const Vec3& n, int samples) {
    const auto cells = chart_shares(
        lamp, chart, 0.0F, [&](const SurfacePoint& on, const Vec3d& place, const Vec3d& normal) {
          const Vec3d to_light = place - Vec3d(from);
          const double distance2 = glm::dot(to_light, to_light);
          const double cosines = std::max(glm::dot(to_light, Vec3d(n)), 0.0) *
                                 std::max(-glm::dot(to_light, normal), 0.0) / distance2;
          const Rgb radiance = lamp.light->radiance(on, on.ng);
          return static_cast<double>(luminance(radiance)) * cosines / distance2;
        });
    EXPECT_TRUE(test::mean_is(test::irradiance(*lamp.light, from, n, samples),
                              std::accumulate(cells.begin(), cells.end(), 0.0), {.tests = 4}));
  };
  const Mat4 down = glm::scale(moved({0, 2, 0}), {1, -1, -1});
  const Lamp screen(mesh(make_rectangle({1.5F, 0.8F})), {down}, spotted(false, 0.0F));
  lit(screen, test::BoxChart({1.5, 0.0, 0.8}), {0.3F, 1.7F, 0.1F}, {0, 1, 0}, 300000);
  lit(screen, test::BoxChart({1.5, 0.0, 0.8}), {0.3F, -9, 0.1F}, {0, 1, 0}, 100000);
  const Lamp disk(quadric(Shape::Kind::disk, 0.75F), {down}, spotted(false, 0.05F));
  lit(disk, test::DiskChart(0.75), {0.3F, 0.5F, 0.1F}, {0, 1, 0}, 300000);
  const Lamp ball(quadric(Shape::Kind::sphere, 0.6F), {down}, spotted(false, 0.05F));
  lit(ball, test::SphereChart(0.6), {0.2F, -1, 0.4F}, {0, 1, 0}, 600000);
}

TEST(VaryingEmission, BrightSpotsMakeLittleNoise) {
  // One light is the spot, the other is everywhere alike, and the spot's share is multiplied in.
  const Mat4 down = glm::scale(moved({0, 2, 0}), {1, -1, -1});
  const Shape shape = mesh(make_rectangle({1.5F, 0.8F}));
  SurfaceEmission emission = spotted(false, 0.01F, 0.05F);
  emission.look_ups = 1U << 16U;
  const Lamp varying(shape, {down}, emission);
  const Lamp even(shape, {down}, SurfaceEmission{kRadiance});
  const Vec3 from(0.3F, 0.2F, 0.1F);
  const test::Moments chosen = test::irradiance(*varying.light, from, {0, 1, 0}, 20000);
  test::Moments blind;
  test::Random random(7);
  for (int i = 0; i < 20000; ++i) {
    const auto s = even.light->sample_direct(from, 0.0F, random.uniform(), random.uniform2());
    ASSERT_TRUE(s);
    const Ray ray{from, s->direction, kInfinity, 0.0F};
    const auto hit = varying.world->intersect(ray, RayKind::diffuse);
    if (!hit) continue;
    const Rgb seen = varying.light->radiance(varying.world->surface(ray, *hit), -s->direction);
    blind.add(static_cast<double>(luminance(seen) * s->direction.y / s->pdf));
  }
  EXPECT_NEAR(chosen.mean() / blind.mean(), 1.0, 0.1);
  const double ratio = blind.variance() / chosen.variance();
  RecordProperty("variance_ratio", std::to_string(ratio));
  EXPECT_GT(ratio, 25.0);
}

TEST(VaryingEmission, OpacityCountsAsWhatIsThere) {
  SurfaceEmission emission{kRadiance};
  emission.cutout = make_cutout(make_black(), {0.25F, nullptr});
  const Lamp half(mesh(make_rectangle({2, 3})), {Mat4(1.0F)}, emission);
  const Lamp whole(mesh(make_rectangle({2, 3})), {Mat4(1.0F)});
  EXPECT_NEAR(half.light->power() / whole.light->power(), 0.25F, 1e-5F);
  const auto s = half.light->sample_direct({0, 1, 0}, 0.0F, 0.5F, {0.3F, 0.4F});
  ASSERT_TRUE(s);
  EXPECT_EQ(s->radiance, 0.25F * kRadiance);
}

TEST(VaryingEmission, BlackTexturesGiveNothing) {
  SurfaceEmission emission{kRadiance};
  emission.texture = function_texture([](const TexturePoint&) {
    ScalarGradient g;
    g.value = -1.0F;
    return g;
  });
  test::Random random(3);
  for (const LampCase& lamp_case : lamps()) {
    SCOPED_TRACE(lamp_case.name);
    const Lamp lamp(lamp_case.shape, {Mat4(1.0F)}, emission);
    EXPECT_EQ(lamp.light->power(), 0.0F);
    EXPECT_FALSE(lamp.light->bounds());
    EXPECT_FALSE(emitted(*lamp.light, 0.0F, random));
    EXPECT_FALSE(lamp.light->sample_direct({0, 3, 0}, 0.0F, 0.5F, {0.5F, 0.5F}));
  }
}

}  // namespace
}  // namespace hyades::core
