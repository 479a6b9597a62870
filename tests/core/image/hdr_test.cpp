#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include "core/image/read_image.h"
#include "tests/core/image/image_tools.h"
#include "tests/support/shared_assets.h"

namespace hyades::core {
namespace {

using test::exact_bytes;

const std::string kHeader = "#?RADIANCE\n# made by a test\nFORMAT=32-bit_rle_rgbe\n";

Result<Image> read_hdr(const std::string& file) {
  return read_image(exact_bytes(file), "test.hdr");
}

std::string hdr_error(const std::string& file) {
  const Result<Image> image = read_hdr(file);
  return image ? "no error" : image.error().message;
}

TEST(Hdr, FlatPixels) {
  const std::string file = kHeader + "\n-Y 2 +X 2\n" +
                           std::string(
                               "\x80\x40\x20\x80"
                               "\x80\x80\x80\x81"
                               "\xFF\x00\x00\x00"
                               "\x80\x00\x00\xFF",
                               16);
  const Result<Image> image = read_hdr(file);
  ASSERT_TRUE(image) << image.error().message;
  EXPECT_EQ(image->channels, (std::vector<std::string>{"R", "G", "B"}));
  EXPECT_EQ(image->at(0, 0, 0), 0.5F);  // 128 * 2^(128 - 136)
  EXPECT_EQ(image->at(0, 0, 1), 0.25F);
  EXPECT_EQ(image->at(0, 0, 2), 0.125F);
  EXPECT_EQ(image->at(1, 0, 0), 1.0F);
  EXPECT_EQ(image->at(0, 1, 0), 0.0F);  // exponent 0 is black
  EXPECT_EQ(image->at(1, 1, 0), std::ldexp(128.0F, 119));
}

TEST(Hdr, OldRuns) {
  // A pixel, repeated 2 times, then another one repeated 0x101 = 1 + (1 << 8) times.
  const std::string file = kHeader + "\n-Y 1 +X 261\n" +
                           std::string(
                               "\x80\x00\x00\x81"
                               "\x01\x01\x01\x02"
                               "\x00\x80\x00\x81"
                               "\x01\x01\x01\x01"
                               "\x01\x01\x01\x01",
                               20);
  const Result<Image> image = read_hdr(file);
  ASSERT_TRUE(image) << image.error().message;
  EXPECT_EQ(image->at(2, 0, 0), 1.0F);
  EXPECT_EQ(image->at(3, 0, 0), 0.0F);
  EXPECT_EQ(image->at(260, 0, 1), 1.0F);
  EXPECT_NE(hdr_error(kHeader + "\n-Y 1 +X 2\n" +
                      std::string("\x01\x01\x01\x02"
                                  "\0\0\0\0",
                                  8))
                .find("damaged"),
            std::string::npos);  // nothing there to repeat
}

TEST(Hdr, NewRuns) {
  // Width 10: red a run of 10, green 10 literals, blue 4 + 6, exponent a run.
  std::string row("\x02\x02\x00\x0A", 4);
  row += std::string("\x8A\x80", 2);
  row += std::string("\x0A\x00\x01\x02\x03\x04\x05\x06\x07\x08\x09", 11);
  row += std::string("\x84\x10\x06\x01\x02\x03\x04\x05\x06", 9);
  row += std::string("\x8A\x88", 2);
  const Result<Image> image = read_hdr(kHeader + "\n-Y 2 +X 10\n" + row + row);
  ASSERT_TRUE(image) << image.error().message;
  for (int y = 0; y < 2; ++y) {
    for (int x = 0; x < 10; ++x) {
      EXPECT_EQ(image->at(x, y, 0), 128.0F);
      EXPECT_EQ(image->at(x, y, 1), static_cast<float>(x));
      EXPECT_EQ(image->at(x, y, 2), x < 4 ? 16.0F : static_cast<float>(x - 3));
    }
  }
  std::string too_long = row;
  too_long[4] = '\x8B';
  EXPECT_EQ(hdr_error(kHeader + "\n-Y 2 +X 10\n" + row + too_long),
            "test.hdr: Radiance HDR: row 2 of 2 is damaged or missing");
}

TEST(Hdr, DirectionsAndExposure) {
  const std::string pixels(
      "\x80\x00\x00\x81"
      "\x40\x00\x00\x81"
      "\x20\x00\x00\x81"
      "\x10\x00\x00\x81",
      16);
  const Result<Image> flipped =
      read_hdr(kHeader + "EXPOSURE=4\nEXPOSURE= 0.5\n\n+Y 2 -X 2\n" + pixels);
  ASSERT_TRUE(flipped) << flipped.error().message;
  EXPECT_EQ(flipped->at(1, 1, 0), 0.5F);  // the file's first pixel; 1 / (4 * 0.5)
  EXPECT_EQ(flipped->at(0, 1, 0), 0.25F);
  EXPECT_EQ(flipped->at(1, 0, 0), 0.125F);
  EXPECT_NE(hdr_error(kHeader + "\n+X 2 +Y 2\n" + pixels).find("columns"), std::string::npos);
  EXPECT_NE(hdr_error(kHeader + "EXPOSURE=0\n\n-Y 2 +X 2\n" + pixels).find("EXPOSURE"),
            std::string::npos);
}

TEST(Hdr, DamagedHeaders) {
  EXPECT_NE(hdr_error("#?RADIANCE\nFORMAT=32-bit_rle_xyze\n\n-Y 1 +X 1\n0000").find("xyze"),
            std::string::npos);
  EXPECT_NE(hdr_error(kHeader + "\nsize 3\n").find("picture size"), std::string::npos);
  EXPECT_NE(hdr_error(kHeader + "\n-Y 0 +X 5\n").find("empty"), std::string::npos);
  EXPECT_NE(hdr_error(kHeader + "\n-Y 99999999999999999999 +X 5\n").find("picture size"),
            std::string::npos);
  EXPECT_NE(hdr_error(kHeader + "\n-Y 60000 +X 6000\n0000").find("truncated"), std::string::npos);
  EXPECT_NE(hdr_error(kHeader + std::string(5000, 'x')).find("truncated"), std::string::npos);
}

TEST(Hdr, ReadsTheRealWorld) {
  for (const char* name : {"kloppenheim_05_1k", "venice_sunset_1k", "studio_small_03_1k"}) {
    const std::string path = test::shared_file(std::string("assets/hdri/") + name + ".hdr");
    HYADES_SKIP_WITHOUT(path);
    const Result<Image> image = read_image_file(path);
    ASSERT_TRUE(image) << image.error().message;
    EXPECT_EQ(image->width, 1024);
    EXPECT_EQ(image->height, 512);
    const float peak = *std::max_element(image->data.begin(), image->data.end());
    if (std::string(name) == "kloppenheim_05_1k") {
      EXPECT_NEAR(peak, 83000.0F, 2000.0F);
    }
  }
}

}  // namespace
}  // namespace hyades::core
