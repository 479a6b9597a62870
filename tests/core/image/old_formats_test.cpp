#include <gtest/gtest.h>

#include <cstdlib>
#include <cstring>
#include <string>
#include <vector>

#include "core/base/color.h"
#include "core/image/read_image.h"
#include "core/image/write_image.h"
#include "tests/core/image/image_tools.h"
#include "tests/support/temp_folder.h"

// TGA, BMP, QOI, Netpbm and PFM: what files by hand say, and what ffmpeg writes.
namespace hyades::core {
namespace {

using test::exact_bytes;

Result<Image> read_old(const std::string& file, ColorSpace space = ColorSpace::linear) {
  return read_image(exact_bytes(file), "test", space);
}

std::string error_of_old(const std::string& file) {
  const Result<Image> image = read_old(file);
  return image ? "no error" : image.error().message;
}

bool has(const std::string& text, const std::string& part) {
  return text.find(part) != std::string::npos;
}

std::string word(int value) {
  return {static_cast<char>(value & 255), static_cast<char>(value >> 8 & 255)};
}

std::string number(uint32_t value) {
  return word(static_cast<int>(value & 0xFFFF)) + word(static_cast<int>(value >> 16));
}

/// The 18 bytes that a TGA file begins with.
std::string tga(int type, int width, int height, int bits, int descriptor,
                const std::string& palette = std::string("\0\0\0\0\0", 5)) {
  const char has_palette = palette[2] != 0 ? 1 : 0;
  return std::string(1, '\0') + has_palette + static_cast<char>(type) + palette + word(0) +
         word(0) + word(width) + word(height) + static_cast<char>(bits) +
         static_cast<char>(descriptor);
}

std::vector<float> values(const Result<Image>& image) {
  EXPECT_TRUE(image) << (image ? "" : image.error().message);
  return image ? image->data : std::vector<float>{};
}

TEST(Tga, RowsBeginBelowUnlessTheySayOtherwise) {
  // Blue first: a red pixel, then a blue one.
  const std::string pixels("\0\0\xFF\xFF\0\0", 6);
  const std::vector<float> red_first = {1, 0, 0, 0, 0, 1};
  const std::vector<float> blue_first = {0, 0, 1, 1, 0, 0};
  EXPECT_EQ(values(read_old(tga(2, 1, 2, 24, 0x00) + pixels)), blue_first);
  EXPECT_EQ(values(read_old(tga(2, 1, 2, 24, 0x20) + pixels)), red_first);
  EXPECT_EQ(values(read_old(tga(2, 2, 1, 24, 0x00) + pixels)), red_first);
  EXPECT_EQ(values(read_old(tga(2, 2, 1, 24, 0x10) + pixels)), blue_first);
}

TEST(Tga, RunsAndPixelsMayCrossRows) {
  // Three times 51, then 102 and 153 as they are, then once 255: two rows of three.
  const std::string packed("\x82\x33\x01\x66\x99\x80\xFF", 7);
  const Result<Image> image = read_old(tga(11, 3, 2, 8, 0x20) + packed);
  EXPECT_EQ(values(image), (std::vector<float>{0.2F, 0.2F, 0.2F, 0.4F, 0.6F, 1}));
  EXPECT_EQ(image->channels, std::vector<std::string>{"Y"});
  EXPECT_TRUE(has(error_of_old(tga(11, 3, 2, 8, 0x20) + packed.substr(0, 5)), "row 2 of 2"));
}

TEST(Tga, PalettesAndFiveBits) {
  // Two colours from place 7 on: 10 20 30 and 0 255 0, blue first.
  const std::string palette = word(7) + word(2) + "\x18";
  const std::string colors("\x1E\x14\x0A\0\xFF\0", 6);
  EXPECT_EQ(values(read_old(tga(1, 2, 1, 8, 0, palette) + colors + "\x08\x07")),
            (std::vector<float>{0, 1, 0, 10 / 255.0F, 20 / 255.0F, 30 / 255.0F}));
  EXPECT_TRUE(has(error_of_old(tga(1, 2, 1, 8, 0, palette) + colors + "\x08\x09"), "damaged"));
  EXPECT_TRUE(has(error_of_old(tga(1, 2, 1, 8, 0, palette) + colors + "\x08\x06"), "damaged"));
  EXPECT_EQ(values(read_old(tga(2, 1, 1, 16, 0) + word(31 << 10 | 0 << 5 | 31))),
            (std::vector<float>{1, 0, 1}));
}

TEST(Tga, AFourthByteThatIsZeroEverywhereMeansNothing) {
  const std::string clear("\0\0\xFF\0\0\0\xFF\0", 8);
  const std::string some("\0\0\xFF\0\0\0\xFF\x33", 8);
  EXPECT_EQ(values(read_old(tga(2, 2, 1, 32, 8) + clear)),
            (std::vector<float>{1, 0, 0, 1, 1, 0, 0, 1}));
  EXPECT_EQ(values(read_old(tga(2, 2, 1, 32, 8) + some)),
            (std::vector<float>{1, 0, 0, 0, 1, 0, 0, 0.2F}));
}

TEST(Tga, SizesAreCheckedBeforeMemoryIsTaken) {
  EXPECT_TRUE(has(error_of_old(tga(2, 65535, 600, 24, 0) + "abc"), "truncated"));
  EXPECT_TRUE(has(error_of_old(tga(10, 65535, 600, 24, 0) + "abc"), "truncated"));
  EXPECT_TRUE(has(error_of_old(tga(2, 0, 4, 24, 0)), "not a known picture"));
}

/// A bitmap of header BITMAPINFOHEADER, its masks or palette, and pixels.
std::string bmp(int width, int height, int bits, int packing, const std::string& tables,
                const std::string& pixels) {
  const auto begin = static_cast<uint32_t>(14 + 40 + tables.size());
  return "BM" + number(begin + static_cast<uint32_t>(pixels.size())) + number(0) + number(begin) +
         number(40) + number(static_cast<uint32_t>(width)) + number(static_cast<uint32_t>(height)) +
         word(1) + word(bits) + number(static_cast<uint32_t>(packing)) + number(0) + number(0) +
         number(0) + number(0) + number(0) + tables + pixels;
}

TEST(Bmp, PalettesBeginWithTheHighBits) {
  const std::string palette("\0\0\xFF\0\0\xFF\0\0", 8);  // red, green
  const std::string rows("\x80\0\0\0\x40\0\0\0", 8);     // green red; above it red green
  const Result<Image> image = read_old(bmp(2, 2, 1, 0, palette, rows));
  EXPECT_EQ(values(image), (std::vector<float>{1, 0, 0, 0, 1, 0, 0, 1, 0, 1, 0, 0}));
  const Result<Image> turned = read_old(bmp(2, -2, 1, 0, palette, rows));
  EXPECT_EQ(values(turned), (std::vector<float>{0, 1, 0, 1, 0, 0, 1, 0, 0, 0, 1, 0}));
}

TEST(Bmp, MasksSayWhatBitsMean) {
  const std::string masks = number(0xF800) + number(0x07E0) + number(0x001F);
  EXPECT_EQ(values(read_old(bmp(1, 1, 16, 3, masks, word(0xF81F) + word(0)))),
            (std::vector<float>{1, 0, 1}));
  const std::string gaps = number(0xF100) + number(0x07E0) + number(0x001F);
  EXPECT_TRUE(has(error_of_old(bmp(1, 1, 16, 3, gaps, word(0xF81F) + word(0))), "gaps"));
}

TEST(Bmp, AFourthByteThatIsZeroEverywhereMeansNothing) {
  const std::string clear("\0\0\xFF\0\0\0\xFF\0", 8);
  const std::string some("\0\0\xFF\0\0\0\xFF\x33", 8);
  EXPECT_EQ(values(read_old(bmp(2, 1, 32, 0, "", clear))),
            (std::vector<float>{1, 0, 0, 1, 1, 0, 0, 1}));
  EXPECT_EQ(values(read_old(bmp(2, 1, 32, 0, "", some))),
            (std::vector<float>{1, 0, 0, 0, 1, 0, 0, 0.2F}));
}

TEST(Bmp, RefusesWhatItCannotRead) {
  EXPECT_TRUE(has(error_of_old(bmp(1, 1, 8, 1, "", "abcd")), "packed"));
  EXPECT_TRUE(has(error_of_old(bmp(60000, 6000, 24, 0, "", "abcd")), "truncated"));
  EXPECT_TRUE(has(error_of_old(bmp(-5, 6, 24, 0, "", "abcd")), "empty"));
  EXPECT_TRUE(has(error_of_old("BM" + std::string(30, 'x')), "truncated"));
}

TEST(Netpbm, CommentsAndDeepCodes) {
  EXPECT_EQ(values(read_old("P6 # red\n1 1 # one\n255\n" + std::string("\xFF\0\0", 3))),
            (std::vector<float>{1, 0, 0}));
  EXPECT_EQ(values(read_old("P5\n1 2\n65535\n" + std::string("\x33\x33\xFF\xFF", 4))),
            (std::vector<float>{0.2F, 1}));
  EXPECT_EQ(values(read_old("P5 1 1 100\n2")), std::vector<float>{0.5F});
  EXPECT_TRUE(has(error_of_old("P5 9 1 100\n2"), "truncated"));
  EXPECT_TRUE(has(error_of_old("P5 60000 6000 100\n2"), "truncated"));
  EXPECT_TRUE(has(error_of_old("P5 9 nine 100\n2"), "damaged"));
  EXPECT_TRUE(has(error_of_old("P5 9 9 0\n2"), "largest code"));
}

TEST(Pfm, RowsBeginBelowInEitherOrderOfBytes) {
  const float numbers[2] = {0.25F, -3.0F};
  std::string little(8, '\0');
  std::memcpy(little.data(), numbers, 8);
  EXPECT_EQ(values(read_old("Pf 1 2 -1.0\n" + little)), (std::vector<float>{-3.0F, 0.25F}));
  EXPECT_EQ(values(read_old("Pf 1 2 -2.0\n" + little)), (std::vector<float>{-6.0F, 0.5F}));
  const std::string big("\x3E\x80\0\0\xC0\x40\0\0", 8);
  EXPECT_EQ(values(read_old("Pf 1 2 1.0\n" + big)), (std::vector<float>{-3.0F, 0.25F}));
  EXPECT_TRUE(has(error_of_old("PF 1 2 1.0\n" + big), "truncated"));
  EXPECT_TRUE(has(error_of_old("Pf 1 2 0\n" + big), "scale"));
}

TEST(Qoi, RefusesFilesThatEndTooSoon) {
  const auto file = [](int width, int height, const std::string& chunks) {
    return "qoif" + std::string(2, '\0') + static_cast<char>(width >> 8) +
           static_cast<char>(width & 255) + std::string(2, '\0') + static_cast<char>(height >> 8) +
           static_cast<char>(height & 255) + std::string("\x03\0", 2) + chunks;
  };
  EXPECT_EQ(values(read_old(file(2, 1, "\xFE\x33\x66\xFF\xC0"))),
            (std::vector<float>{0.2F, 0.4F, 1, 0.2F, 0.4F, 1}));
  EXPECT_TRUE(has(error_of_old(file(2, 2, "\xFE\x33\x66\xFF\xC0")), "row 2 of 2"));
  EXPECT_TRUE(has(error_of_old(file(20000, 20000, "\xC0")), "truncated"));
}

TEST(OldFormats, FilesOfFfmpegAreReadAsTheirPng) {
  test::TempFolder folder;
  Image image = test::hashed_image(37, 23, {"R", "G", "B", "A"});
  for (int y = 0; y < 23; ++y) {  // runs as well as noise
    for (int x = 5; x < 19; ++x) {
      for (int c = 0; c < 4; ++c) image.at(x, y, c) = 0.2F * static_cast<float>(c + 1);
    }
  }
  ASSERT_TRUE(write_png(folder.file("in.png"), image));
  struct Case {
    const char* file;
    const char* format;
    const char* extra;
  };
  const Case cases[] = {
      {"color.tga", "bgr24", ""}, {"alpha.tga", "bgra", ""},   {"plain.tga", "bgr24", "-rle 0"},
      {"grey.tga", "gray", ""},   {"color.bmp", "bgr24", ""},  {"alpha.bmp", "bgra", ""},
      {"color.ppm", "rgb24", ""}, {"deep.ppm", "rgb48be", ""}, {"grey.pgm", "gray", ""},
      {"color.qoi", "rgb24", ""}, {"alpha.qoi", "rgba", ""},
  };
  int read_cases = 0;
  for (const Case& one : cases) {
    SCOPED_TRACE(one.file);
    // What ffmpeg makes of these pixels without alpha and in grey is told by its own PNG of them.
    const std::string told = folder.file(std::string(one.file) + ".png");
    const std::string begin = "ffmpeg -v error -y -i '" + folder.file("in.png") + "' -pix_fmt ";
    std::string png_format = one.format;
    if (png_format == "bgr24") png_format = "rgb24";
    if (png_format == "bgra") png_format = "rgba";
    const std::string made = begin + one.format + " " + one.extra + " '" + folder.file(one.file) +
                             "' </dev/null >/dev/null 2>&1";
    const std::string twin = begin + png_format + " '" + told + "' </dev/null >/dev/null 2>&1";
    if (std::system(made.c_str()) != 0 || std::system(twin.c_str()) != 0) continue;
    const auto ours = read_image_file(folder.file(one.file));
    const auto expected = read_image_file(told);
    ASSERT_TRUE(ours) << ours.error().message;
    ASSERT_TRUE(expected) << expected.error().message;
    EXPECT_EQ(ours->channels, expected->channels);
    EXPECT_LE(test::largest_difference(*ours, *expected), 1e-6F);
    ++read_cases;
  }
  if (read_cases == 0) GTEST_SKIP() << "there is no ffmpeg";
}

}  // namespace
}  // namespace hyades::core
