#include "core/lights/sky.h"

#include <gtest/gtest.h>

#include <cmath>

#include "core/base/elementary.h"
#include "core/lights/make_light.h"
#include "core/lights/sky_model.h"
#include "tests/core/lights/sky_checks.h"

namespace hyades::core {
namespace {

constexpr float kDegree = kPi / 180.0F;

Sky sky_of(float degrees, float turbidity = 3.0F) {
  SkySettings settings;
  settings.elevation = degrees * kDegree;
  settings.turbidity = turbidity;
  settings.ground_albedo = Rgb(0.2F);
  return make_sky(settings);
}

Vec3 towards(float elevation, float azimuth) {
  const SinCos e = sin_cos(elevation * kDegree);
  const SinCos a = sin_cos(azimuth * kDegree);
  return {e.cos * a.cos, e.sin, e.cos * a.sin};
}

Rgb seen(const Sky& sky, float elevation, float azimuth) {
  return sky.map->look_up(towards(elevation, azimuth), 0.0F);
}

/// Light of the sky on the ground, by the middles of small cells.
double sky_on_ground(const Sky& sky) {
  double sum = 0.0;
  for (int e = 0; e < 90; e += 2) {
    for (int a = 0; a < 360; a += 4) {
      const float elevation = static_cast<float>(e) + 1.0F;
      const float height = sin(elevation * kDegree);
      const double cell = static_cast<double>(cos(elevation * kDegree) * 8.0F * kDegree * kDegree);
      sum += static_cast<double>(luminance(seen(sky, elevation, static_cast<float>(a) + 2.0F)) *
                                 height) *
             cell;
    }
  }
  return sum;
}

TEST(SkyModel, LetsThroughWhatItsThicknessSays) {
  const SkyModel model(3.0F, Rgb(0.0F));
  // Vertical thickness: molecules, twice as much haze (turbidity 3), ozone (a triangle).
  const Rgb rayleigh = Rgb(5.802e-6F, 13.558e-6F, 33.1e-6F) * 8000.0F;
  const Rgb haze = Rgb(0.759F, 1.0F, 1.337F) * (2.0F * rayleigh.y);
  const Rgb ozone = Rgb(0.650e-6F, 1.881e-6F, 0.085e-6F) * 15e3F;
  const Rgb zenith = model.transmittance(1.0F);
  // Two relative air masses: Kasten & Young 1989 have 1.994 at 30 degrees.
  const Rgb half = model.transmittance(0.5F);
  for (int c = 0; c < 3; ++c) {
    const float thickness = rayleigh[c] + haze[c] + ozone[c];
    EXPECT_NEAR(-log(zenith[c]), thickness, 0.01F * thickness) << c;
    EXPECT_NEAR(-log(half[c]), 1.994F * thickness, 0.015F * thickness) << c;
  }
  EXPECT_EQ(model.transmittance(-0.1F), Rgb(0.0F));
}

/// Zenith luminance of the CIE's clear sky in units of the sun's irradiance above the air, as
/// Radiance's gensky has it [kcd/m^2], for a sun of 133 klx. (Preetham, Shirley & Smits 1999 have
/// 2.3 to 2.9 times what air and haze of these coefficients scatter.)
double cie_zenith(double turbidity, double elevation) {
  return ((1.376 * turbidity - 1.81) * std::tan(elevation) + 0.38) / 133.0;
}

TEST(Sky, HasTheZenithLuminanceThatIsPublished) {
  for (const float elevation : {15.0F, 30.0F, 45.0F}) {
    const double published = cie_zenith(3.0, static_cast<double>(elevation * kDegree));
    const double ours = static_cast<double>(luminance(seen(sky_of(elevation), 90.0F, 0.0F)));
    EXPECT_GT(ours / published, 0.85) << elevation;
    EXPECT_LT(ours / published, 1.35) << elevation;
  }
}

TEST(Sky, IsChosenAsItSays) {
  // A high sun, a low one in haze with its bright surroundings, and dusk.
  uint64_t seed = 43;
  for (const Vec2& sky : {Vec2(50, 2), Vec2(3, 6), Vec2(-3, 3)}) {
    SCOPED_TRACE(sky.x);
    const LightPtr light =
        make_environment_map_light(sky_of(sky.x, sky.y).map, 1.0F, Rgb(4.0F), 2.0F);
    expect_sampled_right(*light, ++seed);
  }
}

TEST(Sky, SharesLightWithTheSunAsOnClearDays) {
  // Of all light on the ground the sky's share is 10 to 20 % under a high sun, and grows towards
  // sunset.
  const auto share = [](float elevation) {
    const Sky sky = sky_of(elevation);
    const double sun = static_cast<double>(luminance(sky.sun) * sin(elevation * kDegree));
    const double around = sky_on_ground(sky);
    return around / (around + sun);
  };
  const double high = share(60.0F);
  EXPECT_GT(high, 0.08);
  EXPECT_LT(high, 0.25);
  EXPECT_GT(share(10.0F), 1.8 * high);
}

TEST(Sky, IsBlueAboveAndPaleBelow) {
  const Sky noon = sky_of(50.0F, 2.0F);
  const Rgb zenith = seen(noon, 90.0F, 0.0F);
  const Rgb low = seen(noon, 3.0F, 180.0F);
  EXPECT_GT(zenith.z, 1.8F * zenith.x);
  EXPECT_LT(low.z / low.x, 0.7F * zenith.z / zenith.x);
  EXPECT_GT(luminance(low), luminance(zenith));
}

TEST(Sky, ReddensTowardsSunset) {
  const Sky noon = sky_of(50.0F);
  const Sky evening = sky_of(2.0F);
  EXPECT_GT(evening.sun.x, 4.0F * evening.sun.z);
  EXPECT_LT(luminance(evening.sun), 0.3F * luminance(noon.sun));
  // Brighter, and redder, on the sun's side.
  const Rgb west = seen(evening, 2.0F, 10.0F);
  const Rgb east = seen(evening, 2.0F, 180.0F);
  EXPECT_GT(west.x, 3.0F * east.x);
  EXPECT_GT(west.x / west.z, 1.5F * east.x / east.z);
}

TEST(Sky, KeepsTwilightWhenTheSunHasSet) {
  const Sky dusk = sky_of(-4.0F);
  EXPECT_EQ(dusk.sun, Rgb(0.0F));
  EXPECT_GT(luminance(seen(dusk, 90.0F, 0.0F)), 0.0F);
  EXPECT_LT(luminance(seen(dusk, 90.0F, 0.0F)),
            0.05F * luminance(seen(sky_of(10.0F), 90.0F, 0.0F)));
  // Half the disc is left where its middle is on the horizon.
  SkySettings half;
  half.elevation = 0.0F;
  SkySettings whole;
  whole.elevation = 0.0F;
  whole.sun_radius = 0.0F;
  EXPECT_NEAR(make_sky(half).sun.x, 0.5F * make_sky(whole).sun.x, 1e-6F);
}

TEST(Sky, IsHazierWhereTurbidityIsHigh) {
  const Sky clear = sky_of(30.0F, 2.0F);
  const Sky hazy = sky_of(30.0F, 6.0F);
  EXPECT_LT(luminance(hazy.sun), 0.7F * luminance(clear.sun));
  EXPECT_GT(luminance(seen(hazy, 33.0F, 0.0F)), 2.0F * luminance(seen(clear, 33.0F, 0.0F)));
}

TEST(Sky, ShowsAGroundOfItsAlbedo) {
  const Sky sky = sky_of(60.0F, 1.0F);
  const Rgb below = seen(sky, -60.0F, 90.0F);
  const double light =
      static_cast<double>(luminance(sky.sun) * sin(60.0F * kDegree)) + sky_on_ground(sky);
  EXPECT_NEAR(static_cast<double>(luminance(below)), 0.2 * light / M_PI, 0.03 * 0.2 * light / M_PI);
}

}  // namespace
}  // namespace hyades::core
