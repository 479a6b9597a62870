#include <gtest/gtest.h>
#include <tiffio.h>

#include <cstring>
#include <string>
#include <vector>

#include "core/base/color.h"
#include "core/image/read_image.h"
#include "core/image/write_image.h"
#include "tests/core/image/image_tools.h"
#include "tests/support/temp_folder.h"

namespace hyades::core {
namespace {

using test::TempFolder;

struct Spec {
  int width = 37;
  int height = 21;
  int channels = 3;
  int bits = 8;
  int compression = COMPRESSION_LZW;
  int tile = 0;            ///< side [pixels]; 0: strips
  const char* mode = "w";  ///< "wb": big-endian, "w8": with 64-bit offsets
  bool premultiplied = false;
  int photometric = -1;
  int orientation = ORIENTATION_TOPLEFT;
  int planes = PLANARCONFIG_CONTIG;
};

/// The code (or, of 32 bits, the number) of a sample.
float code_of(const Spec& spec, int x, int y, int c) {
  const auto hash = mix64(static_cast<uint64_t>((y * spec.width + x) * spec.channels + c + 1));
  if (spec.bits == 32) return static_cast<float>(hash % 1000) / 100.0F;
  const bool alpha = spec.channels % 2 == 0 && c == spec.channels - 1;
  const auto all = (uint64_t{1} << static_cast<unsigned>(spec.bits)) - 1;
  // Of premultiplied pixels no colour is above alpha.
  if (spec.premultiplied) return static_cast<float>(alpha ? all / 2 : hash % (all / 2));
  return static_cast<float>(hash % (all + 1));
}

void put(std::vector<uint8_t>& out, const Spec& spec, float code) {
  uint8_t bytes[4] = {};
  const auto number16 = static_cast<uint16_t>(code);
  if (spec.bits == 8) bytes[0] = static_cast<uint8_t>(code);
  if (spec.bits == 16) std::memcpy(bytes, &number16, 2);
  if (spec.bits == 32) std::memcpy(bytes, &code, 4);
  out.insert(out.end(), bytes, bytes + spec.bits / 8);
}

std::vector<uint8_t> block(const Spec& spec, int x0, int y0, int width, int height) {
  std::vector<uint8_t> out;
  for (int y = y0; y < y0 + height; ++y) {
    for (int x = x0; x < x0 + width; ++x) {
      for (int c = 0; c < spec.channels; ++c) {
        const bool inside = x < spec.width && y < spec.height;
        put(out, spec, inside ? code_of(spec, x, y, c) : 0.0F);
      }
    }
  }
  return out;
}

void write(const std::string& path, const Spec& spec) {
  TIFF* tiff = TIFFOpen(path.c_str(), spec.mode);
  ASSERT_NE(tiff, nullptr);
  const auto set = [tiff](uint32_t tag, int value) { TIFFSetField(tiff, tag, value); };
  set(TIFFTAG_IMAGEWIDTH, spec.width);
  set(TIFFTAG_IMAGELENGTH, spec.height);
  set(TIFFTAG_BITSPERSAMPLE, spec.bits);
  set(TIFFTAG_SAMPLESPERPIXEL, spec.channels);
  set(TIFFTAG_PLANARCONFIG, spec.planes);
  set(TIFFTAG_ORIENTATION, spec.orientation);
  set(TIFFTAG_COMPRESSION, spec.compression);
  const int usual = spec.channels < 3 ? PHOTOMETRIC_MINISBLACK : PHOTOMETRIC_RGB;
  set(TIFFTAG_PHOTOMETRIC, spec.photometric < 0 ? usual : spec.photometric);
  if (spec.bits == 32) set(TIFFTAG_SAMPLEFORMAT, SAMPLEFORMAT_IEEEFP);
  if (spec.channels % 2 == 0) {
    const uint16_t kind = spec.premultiplied ? EXTRASAMPLE_ASSOCALPHA : EXTRASAMPLE_UNASSALPHA;
    TIFFSetField(tiff, TIFFTAG_EXTRASAMPLES, 1, &kind);
  }
  if (spec.tile > 0) {
    set(TIFFTAG_TILEWIDTH, spec.tile);
    set(TIFFTAG_TILELENGTH, spec.tile);
    for (int y = 0; y < spec.height; y += spec.tile) {
      for (int x = 0; x < spec.width; x += spec.tile) {
        auto tile = block(spec, x, y, spec.tile, spec.tile);
        TIFFWriteTile(tiff, tile.data(), static_cast<uint32_t>(x), static_cast<uint32_t>(y), 0, 0);
      }
    }
  } else {
    set(TIFFTAG_ROWSPERSTRIP, 5);
    for (int y = 0; y < spec.height; ++y) {
      auto row = block(spec, 0, y, spec.width, 1);
      TIFFWriteScanline(tiff, row.data(), static_cast<uint32_t>(y), 0);
    }
  }
  TIFFClose(tiff);
}

/// What the picture should hold: straight alpha, linear light.
float expected(const Spec& spec, int x, int y, int c, bool srgb) {
  const float most = spec.bits == 32 ? 1.0F : static_cast<float>((1 << spec.bits) - 1);
  const float value = code_of(spec, x, y, c) / most;
  const bool has_alpha = spec.channels % 2 == 0;
  if (has_alpha && c == spec.channels - 1) return value;
  const float alpha = spec.premultiplied ? code_of(spec, x, y, spec.channels - 1) / most : 1.0F;
  return srgb ? srgb_decode(value / alpha) : value / alpha;
}

void expect_read(const Spec& spec, ColorSpace space, bool srgb) {
  const TempFolder folder;
  const std::string path = folder.file("a.tif");
  write(path, spec);
  const auto image = read_image_file(path, space);
  ASSERT_TRUE(image) << image.error().message;
  ASSERT_EQ(image->width, spec.width);
  ASSERT_EQ(image->height, spec.height);
  ASSERT_EQ(static_cast<int>(image->channels.size()), spec.channels);
  for (int y = 0; y < spec.height; ++y) {
    for (int x = 0; x < spec.width; ++x) {
      for (int c = 0; c < spec.channels; ++c)
        ASSERT_NEAR(image->at(x, y, c), expected(spec, x, y, c, srgb), 1e-5F) << x << ' ' << y;
    }
  }
}

std::string error_of(const Spec& spec) {
  const TempFolder folder;
  const std::string path = folder.file("a.tif");
  write(path, spec);
  const auto image = read_image_file(path);
  return image ? "none" : image.error().message.substr(path.size());
}

TEST(ReadTiff, StripsAndTilesOfAllKinds) {
  for (const int channels : {1, 2, 3, 4}) {
    for (const int bits : {8, 16, 32}) {
      for (const int tile : {0, 16}) {
        for (const char* mode : {"wl", "wb", "w8"}) {
          SCOPED_TRACE(std::to_string(channels) + " " + std::to_string(bits) + " " + mode);
          Spec spec;
          spec.channels = channels;
          spec.bits = bits;
          spec.tile = tile;
          spec.mode = mode;
          expect_read(spec, ColorSpace::automatic, bits != 32);
        }
      }
    }
  }
}

TEST(ReadTiff, CompressionsOfUsualFiles) {
  for (const int compression :
       {COMPRESSION_NONE, COMPRESSION_PACKBITS, COMPRESSION_LZW, COMPRESSION_ADOBE_DEFLATE}) {
    Spec spec;
    spec.compression = compression;
    expect_read(spec, ColorSpace::automatic, true);
  }
}

TEST(ReadTiff, NumbersAreWhatTheJobSaysTheyAre) {
  Spec spec;
  expect_read(spec, ColorSpace::linear, false);
  spec.bits = 32;
  expect_read(spec, ColorSpace::srgb, true);
}

TEST(ReadTiff, PremultipliedColoursBecomeStraight) {
  Spec spec;
  spec.channels = 4;
  spec.bits = 16;
  spec.premultiplied = true;
  expect_read(spec, ColorSpace::automatic, true);
}

TEST(ReadTiff, ReadsWhatWeWrite) {
  const TempFolder folder;
  const std::string path = folder.file("a.tif");
  const Image image = test::hashed_image(19, 7, {"R", "G", "B", "A"});
  ASSERT_TRUE(write_tiff(path, image, {}, {16, ColorTag::linear}).ok());
  const auto back = read_image_file(path, ColorSpace::linear);
  ASSERT_TRUE(back) << back.error().message;
  EXPECT_LT(test::largest_difference(image, *back), 0.51F / 65535.0F);
}

TEST(ReadTiff, SaysWhatItDoesNotRead) {
  Spec negative;
  negative.channels = 1;
  negative.photometric = PHOTOMETRIC_MINISWHITE;
  EXPECT_NE(error_of(negative).find("photometric interpretation 0; expected grey (1) or RGB (2)"),
            std::string::npos)
      << error_of(negative);
  Spec turned;
  turned.orientation = ORIENTATION_BOTLEFT;
  EXPECT_NE(error_of(turned).find("upper left corner"), std::string::npos);
  Spec planes;
  planes.channels = 1;
  planes.planes = PLANARCONFIG_SEPARATE;
  EXPECT_NE(error_of(planes).find("planes"), std::string::npos) << error_of(planes);
  Spec five;
  five.channels = 5;
  EXPECT_NE(error_of(five).find("5 samples per pixel; expected 3 or 4"), std::string::npos);
}

}  // namespace
}  // namespace hyades::core
