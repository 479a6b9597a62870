#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include "core/image/read_image.h"
#include "tests/core/image/image_tools.h"

namespace hyades::core {
namespace {

using test::exact_bytes;

constexpr double kPi = 3.14159265358979323846;
/// What a candela becomes.
constexpr double kShare = 4.0 * kPi / 177.83;

const std::string kFirst = "IESNA:LM-63-2002\r\n[TEST] by a test\r\nTILT=NONE\r\n";

Result<Image> read_ies(const std::string& file) {
  return read_image(exact_bytes(file), "lamp.ies");
}

/// The candela at angles in degrees: up from straight down, and around.
double candela(const Image& image, double up, double around) {
  const double u = std::fmod(540.0 - around, 360.0) / 360.0;
  const auto x = static_cast<int>(u * image.width) % image.width;
  const auto y = std::min(static_cast<int>((1.0 - up / 180.0) * image.height), image.height - 1);
  return image.at(x, y, 0) / kShare;
}

std::string ies_error(const std::string& file) {
  const Result<Image> image = read_ies(file);
  return image ? "no error" : image.error().message;
}

TEST(Ies, IsTheSameAllAroundWhereItHasOneAngle) {
  // Multiplier 2, ballast factor 0.5, and 3 of the last factor.
  const auto image = read_ies(kFirst + "1 1000 2 3 1 1 2 0 0 0\n0.5 3 40\n0 45 90\n0\n100 60 20\n");
  ASSERT_TRUE(image) << image.error().message;
  EXPECT_EQ(image->channels, (std::vector<std::string>{"Y"}));
  EXPECT_EQ(image->width, 2 * image->height);
  for (const double around : {10.0, 100.0, 250.0, 350.0}) {
    EXPECT_NEAR(candela(*image, 0.25, around), 3 * (100 - 40 * 0.25 / 45), 1e-3);
    EXPECT_NEAR(candela(*image, 45.25, around), 3 * (60 - 40 * 0.25 / 45), 1e-3);
    EXPECT_EQ(candela(*image, 91, around), 0.0) << "what was not measured is dark";
  }
}

TEST(Ies, AngleAround) {
  const auto image = read_ies(kFirst +
                              "1 -1 1 2 5 1 1 0 0 0 1 1 0\n0 180\n0 90 180 270 360\n"
                              "1 1 2 2 3 3 4 4 1 1\n");
  ASSERT_TRUE(image) << image.error().message;
  EXPECT_NEAR(candela(*image, 90, 0.25), 1 + 0.25 / 90, 1e-4);
  EXPECT_NEAR(candela(*image, 90, 90.25), 2 + 0.25 / 90, 1e-4);
  EXPECT_NEAR(candela(*image, 90, 180.25), 3 + 0.25 / 90, 1e-4);
  EXPECT_NEAR(candela(*image, 90, 315.25), 4 - 3 * 45.25 / 90, 1e-4);
  // As of EnvironmentMap: 90 degrees lie towards -z, a quarter from the left.
  EXPECT_NEAR(image->at(image->width / 4, image->height / 2, 0), 2 * kShare, 0.01 * kShare);
}

TEST(Ies, SidesThatAreAlike) {
  const std::string head = "1 -1 1 2 3 1 1 0 0 0 1 1 0 0 180 ";
  const auto quarter = read_ies(kFirst + head + "0 45 90  1 1 2 2 5 5");
  ASSERT_TRUE(quarter) << quarter.error().message;
  for (const double around : {45.25, 134.75, 225.25, 314.75}) {
    EXPECT_NEAR(candela(*quarter, 90, around), 2 + 3 * 0.25 / 45, 1e-4) << around;
  }
  const auto half = read_ies(kFirst + head + "0 90 180  1 1 2 2 5 5");
  ASSERT_TRUE(half) << half.error().message;
  EXPECT_NEAR(candela(*half, 90, 120.25), 2 + 30.25 / 30, 1e-4);
  EXPECT_NEAR(candela(*half, 90, 239.75), 2 + 30.25 / 30, 1e-4);
  const auto other_half = read_ies(kFirst + head + "90 180 270  1 1 2 2 5 5");
  ASSERT_TRUE(other_half) << other_half.error().message;
  EXPECT_NEAR(candela(*other_half, 90, 200.25), 2 + 20.25 / 30, 1e-4);
  EXPECT_NEAR(candela(*other_half, 90, 339.75), 2 + 20.25 / 30, 1e-4);
}

TEST(Ies, TiltIsPassedOver) {
  const auto image = read_ies(
      "IESNA91\nTILT=INCLUDE\n1\n3\n0 30 60\n1, .9, .8\n1 -1 1 2 1 1 1 0 0 0 1 1 0\n0 180\n0\n7 "
      "7\n");
  ASSERT_TRUE(image) << image.error().message;
  EXPECT_NEAR(candela(*image, 90, 10), 7, 1e-4);
}

TEST(Ies, Damage) {
  const std::string head = "1 -1 1 2 1 1 1 0 0 0 1 1 0 ";
  EXPECT_NE(ies_error("IESNA91\n1 2 3").find("no line TILT="), std::string::npos);
  EXPECT_NE(ies_error("IESNA91\nTILT=lamp.tlt\n").find("TILT=lamp.tlt is not read"),
            std::string::npos);
  EXPECT_NE(ies_error(kFirst + "1 2 3").find("13 numbers"), std::string::npos);
  EXPECT_NE(ies_error(kFirst + head + "0 180 0 7").find("truncated"), std::string::npos);
  EXPECT_NE(ies_error(kFirst + head + "0 x 0 7 7").find("no number"), std::string::npos);
  EXPECT_NE(ies_error(kFirst + head + "180 0 0 7 7").find("vertical angles"), std::string::npos);
  EXPECT_NE(ies_error(kFirst + "1 -1 1 1 2 1 1 0 0 0 1 1 0 0 0 100 7 7").find("horizontal angles"),
            std::string::npos);
  EXPECT_NE(ies_error(kFirst + "1 -1 1 2 1 2 1 0 0 0 1 1 0 0 90 0 7 7").find("type 1 (C)"),
            std::string::npos);
  EXPECT_NE(ies_error(kFirst + "1 -1 1 9999 9999 1 1 0 0 0 1 1 0").find("a million"),
            std::string::npos);
  EXPECT_NE(ies_error(kFirst + "1 -1 1e305 2 1 1 1 0 0 0 1 1 0 0 90 0 7 7").find("too large"),
            std::string::npos);
}

}  // namespace
}  // namespace hyades::core
