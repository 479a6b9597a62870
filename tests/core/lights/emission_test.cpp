// T1 and T2 of where light paths begin: sample_emission, pdf_place, pdf_outward of every light.

#include <gtest/gtest.h>

#include <array>
#include <cmath>

#include "tests/core/lights/lamp.h"

namespace hyades::core {
namespace {

std::optional<EmissionSample> emitted(const Light& light, float time, test::Random& random) {
  const float pick = random.uniform();
  const Vec2 place = random.uniform2();
  return light.sample_emission(time, pick, place, random.uniform2());
}

/// Directions around a normal cut into eight parts of each side, which cosines choose alike.
struct CosineParts {
  bool two_sided;

  size_t count() const { return two_sided ? 16 : 8; }
  size_t find(const Vec3& local) const {
    const size_t azimuth = (local.x > 0.0F ? 1U : 0U) + (local.y > 0.0F ? 2U : 0U);
    return azimuth + (local.z * local.z > 0.5F ? 4U : 0U) + (local.z < 0.0F ? 8U : 0U);
  }
};

/// Places have density pdf_place per area, which integrates to 1; directions are in proportion to
/// the cosine whatever the place. An error of 2 % in half of the joint cells is noticed.
void expect_emission_follows(const Lamp& lamp, const test::SurfaceChart& chart, bool two_sided,
                             int tests, float time = 0.0F) {
  const std::vector<double> places =
      chart_shares(lamp, chart, time, [&](const SurfacePoint& on, const Vec3d&, const Vec3d&) {
        return static_cast<double>(lamp.light->pdf_place(on, Vec3(0.0F)));
      });
  EXPECT_NEAR(std::accumulate(places.begin(), places.end(), 0.0), 1.0, 2e-3);
  const CosineParts parts{two_sided};
  const double alpha = test::sidak(0.01, tests);
  const size_t cells = places.size() * parts.count();
  const int64_t count =
      test::required_chi_squared_samples(static_cast<int>(cells) - 1, 0.02, alpha, 0.99);
  std::vector<double> expected;
  for (const double share : places) {
    expected.insert(expected.end(), parts.count(),
                    share * static_cast<double>(count) / static_cast<double>(parts.count()));
  }
  std::vector<double> observed(cells, 0.0);
  test::Random random(17);
  for (int64_t i = 0; i < count; ++i) {
    const auto s = emitted(*lamp.light, time, random);
    if (!s) continue;
    const Vec3 local = Frame::around(s->on.ng).to_local(s->direction);
    ASSERT_TRUE(two_sided || local.z >= 0.0F);
    observed[chart_cell(lamp, chart, s->on.position, time) * parts.count() + parts.find(local)] +=
        1.0;
  }
  const auto result = test::chi_squared(observed, expected);
  EXPECT_GT(result.p, alpha) << "chi-squared " << result.statistic << " with " << result.degrees
                             << " degrees of freedom";
}

/// Directions have density pdf_outward per solid angle.
void expect_directions_follow(const Light& light, float time, int tests) {
  EXPECT_TRUE(test::directions_follow(
      [&](test::Random& random) -> std::optional<Vec3> {
        const auto s = emitted(light, time, random);
        if (!s) return std::nullopt;
        return Frame::around(s->on.ng).to_local(s->direction);
      },
      [&](const Vec3& d) {
        return static_cast<double>(light.pdf_outward({0, 0, 1}, d));
      },
      test::sphere_test(1e-4, 19, tests)));
}

/// A sample's weight and densities are those that a camera path finds at its place, and in the mean
/// it carries the light's power (of the moment: `power`).
void expect_emission_agrees(const Lamp& lamp, double power, float time = 0.0F) {
  test::Random random(23);
  test::Moments flux;
  int compared = 0;
  for (int i = 0; i < 20000; ++i) {
    const auto s = emitted(*lamp.light, time, random);
    ASSERT_TRUE(s);
    flux.add(static_cast<double>(luminance(s->weight)));
    ASSERT_NEAR(glm::dot(s->direction, s->direction), 1.0F, 1e-5F);
    ASSERT_EQ(s->on.time, time);
    ASSERT_EQ(lamp.light->pdf_outward(s->on.ng, s->direction), s->pdf_direction);
    const float cosine = std::abs(glm::dot(s->on.ng, s->direction));
    const Rgb weight =
        lamp.light->radiance(s->on, s->direction) * cosine / (s->pdf_place * s->pdf_direction);
    for (int c = 0; c < 3; ++c) ASSERT_NEAR(s->weight[c] / weight[c], 1.0F, 1e-5F);
    if (i % 10 != 0) continue;
    // Met by a ray from where it shines to; edges may belong to another side.
    const Ray ray{s->on.position + 1e-2F * s->on.ng, -s->on.ng, 2e-2F, time};
    const auto hit = lamp.world->intersect(ray, RayKind::other);
    if (!hit) continue;
    const SurfacePoint met = lamp.world->surface(ray, *hit);
    if (glm::dot(met.ng, s->on.ng) < 0.99F) continue;
    ASSERT_LT(glm::length(met.position - s->on.position), 1e-4F);
    ASSERT_NEAR(lamp.light->pdf_place(met, s->direction) / s->pdf_place, 1.0F, 1e-3F);
    ++compared;
  }
  EXPECT_GT(compared, 1800);
  if (std::sqrt(flux.variance()) < 1e-4 * flux.mean()) {
    EXPECT_NEAR(flux.mean() / power, 1.0, 1e-4);
  } else {
    EXPECT_TRUE(test::mean_is(flux, power, {.relative_error = 0.02}));
  }
}

struct LampCase {
  const char* name;
  Shape shape;
  std::shared_ptr<const test::SurfaceChart> chart;
};

std::vector<LampCase> lamps() {
  return {
      {"sphere", quadric(Shape::Kind::sphere, 0.6F), std::make_shared<test::SphereChart>(0.6)},
      {"disk", quadric(Shape::Kind::disk, 0.75F), std::make_shared<test::DiskChart>(0.75)},
      {"cylinder", quadric(Shape::Kind::cylinder, 0.4F, 1.0F),
       std::make_shared<test::CylinderChart>(0.4, 1.0)},
      {"box", mesh(make_box({1, 2, 0.5F})), std::make_shared<test::BoxChart>(Vec3d(1.0, 2.0, 0.5))},
      {"rectangle", mesh(make_rectangle({1.5F, 0.8F})),
       std::make_shared<test::BoxChart>(Vec3d(1.5, 0.0, 0.8))}};
}

TEST(Emission, OfSurfacesFollowsItsDensities) {
  for (const LampCase& lamp_case : lamps()) {
    for (const bool two_sided : {false, true}) {
      SCOPED_TRACE(std::string(lamp_case.name) + (two_sided ? ", two-sided" : ""));
      const Lamp lamp(lamp_case.shape, {skewed_but_round()}, two_sided);
      expect_emission_follows(lamp, *lamp_case.chart, two_sided, 20);
      expect_directions_follow(*lamp.light, 0.0F, 20);
      expect_emission_agrees(lamp, static_cast<double>(lamp.light->power()));
    }
  }
}

TEST(Emission, OfStretchedSurfacesFollowsItsDensities) {
  for (const LampCase& lamp_case : lamps()) {
    SCOPED_TRACE(lamp_case.name);
    const Lamp lamp(lamp_case.shape, {skewed()});
    expect_emission_follows(lamp, *lamp_case.chart, false, 5);
    expect_emission_agrees(lamp, static_cast<double>(lamp.light->power()));
  }
}

TEST(Emission, OfMovingSurfacesFollowsTheMoment) {
  // Grows, turns and flies while the shutter is open; the turn makes it flat in between.
  Mat4 end = glm::rotate(moved({0, 0.5F, -1}), 1.2F, Vec3(0, 0, 1));
  end = glm::scale(end, {2, 1, 1});
  for (const LampCase& lamp_case : lamps()) {
    SCOPED_TRACE(lamp_case.name);
    const Lamp lamp(lamp_case.shape, {moved({0, 0, -3}), end});
    expect_emission_follows(lamp, *lamp_case.chart, false, 5, 0.6F);
    const Lamp still(lamp_case.shape, {lamp.world->transform_at(0, 0.6F)});
    expect_emission_agrees(lamp, static_cast<double>(still.light->power()), 0.6F);
  }
}

TEST(Emission, OfPointsAndSpotsFollowsItsDensity) {
  const Vec3 at(1, 2, 3);
  const Vec3 axis = glm::normalize(Vec3(1, -2, 0.5F));
  const Rgb power(40, 20, 10);
  constexpr std::array kCosines{std::array{-1.0F, -1.0F}, std::array{0.9F, 0.4F},
                                std::array{0.2F, -0.6F}, std::array{0.999F, 0.99F},
                                std::array{0.5F, 0.5F}};
  for (const auto& [inner, outer] : kCosines) {
    SCOPED_TRACE("outer cosine " + std::to_string(outer));
    const LightPtr light = outer == -1.0F ? make_point_light(at, power)
                                          : make_spot_light(at, axis, power, inner, outer);
    const test::ConeView view{Frame::around(axis),
                              std::min(1.3 * (1.0 - static_cast<double>(outer)), 2.0)};
    EXPECT_TRUE(test::directions_follow(
        [&](test::Random& random) -> std::optional<Vec3> {
          const auto s = emitted(*light, 0.3F, random);
          if (!s) return std::nullopt;
          return view.spread(s->direction);
        },
        [&](const Vec3& e) {
          return view.density(static_cast<double>(light->pdf_outward(Vec3(0.0F), view.gather(e))));
        },
        test::sphere_test(1e-3, 29, static_cast<int>(kCosines.size()))));

    test::Random random(31);
    test::Moments flux;
    for (int i = 0; i < 100000; ++i) {
      const auto s = emitted(*light, 0.3F, random);
      ASSERT_TRUE(s);
      flux.add(static_cast<double>(luminance(s->weight)));
      ASSERT_EQ(s->on.position, at);
      ASSERT_EQ(s->on.ng, Vec3(0.0F));
      ASSERT_EQ(s->on.time, 0.3F);
      ASSERT_EQ(s->pdf_place, 1.0F);
      ASSERT_EQ(light->pdf_place(s->on, s->direction), 1.0F);
      // What arrives one length away is the intensity. Near the rim rounding of the place decides.
      const auto seen = light->sample_direct(at + s->direction, 0.3F, 0.5F, {0.5F, 0.5F});
      const float least = 0.02F * power.y / (4.0F * kPi);
      if (!seen || seen->radiance.y < least) continue;
      ASSERT_EQ(light->pdf_outward(Vec3(0.0F), s->direction), s->pdf_direction);
      ASSERT_NEAR(s->weight.y * s->pdf_direction / seen->radiance.y, 1.0F, 5e-3F);
    }
    if (outer == inner) {
      EXPECT_NEAR(flux.mean() / static_cast<double>(light->power()), 1.0, 1e-4);
    } else {
      EXPECT_TRUE(test::mean_is(flux, static_cast<double>(light->power()),
                                {.tests = 2, .relative_error = 0.02}));
    }
  }
}

TEST(Emission, OfWhatIsFarAwayIsThatOfItsDirections) {
  auto image = std::make_shared<Image>();
  image->width = 2;
  image->height = 1;
  image->channels = {"Y"};
  image->data = {1.0F, 3.0F};
  const LightPtr lights[] = {make_environment_light(nullptr, 0.3F, Rgb(1, 2, 3), 5.0F),
                             make_environment_light(image, 0.3F, Rgb(1, 2, 3), 5.0F),
                             make_sun_light({0, -1, 0}, Rgb(1.0F), 0.4F, 5.0F)};
  for (const LightPtr& light : lights) {
    test::Random random(37);
    for (int i = 0; i < 1000; ++i) {
      ASSERT_FALSE(emitted(*light, 0.0F, random));
      const auto s = light->sample_direct({1, 2, 3}, 0.0F, random.uniform(), random.uniform2());
      ASSERT_TRUE(s);
      ASSERT_EQ(s->pdf_place, s->pdf);
      const Vec3 d = random.direction();
      ASSERT_EQ(light->pdf_place({}, d), light->pdf_direct({}, d, {}));
    }
  }
  // Delta lights: a probability.
  const LightPtr star = make_sun_light({0, -1, 0}, Rgb(1.0F), 0.0F, 5.0F);
  EXPECT_EQ(star->sample_direct({1, 2, 3}, 0.0F, 0.5F, {0.5F, 0.5F})->pdf_place, 1.0F);
  EXPECT_EQ(star->pdf_place({}, {0, 1, 0}), 1.0F);
}

TEST(Emission, WithoutRadianceThereIsNone) {
  test::Random random(41);
  Lamp dark(quadric(Shape::Kind::sphere, 1.0F), {Mat4(1.0F)});
  dark.light = make_area_light(*dark.world, 0, Rgb(0.0F), false);
  EXPECT_FALSE(emitted(*dark.light, 0.0F, random));
  EXPECT_FALSE(emitted(*make_point_light({1, 1, 1}, Rgb(0.0F)), 0.0F, random));
}

}  // namespace
}  // namespace hyades::core
