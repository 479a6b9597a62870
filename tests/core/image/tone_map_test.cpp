#include "core/image/tone_map.h"

#include <gtest/gtest.h>

#include <limits>
#include <string>

#include "core/base/color.h"

namespace hyades::core {
namespace {

/// Those that work channel by channel.
constexpr ToneCurve kAll[] = {ToneCurve::srgb, ToneCurve::filmic, ToneCurve::aces,
                              ToneCurve::linear};

TEST(ToneMap, NamesFindTheirCurves) {
  ASSERT_EQ(tone_curve_names().size(), 5U);
  EXPECT_EQ(find_tone_curve("srgb"), ToneCurve::srgb);
  EXPECT_EQ(find_tone_curve("filmic"), ToneCurve::filmic);
  EXPECT_EQ(find_tone_curve("aces"), ToneCurve::aces);
  EXPECT_EQ(find_tone_curve("agx"), ToneCurve::agx);
  EXPECT_EQ(find_tone_curve("linear"), ToneCurve::linear);
  EXPECT_EQ(find_tone_curve("reinhard"), std::nullopt);
}

TEST(ToneMap, KnownValues) {
  EXPECT_NEAR(tone_map(Rgb(0.18F), ToneCurve::srgb, 0.0F).x, 0.46136F, 1e-5F);
  EXPECT_EQ(tone_map(Rgb(0.25F), ToneCurve::linear, 1.0F).x, 0.5F);
  // Hable's white: 11.2 after his exposure bias of 2.
  EXPECT_NEAR(tone_map(Rgb(5.6F), ToneCurve::filmic, 0.0F).x, 1.0F, 1e-5F);
  // By hand: hable(0.36) = 0.0930666, hable(11.2) = 0.7251...
  EXPECT_NEAR(srgb_decode(tone_map(Rgb(0.18F), ToneCurve::filmic, 0.0F).y), 0.12836F, 2e-4F);
  // By hand: 0.18 * 0.4818 / (0.18 * 1.0274 + 0.14).
  EXPECT_NEAR(srgb_decode(tone_map(Rgb(0.18F), ToneCurve::aces, 0.0F).z), 0.26690F, 1e-4F);
}

TEST(ToneMap, ExposureCountsStops) {
  for (const ToneCurve curve : kAll) {
    EXPECT_FLOAT_EQ(tone_map(Rgb(0.1F), curve, 2.0F).x, tone_map(Rgb(0.4F), curve, 0.0F).x);
    EXPECT_FLOAT_EQ(tone_map(Rgb(0.1F), curve, -1.0F).x, tone_map(Rgb(0.05F), curve, 0.0F).x);
  }
}

TEST(ToneMap, RisesFromBlackToWhite) {
  for (const ToneCurve curve : kAll) {
    EXPECT_NEAR(tone_map(Rgb(0.0F), curve, 0.0F).x, 0.0F, 1e-6F);
    float last = 0.0F;
    for (float x = 1e-4F; x < 100.0F; x *= 1.05F) {
      const float value = tone_map(Rgb(x), curve, 0.0F).x;
      EXPECT_GE(value, last) << x;
      EXPECT_LE(value, 1.0F);
      last = value;
    }
    EXPECT_EQ(last, 1.0F);
  }
}

TEST(ToneMap, AgxKeepsGreysAndFadesBrightColours) {
  float last = 0.0F;
  for (float x = 1e-3F; x < 100.0F; x *= 1.05F) {
    const Rgb grey = tone_map(Rgb(x), ToneCurve::agx, 0.0F);
    EXPECT_NEAR(grey.x, grey.y, 2e-3F) << x;
    EXPECT_NEAR(grey.z, grey.y, 2e-3F) << x;
    EXPECT_GE(grey.y, last - 1e-3F) << x;
    last = grey.y;
  }
  EXPECT_GT(last, 0.99F);
  // By hand: (log2(0.18) + 12.47393) / 16.5 = 0.60608, of which the sigmoid is 0.4968.
  EXPECT_NEAR(tone_map(Rgb(0.18F), ToneCurve::agx, 0.0F).y, 0.4968F, 1e-3F);
  EXPECT_NEAR(tone_map(Rgb(0.0F), ToneCurve::agx, 0.0F).y, 0.0F, 1e-6F);
  // A dim blue is blue, one of a thousand times the light nearly white.
  const Rgb dim = tone_map(Rgb(0.01F, 0.01F, 0.3F), ToneCurve::agx, 0.0F);
  const Rgb bright = tone_map(Rgb(0.01F, 0.01F, 0.3F), ToneCurve::agx, 12.0F);
  EXPECT_GT(dim.z - dim.x, 0.25F);
  EXPECT_LT(bright.z - bright.x, 0.1F);
  EXPECT_GT(bright.x, 0.85F);
}

TEST(ToneMap, OddValuesStayInRange) {
  const float nan = std::numeric_limits<float>::quiet_NaN();
  const float inf = std::numeric_limits<float>::infinity();
  for (const ToneCurve curve : kAll) {
    const Rgb odd = tone_map(Rgb(nan, inf, -inf), curve, 0.0F);
    EXPECT_NEAR(odd.x, 0.0F, 1e-6F);
    EXPECT_EQ(odd.y, 1.0F);
    EXPECT_NEAR(odd.z, 0.0F, 1e-6F);
    EXPECT_NEAR(tone_map(Rgb(-1.0F), curve, 0.0F).x, 0.0F, 1e-6F);
    EXPECT_EQ(tone_map(Rgb(1.0F), curve, 1000.0F).x, 1.0F);
  }
  const Rgb odd = tone_map(Rgb(nan, inf, -inf), ToneCurve::agx, 0.0F);
  for (int c = 0; c < 3; ++c) {
    EXPECT_GE(odd[c], 0.0F);
    EXPECT_LE(odd[c], 1.0F);
  }
}

}  // namespace
}  // namespace hyades::core
