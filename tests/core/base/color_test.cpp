#include "core/base/color.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

namespace hyades::core {
namespace {

TEST(Color, SrgbKnownValues) {
  EXPECT_EQ(srgb_decode(0.0F), 0.0F);
  EXPECT_EQ(srgb_decode(1.0F), 1.0F);
  EXPECT_EQ(srgb_encode(1.0F), 1.0F);
  EXPECT_NEAR(srgb_decode(128.0F / 255.0F), 0.2158605F, 1e-6F);
  EXPECT_NEAR(srgb_decode(10.0F / 255.0F), 0.0030353F, 1e-6F);
  EXPECT_NEAR(srgb_encode(0.18F), 0.4613561F, 1e-6F);
  EXPECT_NEAR(srgb_encode(0.0031308F), 0.04045F, 1e-5F);
  EXPECT_FLOAT_EQ(srgb_encode(-0.5F), -srgb_encode(0.5F));
  for (int i = 0; i <= 1000; ++i) {
    const float x = static_cast<float>(i) / 500.0F;
    EXPECT_NEAR(srgb_encode(srgb_decode(x)), x, 2e-6F) << x;
  }
  for (int i = 1; i <= 65535; ++i) {  // increasing
    EXPECT_GT(srgb_decode(static_cast<float>(i) / 65535.0F),
              srgb_decode(static_cast<float>(i - 1) / 65535.0F));
  }
}

// Chromaticities of the Planckian locus, CIE 15:2004 (illuminant A: x = 0.44758, y = 0.40745) and
// Wyszecki & Stiles, table 1(3.11). The analytic observer is good to about 0.01.
TEST(Color, BlackbodyChromaticity) {
  const struct {
    float kelvin, x, y;
  } known[] = {{2856.0F, 0.4476F, 0.4075F},
               {4000.0F, 0.3805F, 0.3768F},
               {6500.0F, 0.3135F, 0.3237F},
               {10000.0F, 0.2807F, 0.2884F}};
  for (const auto& k : known) {
    const Rgb c = blackbody_color(k.kelvin);
    EXPECT_NEAR(luminance(c), 1.0F, 1e-5F);
    const double big_x = 0.4124 * c.x + 0.3576 * c.y + 0.1805 * c.z;
    const double big_y = 0.2126 * c.x + 0.7152 * c.y + 0.0722 * c.z;
    const double big_z = 0.0193 * c.x + 0.1192 * c.y + 0.9505 * c.z;
    const double sum = big_x + big_y + big_z;
    EXPECT_NEAR(big_x / sum, k.x, 0.006) << k.kelvin;
    EXPECT_NEAR(big_y / sum, k.y, 0.006) << k.kelvin;
  }
}

TEST(Color, BlackbodyAnyTemperature) {
  float last_ratio = 0.0F;
  for (const float kelvin :
       {-5.0F, 0.0F, 500.0F, 1000.0F, 1900.0F, 3200.0F, 6500.0F, 2e4F, 1e5F, 1e30F}) {
    const Rgb c = blackbody_color(kelvin);
    EXPECT_TRUE(std::isfinite(c.x) && std::isfinite(c.y) && std::isfinite(c.z)) << kelvin;
    EXPECT_GE(min_component(c), 0.0F);
    EXPECT_NEAR(luminance(c), 1.0F, 1e-5F);
    EXPECT_GE(c.z / c.x, last_ratio) << kelvin;  // hotter is bluer
    last_ratio = c.z / c.x;
  }
  EXPECT_TRUE(std::isfinite(blackbody_color(std::numeric_limits<float>::quiet_NaN()).x));
}

TEST(Color, HexColors) {
  const Result<Rgb> tan = parse_hex_color("#d8c8a8");
  ASSERT_TRUE(tan);
  EXPECT_FLOAT_EQ(tan->x, srgb_decode(216.0F / 255.0F));
  EXPECT_FLOAT_EQ(tan->y, srgb_decode(200.0F / 255.0F));
  EXPECT_FLOAT_EQ(tan->z, srgb_decode(168.0F / 255.0F));
  EXPECT_EQ(*parse_hex_color("#0F8"), *parse_hex_color("#00ff88"));
  for (const char* wrong :
       {"", "d8c8a8", "#", "#12", "#12345", "#ggg", "#12345678", "#1234", "#12 456", "##12345"}) {
    EXPECT_FALSE(parse_hex_color(wrong)) << wrong;
  }
  EXPECT_NE(parse_hex_color("#12345678").error().message.find("alpha"), std::string::npos);
}

}  // namespace
}  // namespace hyades::core
