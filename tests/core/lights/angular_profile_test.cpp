#include "core/lights/angular_profile.h"

#include <gtest/gtest.h>

#include <cmath>
#include <memory>
#include <optional>

#include "tests/core/lights/emission_checks.h"

namespace hyades::core {
namespace {

constexpr float kHalf = 0.4F;  // of the spread that is tried, radians

SurfaceEmission through_a_grid(float half = kHalf, bool two_sided = false) {
  SurfaceEmission emission{kRadiance, two_sided};
  emission.profile = make_spread(2.0F * half);
  return emission;
}

/// Of light at `angle` from the normal, as it is said.
double through(double angle, double half) {
  const double left = 1.0 - half / std::tan(half);
  return std::max(1.0 - std::tan(angle) / std::tan(half), 0.0) / left;
}

/// What places are chosen by and what rays meet agree, from places around `middle`.
void expect_rays_find_the_same(const World& world, const Light& light, const Vec3& middle) {
  test::Random random(5);
  int compared = 0;
  for (int i = 0; i < 4000; ++i) {
    const Vec3 from = middle + 0.8F * random.direction();
    const auto s = light.sample_direct(from, 0.0F, random.uniform(), random.uniform2());
    if (!s) continue;
    test::expect_sound(*s);
    const Ray ray{from, s->direction, kInfinity, 0.0F};
    const auto hit = world.intersect(ray, RayKind::diffuse);
    if (!hit) continue;  // the rim
    const SurfacePoint on = world.surface(ray, *hit);
    // Another side may be in the way.
    if (std::abs(on.t - s->distance) > 1e-2F || glm::dot(on.ng, s->normal) < 0.99F) continue;
    const float cosine = std::abs(glm::dot(on.ng, s->direction));
    if (cosine < 0.05F) continue;  // differs by more than rounding there
    ASSERT_NEAR(light.pdf_direct(from, s->direction, on) / s->pdf, 1.0F, 1e-3F);
    ASSERT_NEAR(light.radiance(on, -s->direction).y, s->radiance.y, 2e-3F * s->radiance.y + 1e-4F);
    ++compared;
  }
  EXPECT_GT(compared, 300);
}

TEST(Spread, IsDarkBeyondItsAngleAndKeepsItsFlux) {
  const Vec3 n(0, 0, 1);
  for (const float half : {0.02F, 0.4F, 1.2F, 1.55F}) {
    const ProfilePtr grid = make_spread(2.0F * half);
    const double flux = test::integrate2(
        [&](double angle, double) {
          const Vec3 out(static_cast<float>(std::sin(angle)), 0.0F,
                         static_cast<float>(std::cos(angle)));
          return static_cast<double>(grid->share(n, out).y) * std::cos(angle) * std::sin(angle);
        },
        0.0, double{half}, 0.0, 2.0 * M_PI);
    EXPECT_NEAR(flux / M_PI, 1.0, 2e-3) << half;
    for (const float part : {0.1F, 0.5F, 0.9F}) {
      const float angle = part * half;
      EXPECT_NEAR(grid->share(n, {std::sin(angle), 0, std::cos(angle)}).x /
                      through(double{angle}, double{half}),
                  1.0, 1e-3)
          << half;
    }
    const float beyond = half + 0.01F;
    EXPECT_TRUE(is_black(grid->share(n, {std::sin(beyond), 0, std::cos(beyond)})));
  }
  EXPECT_EQ(make_spread(kPi), nullptr) << "no grid";
}

TEST(Spread, IrradianceUnderADiskByQuadrature) {
  const Lamp lamp(quadric(Shape::Kind::disk, 0.75F), {Mat4(1.0F)}, through_a_grid());
  for (const Vec3d from : {Vec3d(0.0, 1.0, 0.0), Vec3d(0.5, 2.0, 0.2)}) {
    const double expected = static_cast<double>(luminance(kRadiance)) *
                            test::integrate2(
                                [&](double r, double turn) {
                                  const Vec3d place(r * std::cos(turn), 0.0, r * std::sin(turn));
                                  const Vec3d d = from - place;
                                  const double d2 = glm::dot(d, d);
                                  const double angle = std::acos(d.y / std::sqrt(d2));
                                  return through(angle, double{kHalf}) * d.y * d.y / (d2 * d2) * r;
                                },
                                0.0, 0.75, 0.0, 2.0 * M_PI);
    EXPECT_TRUE(
        test::mean_is(test::irradiance(*lamp.light, Vec3(from), {0, -1, 0}, 2'000'000), expected));
  }
  EXPECT_FALSE(lamp.light->sample_direct({2, 1, 0}, 0.0F, 0.1F, {0.4F, 0.6F})) << "beside";
}

TEST(Spread, LightPathsLeaveAsTheDensitySays) {
  for (const bool two_sided : {false, true}) {
    for (const auto& [name, shape, chart] : lamps()) {
      SCOPED_TRACE(name);
      const Lamp narrow(shape, {moved({1, 2, 3})}, through_a_grid(kHalf, two_sided));
      expect_emission_agrees(narrow, static_cast<double>(narrow.light->power()), 0.0F, 40'000);
      const Lamp wide(shape, {moved({1, 2, 3})}, through_a_grid(1.4F, two_sided));
      expect_rays_find_the_same(*wide.world, *wide.light, {1.3F, 3.7F, 3.4F});
    }
  }
  const ProfilePtr grid = make_spread(2.0F * kHalf);
  const Vec3 n = glm::normalize(Vec3(1, 2, -1));
  const test::ConeView view{Frame::around(n), 1.3 * (1.0 - std::cos(double{kHalf}))};
  EXPECT_TRUE(test::directions_follow(
      [&](test::Random& random) {
        return std::optional(view.spread(grid->choose(n, random.uniform2())));
      },
      [&](const Vec3& e) {
        return view.density(static_cast<double>(grid->pdf(n, view.gather(e))));
      },
      test::sphere_test(1e-3, 9)));
}

/// A spot of 40 degrees with a radius, alone in the world.
struct Ball {
  GeometryCache cache;
  PointSourcePtr source =
      make_spot_light({1, 2, 3}, {0, -1, 0}, Rgb(40, 50, 60), std::cos(0.4F), std::cos(0.7F));
  std::shared_ptr<const World> world;
  LightPtr light;

  explicit Ball(float radius) {
    world = *build_world({placed(quadric(Shape::Kind::sphere, radius), {moved({1, 2, 3})})}, cache);
    light = make_ball_light(*world, 0, source);
  }
};

TEST(BallLight, IsItsSourceFromAfar) {
  const Ball ball(0.01F);
  for (const float angle : {0.0F, 0.3F, 0.5F, 0.6F, 0.8F}) {
    const Vec3 from = Vec3(1, 2, 3) + 20.0F * Vec3(std::sin(angle), -std::cos(angle), 0.0F);
    const auto point = ball.source->sample_direct(from, 0.0F, 0.5F, {0.5F, 0.5F});
    const double expected = point ? static_cast<double>(luminance(point->radiance)) : 0.0;
    const Vec3 to_light = glm::normalize(Vec3(1, 2, 3) - from);
    const auto found = test::irradiance(*ball.light, from, to_light, 4000);
    EXPECT_NEAR(found.mean(), expected, 2e-4 * expected) << angle;
  }
}

TEST(BallLight, GivesTheFluxOfItsSourceAlsoByLightPaths) {
  const Ball ball(0.5F);
  EXPECT_NEAR(ball.light->power() / ball.source->power(), 1.0F, 1e-5F);
  test::Random random(3);
  test::Moments flux;
  for (int i = 0; i < 700'000; ++i) {
    const auto s = emitted(*ball.light, 0.0F, random);
    flux.add(s ? static_cast<double>(luminance(s->weight)) : 0.0);
    if (!s) continue;
    ASSERT_GT(glm::dot(s->direction, s->on.ng), 0.0F);
    ASSERT_EQ(ball.light->pdf_outward(s->on.ng, s->direction), s->pdf_direction);
    ASSERT_FALSE(is_black(ball.light->radiance(s->on, s->direction)));
  }
  EXPECT_TRUE(test::mean_is(flux, static_cast<double>(ball.source->power())));
}

TEST(BallLight, ShadowTestsAndRaysFindTheSame) {
  const Ball ball(0.5F);
  expect_rays_find_the_same(*ball.world, *ball.light, {1, 0.5F, 3});
}

}  // namespace
}  // namespace hyades::core
