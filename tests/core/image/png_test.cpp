#include <gtest/gtest.h>
#include <png.h>

#include <cmath>
#include <filesystem>
#include <limits>
#include <string>
#include <vector>

#include "core/base/color.h"
#include "core/image/read_image.h"
#include "core/image/write_image.h"
#include "tests/core/image/image_tools.h"
#include "tests/support/shared_assets.h"
#include "tests/support/temp_folder.h"

namespace hyades::core {
namespace {

using test::exact_bytes;
using test::TempFolder;

void append_bytes(png_structp png, png_bytep bytes, size_t count) {
  static_cast<std::string*>(png_get_io_ptr(png))->append(reinterpret_cast<char*>(bytes), count);
}

struct PngSpec {
  int color = PNG_COLOR_TYPE_RGB;
  int bits = 8;
  bool interlaced = false;
  std::vector<png_color> palette{};
  std::vector<png_byte> palette_alpha{};
};

/// A PNG of any kind from packed rows.
std::string make_png(const PngSpec& spec, png_uint_32 width, const std::vector<std::string>& rows) {
  std::string file;
  png_structp png = png_create_write_struct(PNG_LIBPNG_VER_STRING, nullptr, nullptr, nullptr);
  png_infop info = png_create_info_struct(png);
  png_set_write_fn(png, &file, append_bytes, nullptr);
  png_set_IHDR(png, info, width, static_cast<png_uint_32>(rows.size()), spec.bits, spec.color,
               spec.interlaced ? PNG_INTERLACE_ADAM7 : PNG_INTERLACE_NONE,
               PNG_COMPRESSION_TYPE_DEFAULT, PNG_FILTER_TYPE_DEFAULT);
  if (!spec.palette.empty()) {
    png_set_PLTE(png, info, spec.palette.data(), static_cast<int>(spec.palette.size()));
  }
  if (!spec.palette_alpha.empty()) {
    png_set_tRNS(png, info, spec.palette_alpha.data(), static_cast<int>(spec.palette_alpha.size()),
                 nullptr);
  }
  png_write_info(png, info);
  std::vector<png_bytep> pointers;
  for (const auto& row : rows) {
    pointers.push_back(const_cast<png_bytep>(reinterpret_cast<png_const_bytep>(row.data())));
  }
  png_write_image(png, pointers.data());
  png_write_end(png, info);
  png_destroy_write_struct(&png, &info);
  return file;
}

Image must_read(const std::string& file, ColorSpace space = ColorSpace::automatic) {
  Result<Image> image = read_image(exact_bytes(file), "test.png", space);
  EXPECT_TRUE(image) << image.error().message;
  return image ? std::move(image).value() : Image{};
}

TEST(Png, EightBitColourIsSrgb) {
  const std::string file = make_png({}, 2, {std::string("\x00\x80\xFF\x0A\x01\xFE", 6)});
  const Image image = must_read(file);
  EXPECT_EQ(image.channels, (std::vector<std::string>{"R", "G", "B"}));
  EXPECT_EQ(image.data[0], 0.0F);
  EXPECT_NEAR(image.data[1], 0.2158605F, 1e-6F);
  EXPECT_EQ(image.data[2], 1.0F);
  EXPECT_NEAR(image.data[3], 0.0030353F, 1e-7F);
  const Image linear = must_read(file, ColorSpace::linear);
  EXPECT_FLOAT_EQ(linear.data[1], 128.0F / 255.0F);
}

TEST(Png, SixteenBitsKeepTheirPrecision) {
  // 0x1234, 0x8000, 0xFFFF: most significant byte first.
  const PngSpec spec{.color = PNG_COLOR_TYPE_RGB, .bits = 16};
  const std::string file = make_png(spec, 1, {std::string("\x12\x34\x80\x00\xFF\xFF", 6)});
  const Image linear = must_read(file, ColorSpace::linear);
  EXPECT_FLOAT_EQ(linear.data[0], 4660.0F / 65535.0F);
  EXPECT_FLOAT_EQ(linear.data[1], 32768.0F / 65535.0F);
  EXPECT_EQ(linear.data[2], 1.0F);
  EXPECT_FLOAT_EQ(must_read(file).data[1], srgb_decode(32768.0F / 65535.0F));
}

TEST(Png, FewBitsOfGreyFillTheRange) {
  const std::vector<std::pair<int, std::string>> cases{
      {1, "\xA0"}, {2, "\x1B"}, {4, std::string("\x0F\x50", 2)}};
  const std::vector<std::vector<float>> expected{
      {1.0F, 0.0F, 1.0F}, {0.0F, 1.0F / 3.0F, 2.0F / 3.0F, 1.0F}, {0.0F, 1.0F, 1.0F / 3.0F}};
  for (size_t i = 0; i < cases.size(); ++i) {
    const PngSpec spec{.color = PNG_COLOR_TYPE_GRAY, .bits = cases[i].first};
    const auto width = static_cast<png_uint_32>(expected[i].size());
    const Image image = must_read(make_png(spec, width, {cases[i].second}), ColorSpace::linear);
    EXPECT_EQ(image.channels, std::vector<std::string>{"Y"});
    ASSERT_EQ(image.data.size(), expected[i].size());
    for (size_t x = 0; x < expected[i].size(); ++x) EXPECT_FLOAT_EQ(image.data[x], expected[i][x]);
  }
}

TEST(Png, AlphaStaysStraightAndLinear) {
  const PngSpec grey{.color = PNG_COLOR_TYPE_GRAY_ALPHA};
  const Image a = must_read(make_png(grey, 1, {"\x80\x80"}));
  EXPECT_EQ(a.channels, (std::vector<std::string>{"Y", "A"}));
  EXPECT_NEAR(a.data[0], 0.2158605F, 1e-6F);
  EXPECT_FLOAT_EQ(a.data[1], 128.0F / 255.0F);
  const PngSpec color{.color = PNG_COLOR_TYPE_RGB_ALPHA};
  const Image b = must_read(make_png(color, 1, {"\xFF\x80\x80\x80"}));
  EXPECT_EQ(b.channels, (std::vector<std::string>{"R", "G", "B", "A"}));
  EXPECT_EQ(b.data[0], 1.0F);
  EXPECT_FLOAT_EQ(b.data[3], 128.0F / 255.0F);
}

TEST(Png, PalettesWithAndWithoutTransparency) {
  PngSpec spec{.color = PNG_COLOR_TYPE_PALETTE, .bits = 2};
  spec.palette = {{0, 0, 0}, {255, 0, 0}, {0, 128, 0}};
  const std::string row = "\x18";  // entries 0, 1, 2
  const Image opaque = must_read(make_png(spec, 3, {row}), ColorSpace::linear);
  EXPECT_EQ(opaque.channels.size(), 3U);
  EXPECT_EQ(opaque.at(1, 0, 0), 1.0F);
  EXPECT_FLOAT_EQ(opaque.at(2, 0, 1), 128.0F / 255.0F);
  spec.palette_alpha = {0, 51};
  const Image clear = must_read(make_png(spec, 3, {row}), ColorSpace::linear);
  EXPECT_EQ(clear.channels.size(), 4U);
  EXPECT_EQ(clear.at(0, 0, 3), 0.0F);
  EXPECT_FLOAT_EQ(clear.at(1, 0, 3), 0.2F);
  EXPECT_EQ(clear.at(2, 0, 3), 1.0F);
}

TEST(Png, InterlacedEqualsPlain) {
  std::vector<std::string> rows;
  for (int y = 0; y < 13; ++y) {
    rows.emplace_back();
    for (int x = 0; x < 11 * 3; ++x) rows.back().push_back(static_cast<char>(x * 7 + y * 31));
  }
  const Image plain = must_read(make_png({}, 11, rows));
  const Image interlaced = must_read(make_png({.interlaced = true}, 11, rows));
  EXPECT_EQ(plain.data, interlaced.data);
}

TEST(Png, RoundTripOfEveryCode) {
  const TempFolder folder;
  const std::string path = folder.file("a.png");
  Image image = make_image(256, 2, {"R", "G", "B", "A"});
  for (int x = 0; x < 256; ++x) {
    const float value = static_cast<float>(x) / 255.0F;
    for (int c = 0; c < 4; ++c) {
      image.at(x, 0, c) = value;
      image.at(x, 1, c) = value + (x % 2 == 0 ? 0.49F : -0.49F) / 255.0F;  // rounds to the same
    }
  }
  ASSERT_TRUE(write_png(path, image, {{"Software", "Hyades"}, {"Title", "d\u00e4mmerung"}}));
  const Result<Image> back = read_image_file(path, ColorSpace::linear);
  ASSERT_TRUE(back) << back.error().message;
  for (int y = 0; y < 2; ++y) {
    for (int x = 0; x < 256; ++x) {
      for (int c = 0; c < 4; ++c) EXPECT_FLOAT_EQ(back->at(x, y, c), image.at(x, 0, c));
    }
  }
  const std::string file = test::file_contents(path);
  EXPECT_NE(file.find(std::string("tEXtSoftware\0Hyades", 19)), std::string::npos);
  EXPECT_NE(file.find("iTXtTitle"), std::string::npos);
  EXPECT_NE(file.find("sRGB"), std::string::npos);
}

TEST(Png, ClampsAndSurvivesOddValues) {
  const TempFolder folder;
  const std::string path = folder.file("a.png");
  Image image = make_image(4, 1, {"Y"});
  image.data = {-3.0F, 7.0F, std::numeric_limits<float>::quiet_NaN(),
                std::numeric_limits<float>::infinity()};
  ASSERT_TRUE(write_png(path, image));
  const Result<Image> back = read_image_file(path);
  ASSERT_TRUE(back) << back.error().message;
  EXPECT_EQ(back->data, (std::vector<float>{0.0F, 1.0F, 0.0F, 1.0F}));
}

TEST(Png, RefusesWhatCannotBeWritten) {
  const TempFolder folder;
  const std::string path = folder.file("a.png");
  EXPECT_FALSE(write_png(path, Image{}));
  EXPECT_FALSE(write_png(path, make_image(2, 2, {"depth.Z"})));
  EXPECT_FALSE(write_png(path, make_image(2, 2, {"R", "G"})));
  EXPECT_FALSE(write_png(path, make_image(2, 2, {"Y"}), {{std::string(80, 'x'), "v"}}));
  EXPECT_FALSE(write_png(path, make_image(2, 2, {"Y"}), {{"", "v"}}));
  EXPECT_FALSE(std::filesystem::exists(path));
}

TEST(Png, ABombIsRefusedBeforeMemoryIsTaken) {
  // A valid header that claims 60,000 x 6,000 pixels, with next to no data behind it.
  std::string file = make_png({}, 1, {std::string("\1\2\3", 3)});
  const std::string size("\x00\x00\xEA\x60\x00\x00\x17\x70", 8);
  file.replace(16, 8, size);
  const uint32_t crc = test::png_crc(std::string_view(file).substr(12, 17));
  for (size_t i = 0; i < 4; ++i) file[29 + i] = static_cast<char>(crc >> (24 - 8 * i));
  const Result<Image> image = read_image(exact_bytes(file), "bomb.png");
  ASSERT_FALSE(image);
  EXPECT_EQ(image.error().message, "bomb.png: PNG: the file is truncated");
}

TEST(Png, ReadsTheRealWorld) {
  const std::string path = test::shared_file("assets/textures/earth-topology.png");
  HYADES_SKIP_WITHOUT(path);
  const Result<Image> image = read_image_file(path);
  ASSERT_TRUE(image) << image.error().message;
  EXPECT_GT(image->width, 100);
}

}  // namespace
}  // namespace hyades::core
