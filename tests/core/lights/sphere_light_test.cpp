#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "tests/core/lights/lamp.h"

namespace hyades::core {
namespace {

/// T1 for directions: a ball's cap as rays find it.
void expect_cap_follows(const Lamp& lamp, const Vec3& from, const Vec3& axis, double one_minus_cos,
                        int tests) {
  const test::ConeView view{Frame::around(axis), 1.3 * one_minus_cos};
  EXPECT_TRUE(test::directions_follow(
      [&](test::Random& random) -> std::optional<Vec3> {
        const auto s = lamp.light->sample_direct(from, 0.0F, random.uniform(), random.uniform2());
        if (!s) return std::nullopt;
        return view.spread(s->direction);
      },
      [&](const Vec3& e) {
        const Ray ray{from, view.gather(e), kInfinity, 0.0F};
        const auto hit = lamp.world->intersect(ray, RayKind::diffuse);
        if (!hit) return 0.0;
        const SurfacePoint on = lamp.world->surface(ray, *hit);
        return view.density(static_cast<double>(lamp.light->pdf_direct(from, ray.direction, on)));
      },
      test::sphere_test(1e-3, 5, tests)))
      << "from " << from.x << ' ' << from.y << ' ' << from.z;
}

TEST(SphereLight, IsChosenByItsSolidAngleFromOutside) {
  const Lamp lamp(quadric(Shape::Kind::sphere, 0.5F), {moved({1, 2, 3})});
  const Vec3 center(1, 2, 3);
  const Vec3 away = glm::normalize(Vec3(-1, 0.5F, 0.7F));
  for (const float distance : {0.501F, 0.55F, 1.0F, 5.0F, 1000.0F}) {
    const Vec3 from = center + away * distance;
    const double sine = 0.5 / static_cast<double>(distance);
    const double one_minus_cos = sine * sine / (1.0 + std::sqrt(1.0 - sine * sine));
    expect_cap_follows(lamp, from, -away, one_minus_cos, 5);
    expect_samples_agree_with_rays(lamp, from);
    // The density is that of the cap, so the estimate of a facing surface hardly varies.
    const double expected = M_PI * static_cast<double>(luminance(kRadiance)) * sine * sine;
    const auto facing = test::irradiance(*lamp.light, from, -away, 200000);
    if (distance < 100.0F) {
      EXPECT_TRUE(test::mean_is(facing, expected)) << distance;
    } else {  // varies less than float can tell
      EXPECT_NEAR(facing.mean() / expected, 1.0, 1e-5) << distance;
    }
  }
}

TEST(SphereLight, PlacesOnItFollowTheirSolidAngle) {
  const Lamp lamp(quadric(Shape::Kind::sphere, 0.5F), {skewed_but_round()});
  expect_places_follow(lamp, test::SphereChart(0.5), {0.2F, 0.3F, 1.2F}, 2);
  expect_places_follow(lamp, test::SphereChart(0.5), {-3, 5, 1}, 2);
}

TEST(SphereLight, TiltedReceiverGetsTheCosine) {
  const Lamp lamp(quadric(Shape::Kind::sphere, 0.5F), {moved({0, 0, 4})});
  // The whole ball is above the horizon, so its irradiance is that of its centre: E cos(tilt).
  const Vec3 n = glm::normalize(Vec3(1, 0, 1));
  const double expected = M_PI * static_cast<double>(luminance(kRadiance)) / 64.0 * M_SQRT1_2;
  EXPECT_TRUE(test::mean_is(test::irradiance(*lamp.light, {0, 0, 0}, n, 200000), expected));
}

TEST(SphereLight, ShinesOutwardsOnlyUnlessTwoSided) {
  const Lamp outwards(quadric(Shape::Kind::sphere, 2.0F), {Mat4(1.0F)});
  EXPECT_FALSE(outwards.light->sample_direct({0.3F, 0, 0}, 0.0F, 0.1F, {0.4F, 0.6F}));
  const Lamp both(quadric(Shape::Kind::sphere, 2.0F), {Mat4(1.0F)}, true);
  // Inside a luminous ball the radiance is the same from everywhere: E = pi L on any surface.
  const double expected = M_PI * static_cast<double>(luminance(kRadiance));
  int samples = 600000;
  for (const Vec3& from : {Vec3(0.0F), Vec3(0.3F, 0.5F, -0.5F), Vec3(0, 0, 1.6F)}) {
    expect_places_follow(both, test::SphereChart(2.0), from, 3);
    expect_samples_agree_with_rays(both, from);
    const Vec3 n = glm::normalize(Vec3(-1, 2, -1));
    EXPECT_TRUE(test::mean_is(test::irradiance(*both.light, from, n, samples), expected));
    samples *= 3;  // the nearer the surface, the more the density varies
  }
  EXPECT_NEAR(both.light->power() / outwards.light->power(), 2.0F, 1e-6F);
}

TEST(SphereLight, HoldsAtItsSurfaceAndAtAnyScale) {
  for (const float scale : {1e-3F, 1.0F, 1e6F}) {
    const Vec3 center = Vec3(3, -2, 5) * scale;
    const Lamp lamp(quadric(Shape::Kind::sphere, scale), {moved(center)}, true);
    test::Random random(13);
    for (const float distance : {0.0F, 0.999999F, 1.0F, 1.000001F, 1.0001F, 1e4F}) {
      for (int i = 0; i < 300; ++i) {
        const Vec3 from = center + random.direction() * (distance * scale);
        const auto s = lamp.light->sample_direct(from, 0.0F, random.uniform(), random.uniform2());
        if (s) test::expect_sound(*s);
        for (const SurfacePoint& p : all_along(*lamp.world, from, random.direction(), 0.0F)) {
          const float pdf = lamp.light->pdf_direct(from, glm::normalize(p.position - from), p);
          EXPECT_TRUE(std::isfinite(pdf));
          EXPECT_GE(pdf, 0.0F);
        }
      }
    }
  }
}

TEST(SphereLight, StretchedIsStillExact) {
  const Mat4 stretch = glm::scale(moved({0, 0, 3}), {0.4F, 1.5F, 0.8F});
  const Lamp ellipsoid(quadric(Shape::Kind::sphere, 1.0F), {stretch}, true);
  expect_places_follow(ellipsoid, test::SphereChart(1.0), {0, 0, 0}, 3);
  expect_places_follow(ellipsoid, test::SphereChart(1.0), {0.1F, 0.5F, 2.9F}, 3);
  expect_samples_agree_with_rays(ellipsoid, {0.5F, -1, 2});
  const Lamp skew(quadric(Shape::Kind::sphere, 0.7F), {skewed()}, true);
  expect_places_follow(skew, test::SphereChart(0.7), {0, -1, 2}, 3);
  expect_samples_agree_with_rays(skew, {0, -1, 2});
}

}  // namespace
}  // namespace hyades::core
