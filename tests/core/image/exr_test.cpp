#include <OpenEXR/ImfChannelList.h>
#include <OpenEXR/ImfFrameBuffer.h>
#include <OpenEXR/ImfHeader.h>
#include <OpenEXR/ImfInputFile.h>
#include <OpenEXR/ImfMultiPartOutputFile.h>
#include <OpenEXR/ImfOutputFile.h>
#include <OpenEXR/ImfOutputPart.h>
#include <OpenEXR/ImfPartType.h>
#include <OpenEXR/ImfStringAttribute.h>
#include <OpenEXR/ImfTiledOutputFile.h>
#include <gtest/gtest.h>

#include <cmath>
#include <cstring>
#include <filesystem>
#include <limits>
#include <string>
#include <vector>

#include "core/image/read_image.h"
#include "core/image/write_image.h"
#include "tests/core/image/image_tools.h"
#include "tests/support/shared_assets.h"
#include "tests/support/temp_folder.h"

namespace hyades::core {
namespace {

using test::hashed_image;
using test::TempFolder;

TEST(Exr, FloatRoundTripIsExact) {
  const TempFolder folder;
  const std::string path = folder.file("a.exr");
  Image image = hashed_image(37, 21, {"R", "G", "B", "A", "albedo.R", "depth.Z", "samples.N"});
  image.at(3, 4, 5) = std::numeric_limits<float>::infinity();
  image.at(4, 4, 0) = -1e30F;
  image.at(5, 4, 0) = 1e-30F;
  ASSERT_TRUE(write_exr(path, image, {{"hyades.job", "cornell"}, {"sp\u00e4t", "\u00fc"}}));
  const Result<Image> back = read_image_file(path);
  ASSERT_TRUE(back) << back.error().message;
  EXPECT_EQ(back->channels, image.channels);
  EXPECT_EQ(back->data, image.data);

  Imf::InputFile file(path.c_str(), 0);
  const auto* text = file.header().findTypedAttribute<Imf::StringAttribute>("hyades.job");
  ASSERT_NE(text, nullptr);
  EXPECT_EQ(text->value(), "cornell");
  EXPECT_EQ(file.header().compression(), Imf::ZIP_COMPRESSION);
}

TEST(Exr, KeepsWhereAPictureLiesInItsFrame) {
  const test::TempFolder folder;
  Image image = make_image(3, 2, {"R", "G", "B"});
  for (size_t i = 0; i < image.data.size(); ++i) image.data[i] = static_cast<float>(i);
  image.placement = {5, 7, 20, 10};
  ASSERT_TRUE(write_exr(folder.file("crop.exr"), image).ok());
  const auto read = read_image_file(folder.file("crop.exr"));
  ASSERT_TRUE(read.ok());
  EXPECT_EQ(read->placement, image.placement);
  EXPECT_EQ(read->data, image.data);

  const Imf::InputFile file(folder.file("crop.exr").c_str());
  EXPECT_EQ(file.header().dataWindow(), Imath::Box2i({5, 7}, {7, 8}));
  EXPECT_EQ(file.header().displayWindow(), Imath::Box2i({0, 0}, {19, 9}));
}

TEST(Exr, HalfKeepsElevenBitsAndFiniteStaysFinite) {
  const TempFolder folder;
  const std::string path = folder.file("a.exr");
  Image image = hashed_image(16, 16, {"R", "G", "B"});
  image.at(0, 0, 0) = 1e9F;
  image.at(1, 0, 0) = -std::numeric_limits<float>::infinity();
  image.at(2, 0, 0) = 65519.0F;
  ASSERT_TRUE(write_exr(path, image, {}, true));
  const Result<Image> back = read_image_file(path);
  ASSERT_TRUE(back) << back.error().message;
  EXPECT_EQ(back->at(0, 0, 0), 65504.0F);
  EXPECT_EQ(back->at(1, 0, 0), -std::numeric_limits<float>::infinity());
  EXPECT_EQ(back->at(2, 0, 0), 65504.0F);
  for (int y = 1; y < 16; ++y) {
    for (int x = 0; x < 16; ++x) {
      EXPECT_NEAR(back->at(x, y, 1), image.at(x, y, 1), 0x1p-11F * image.at(x, y, 1) + 1e-7F);
    }
  }
}

TEST(Exr, RefusesWhatCannotBeWritten) {
  const TempFolder folder;
  const std::string path = folder.file("a.exr");
  const Image image = hashed_image(4, 4, {"R"});
  EXPECT_FALSE(write_exr(path, Image{}));
  EXPECT_FALSE(write_exr(path, hashed_image(4, 4, {"R", "R"})));
  EXPECT_FALSE(write_exr(path, hashed_image(4, 4, {""})));
  EXPECT_FALSE(write_exr(path, image, {{"", "x"}}));
  EXPECT_FALSE(write_exr(path, image, {{"channels", "not a channel list"}}));
  EXPECT_FALSE(write_exr(folder.file("none/a.exr"), image));
  EXPECT_FALSE(std::filesystem::exists(path));
  EXPECT_EQ(std::distance(std::filesystem::directory_iterator(folder.path()), {}), 0);
}

Imf::FrameBuffer buffer_of(const Image& image, const Imath::Box2i& window, Imf::PixelType type) {
  Imf::FrameBuffer buffer;
  const size_t pixel = image.channels.size() * sizeof(float);
  for (size_t c = 0; c < image.channels.size(); ++c) {
    buffer.insert(image.channels[c], Imf::Slice::Make(type, image.data.data() + c, window, pixel,
                                                      pixel * static_cast<size_t>(image.width)));
  }
  return buffer;
}

TEST(Exr, ReadsEveryCompressionTilesAndShiftedWindows) {
  const TempFolder folder;
  const std::string path = folder.file("a.exr");
  const Image image = hashed_image(70, 45, {"R", "G", "B"});
  const Imath::Box2i window({-5, 100}, {64, 144});
  for (int compression = 0; compression < Imf::NUM_COMPRESSION_METHODS; ++compression) {
    const bool lossy = compression >= Imf::PXR24_COMPRESSION;
    for (const bool tiled : {false, true}) {
      Imf::Header header(Imath::Box2i({0, 0}, {200, 200}), window);
      header.compression() = static_cast<Imf::Compression>(compression);
      for (const auto& name : image.channels)
        header.channels().insert(name, Imf::Channel(Imf::FLOAT));
      if (tiled) {
        header.setTileDescription(Imf::TileDescription(32, 16, Imf::MIPMAP_LEVELS));
        Imf::TiledOutputFile file(path.c_str(), header, 0);
        file.setFrameBuffer(buffer_of(image, window, Imf::FLOAT));
        file.writeTiles(0, file.numXTiles(0) - 1, 0, file.numYTiles(0) - 1, 0);
        // Coarser levels from the same memory: their contents are never read.
        for (int level = 1; level < file.numLevels(); ++level) {
          file.writeTiles(0, file.numXTiles(level) - 1, 0, file.numYTiles(level) - 1, level);
        }
      } else {
        Imf::OutputFile file(path.c_str(), header, 0);
        file.setFrameBuffer(buffer_of(image, window, Imf::FLOAT));
        file.writePixels(image.height);
      }
      const Result<Image> back = read_image_file(path);
      ASSERT_TRUE(back) << back.error().message;
      EXPECT_LE(test::largest_difference(*back, image), lossy ? 0.05F : 0.0F)
          << "compression " << compression << (tiled ? " tiled" : "");
    }
  }
}

TEST(Exr, ReadsTheFirstOfManyParts) {
  const TempFolder folder;
  const std::string path = folder.file("a.exr");
  const Image image = hashed_image(20, 10, {"R", "G", "B"});
  std::vector<Imf::Header> headers(2, Imf::Header(20, 10));
  for (size_t i = 0; i < 2; ++i) {
    headers[i].setName(i == 0 ? "picture" : "sums");
    headers[i].setType(Imf::SCANLINEIMAGE);
    for (const auto& name : image.channels) {
      headers[i].channels().insert(name, Imf::Channel(i == 0 ? Imf::FLOAT : Imf::UINT));
    }
  }
  const Imath::Box2i window = headers[0].dataWindow();
  {
    Imf::MultiPartOutputFile file(path.c_str(), headers.data(), 2, false, 0);
    for (int i = 0; i < 2; ++i) {
      Imf::OutputPart part(file, i);
      part.setFrameBuffer(buffer_of(image, window, i == 0 ? Imf::FLOAT : Imf::UINT));
      part.writePixels(10);
    }
  }
  const Result<Image> back = read_image_file(path);
  ASSERT_TRUE(back) << back.error().message;
  EXPECT_EQ(back->data, image.data);
}

TEST(Exr, RefusesSubsampledAndTooLarge) {
  const TempFolder folder;
  const std::string path = folder.file("a.exr");
  Imf::Header header(8, 8);
  header.channels().insert("Y", Imf::Channel(Imf::FLOAT));
  header.channels().insert("RY", Imf::Channel(Imf::FLOAT, 2, 2));
  const std::vector<float> data(64);
  Imf::FrameBuffer buffer;
  char* base = const_cast<char*>(reinterpret_cast<const char*>(data.data()));
  buffer.insert("Y", Imf::Slice(Imf::FLOAT, base, 4, 32));
  buffer.insert("RY", Imf::Slice(Imf::FLOAT, base, 4, 16, 2, 2));
  {
    Imf::OutputFile file(path.c_str(), header, 0);
    file.setFrameBuffer(buffer);
    file.writePixels(8);
  }
  const Result<Image> back = read_image_file(path);
  ASSERT_FALSE(back);
  EXPECT_NE(back.error().message.find("'RY' is subsampled"), std::string::npos)
      << back.error().message;

  ASSERT_TRUE(write_exr(path, hashed_image(100, 10, {"R", "G", "B"})));
  const Bytes bytes = test::exact_bytes(test::file_contents(path));
  ImageLimits limits;
  limits.max_side = 99;
  EXPECT_FALSE(read_image(bytes, "a", ColorSpace::automatic, limits));
  limits = {};
  limits.max_pixels = 999;
  EXPECT_FALSE(read_image(bytes, "a", ColorSpace::automatic, limits));
  limits.max_pixels = 1000;
  EXPECT_TRUE(read_image(bytes, "a", ColorSpace::automatic, limits));
}

/// Replaces the value of attribute `name` of type `type` in a file.
void set_attribute(std::string& file, const std::string& name, const std::string& type,
                   const std::vector<int32_t>& value) {
  const std::string key = name + '\0' + type + '\0';
  const size_t at = file.find(key);
  ASSERT_NE(at, std::string::npos) << name;
  std::memcpy(file.data() + at + key.size() + 4, value.data(), 4 * value.size());
}

TEST(Exr, BombsAreRefusedBeforeMemoryIsTaken) {
  const TempFolder folder;
  const std::string path = folder.file("a.exr");
  const Image image = hashed_image(16, 16, {"R", "G", "B"});
  ASSERT_TRUE(write_exr(path, image));
  const std::string scanlines = test::file_contents(path);
  Imf::Header header(16, 16);
  for (const auto& name : image.channels) header.channels().insert(name, Imf::Channel(Imf::FLOAT));
  header.setTileDescription(Imf::TileDescription(16, 16));
  {
    Imf::TiledOutputFile file(path.c_str(), header, 0);
    file.setFrameBuffer(buffer_of(image, header.dataWindow(), Imf::FLOAT));
    file.writeTile(0, 0);
  }
  const std::string tiled = test::file_contents(path);
  const auto error_of = [](const std::string& file) {
    const Result<Image> read = read_image(test::exact_bytes(file), "bomb.exr");
    return read ? std::string("no error") : read.error().message;
  };
  EXPECT_EQ(error_of(scanlines), "no error");
  EXPECT_EQ(error_of(tiled), "no error");

  std::string tall = scanlines;
  set_attribute(tall, "dataWindow", "box2i", {0, 0, 1, 59'999});
  EXPECT_EQ(error_of(tall), "bomb.exr: OpenEXR: the file is truncated");
  std::string large = scanlines;
  set_attribute(large, "dataWindow", "box2i", {0, 0, 49'999, 49'999});
  EXPECT_NE(error_of(large).find("at most 400,000,000 in all"), std::string::npos);
  std::string wrapped = scanlines;
  set_attribute(wrapped, "dataWindow", "box2i", {INT32_MIN, 0, INT32_MAX, 15});
  EXPECT_NE(error_of(wrapped).find("per side"), std::string::npos);
  std::string tiny_tiles = tiled;
  set_attribute(tiny_tiles, "dataWindow", "box2i", {0, 0, 9'999, 9'999});
  set_attribute(tiny_tiles, "tiles", "tiledesc", {1, 1});
  EXPECT_EQ(error_of(tiny_tiles), "bomb.exr: OpenEXR: the file is truncated");
  std::string no_tiles = tiled;
  set_attribute(no_tiles, "tiles", "tiledesc", {0, -1});
  EXPECT_EQ(error_of(no_tiles), "bomb.exr: OpenEXR: tiles of no size");
  std::string long_attribute = scanlines;
  const size_t size_at = long_attribute.find(std::string("compression\0compression\0", 24)) + 24;
  const int32_t huge = 0x7FFFFFFF;
  std::memcpy(long_attribute.data() + size_at, &huge, 4);
  EXPECT_EQ(error_of(long_attribute),
            "bomb.exr: OpenEXR: attribute 'compression' is longer than the file");
  // OpenEXR would take what is behind an early end for the next attribute, and its bytes for a
  // size.
  std::string early_end = scanlines;
  early_end[early_end.find(std::string("channels\0chlist\0", 16)) + 20] = '\0';
  EXPECT_NE(error_of(early_end).find("attribute 'channels' has "), std::string::npos);
}

TEST(Exr, SrgbOnRequestLeavesAlpha) {
  const TempFolder folder;
  const std::string path = folder.file("a.exr");
  Image image = make_image(1, 1, {"R", "A"});
  image.data = {0.5F, 0.5F};
  ASSERT_TRUE(write_exr(path, image));
  const Result<Image> back = read_image_file(path, ColorSpace::srgb);
  ASSERT_TRUE(back);
  EXPECT_NEAR(back->at(0, 0, 0), 0.21404F, 1e-5F);
  EXPECT_EQ(back->at(0, 0, 1), 0.5F);
}

TEST(Exr, ReadsDwabOfTheRealWorld) {
  const std::string path = test::shared_file("assets/hdri/park_512_dwab.exr");
  HYADES_SKIP_WITHOUT(path);
  const Result<Image> image = read_image_file(path);
  ASSERT_TRUE(image) << image.error().message;
  EXPECT_EQ(image->width, 512);
  EXPECT_EQ(image->height, 256);
  for (const char* name : {"R", "G", "B"}) EXPECT_GE(image->find_channel(name), 0);
  double sum = 0.0;
  for (const float value : image->data) {
    ASSERT_TRUE(std::isfinite(value));
    sum += double{value};
  }
  EXPECT_GT(sum, 0.0);
}

}  // namespace
}  // namespace hyades::core
