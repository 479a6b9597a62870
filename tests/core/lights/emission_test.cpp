// T1 and T2 of where light paths begin: sample_emission, pdf_place, pdf_outward of every light.

#include <gtest/gtest.h>

#include <array>
#include <cmath>

#include "tests/core/lights/emission_checks.h"

namespace hyades::core {
namespace {

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
  dark.light = make_area_light(*dark.world, 0, {});
  EXPECT_FALSE(emitted(*dark.light, 0.0F, random));
  EXPECT_FALSE(emitted(*make_point_light({1, 1, 1}, Rgb(0.0F)), 0.0F, random));
}

}  // namespace
}  // namespace hyades::core
