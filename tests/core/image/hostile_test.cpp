#include <OpenEXR/ImfChannelList.h>
#include <OpenEXR/ImfFrameBuffer.h>
#include <OpenEXR/ImfHeader.h>
#include <OpenEXR/ImfMultiPartOutputFile.h>
#include <OpenEXR/ImfOutputFile.h>
#include <OpenEXR/ImfOutputPart.h>
#include <OpenEXR/ImfPartType.h>
#include <OpenEXR/ImfTiledOutputFile.h>
#include <gtest/gtest.h>

#include <chrono>
#include <cstdlib>
#include <string>
#include <vector>

#include "core/base/hash.h"
#include "core/image/read_image.h"
#include "core/image/write_image.h"
#include "tests/core/image/image_tools.h"
#include "tests/support/temp_folder.h"

// Damaged and truncated files must give an error or a picture, in bounded time: never a crash, a
// hang or memory without bound. Run with HYADES_FUZZ_ROUNDS=100000 and a sanitizer for longer.
namespace hyades::core {
namespace {

using test::exact_bytes;

struct Sample {
  std::string name;
  std::string file;
};

class SampleMaker {
 public:
  std::vector<Sample> make() {
    const Image color = test::hashed_image(9, 7, {"R", "G", "B"});
    const Image alpha = test::hashed_image(9, 7, {"R", "G", "B", "A"});
    const Image grey = test::hashed_image(9, 7, {"Y"});
    write("color.png", [&](const auto& path) { return write_png(path, color, {{"Title", "x"}}); });
    write("alpha.png", [&](const auto& path) { return write_png(path, alpha); });
    write("grey.jpg", [&](const auto& path) { return write_jpeg(path, grey, 50); });
    write("color.jpg", [&](const auto& path) { return write_jpeg(path, color, 50); });
    write("color.tif", [&](const auto& path) { return write_tiff(path, color); });
    write("alpha.tiff", [&](const auto& path) { return write_tiff(path, alpha, {}, {16}); });
    write("half.exr", [&](const auto& path) {
      return write_exr(path, alpha, {{"note", "x"}}, true);
    });
    for (int i = 0; i < Imf::NUM_COMPRESSION_METHODS; ++i) {
      const auto compression = static_cast<Imf::Compression>(i);
      const std::string name = "compression-" + std::to_string(i);
      write(name + ".exr", [&](const auto& path) { return scanlines(path, compression); });
      write(name + "-tiled.exr", [&](const auto& path) { return tiles(path, compression); });
    }
    write("parts.exr", [&](const auto& path) { return parts(path); });
    std::string hdr = "#?RADIANCE\nFORMAT=32-bit_rle_rgbe\n\n-Y 3 +X 9\n";
    hdr += std::string("\x02\x02\x00\x09\x89\x80\x89\x81\x89\x82\x89\x83", 12);
    hdr += std::string(
        "\x02\x02\x00\x09\x09"
        "123456789"
        "\x09"
        "123456789"
        "\x89\x82\x89\x83",
        28);
    hdr += std::string("\x80\x80\x80\x80\x01\x01\x01\x08", 8);
    samples_.push_back({"rle.hdr", hdr});
    samples_.push_back({"runs.tga", std::string("\0\0\x0A\0\0\0\0\0\0\0\0\0\3\0\2\0\x20\x08", 18) +
                                        "\x83" + "abcd" + "\x01" + "abcdefgh"});
    samples_.push_back({"palette.tga", std::string("\0\1\1\0\0\2\0\x18\0\0\0\0\3\0\2\0\x08\0", 18) +
                                           "abcdef" + std::string("\0\1\0\1\0\1", 6)});
    samples_.push_back(
        {"palette.bmp", "BM" +
                            std::string("\0\0\0\0\0\0\0\0\x3E\0\0\0\x28\0\0\0\3\0\0\0\2\0\0\0"
                                        "\1\0\4\0\0\0\0\0\0\0\0\0\0\0\0\0\0\0\0\0\2\0\0\0"
                                        "\0\0\0\0",
                                        52) +
                            "abcdefgh" + std::string("\1\0\0\0\0\1\0\0", 8)});
    samples_.push_back({"all.qoi", "qoif" + std::string("\0\0\0\3\0\0\0\3\4\0\xFE"
                                                        "abc\x55\xA0\x88\xC1\x05\xFF"
                                                        "abcd\xC2",
                                                        27)});
    samples_.push_back({"deep.ppm", "P6 # made by a test\n1 2\n65535\nabcdefghijkl"});
    samples_.push_back({"grey.pfm", "Pf\n1 2\n-1.5\nabcdefgh"});
    return std::move(samples_);
  }

 private:
  template <class Write>
  void write(const std::string& name, const Write& writer) {
    const Status status = writer(folder_.file(name));
    EXPECT_TRUE(status) << name << ": " << status.error().message;
    samples_.push_back({name, test::file_contents(folder_.file(name))});
  }

  static Imf::Header header(const Image& image, Imf::Compression compression) {
    Imf::Header header(image.width, image.height);
    header.compression() = compression;
    for (const auto& name : image.channels) {
      header.channels().insert(name, Imf::Channel(Imf::FLOAT));
    }
    return header;
  }

  static Imf::FrameBuffer buffer(const Image& image) {
    Imf::FrameBuffer buffer;
    const size_t pixel = image.channels.size() * sizeof(float);
    for (size_t c = 0; c < image.channels.size(); ++c) {
      char* base = const_cast<char*>(reinterpret_cast<const char*>(image.data.data() + c));
      buffer.insert(image.channels[c],
                    Imf::Slice(Imf::FLOAT, base, pixel, pixel * static_cast<size_t>(image.width)));
    }
    return buffer;
  }

  /// Smooth, so that every compression finds something to do.
  static Image gradient() {
    Image image = make_image(19, 13, {"R", "G", "B", "A"});
    for (size_t i = 0; i < image.data.size(); ++i) {
      image.data[i] = static_cast<float>(i % 76) / 64.0F;
    }
    return image;
  }

  static Status scanlines(const std::string& path, Imf::Compression compression) {
    const Image image = gradient();
    Imf::OutputFile file(path.c_str(), header(image, compression), 0);
    file.setFrameBuffer(buffer(image));
    file.writePixels(image.height);
    return {};
  }

  static Status tiles(const std::string& path, Imf::Compression compression) {
    const Image image = gradient();
    Imf::Header tiled = header(image, compression);
    tiled.setTileDescription(Imf::TileDescription(8, 8, Imf::MIPMAP_LEVELS));
    Imf::TiledOutputFile file(path.c_str(), tiled, 0);
    file.setFrameBuffer(buffer(image));
    for (int level = 0; level < file.numLevels(); ++level) {
      file.writeTiles(0, file.numXTiles(level) - 1, 0, file.numYTiles(level) - 1, level);
    }
    return {};
  }

  static Status parts(const std::string& path) {
    const Image image = gradient();
    std::vector<Imf::Header> headers(2, header(image, Imf::ZIP_COMPRESSION));
    headers[0].setName("picture");
    headers[1].setName("sums");
    for (auto& part : headers) part.setType(Imf::SCANLINEIMAGE);
    Imf::MultiPartOutputFile file(path.c_str(), headers.data(), 2, false, 0);
    for (int i = 0; i < 2; ++i) {
      Imf::OutputPart part(file, i);
      part.setFrameBuffer(buffer(image));
      part.writePixels(image.height);
    }
    return {};
  }

  test::TempFolder folder_;
  std::vector<Sample> samples_;
};

uint32_t big_endian(const std::string& file, size_t at) {
  uint32_t value = 0;
  for (size_t i = 0; i < 4; ++i) value = value << 8 | static_cast<uint8_t>(file[at + i]);
  return value;
}

/// Makes the checksums of a damaged PNG right, so that the damage comes through.
void mend_png(std::string& file) {
  for (size_t at = 8; at + 12 <= file.size();) {
    const size_t length = big_endian(file, at);
    if (length > file.size() - at - 12) return;
    const uint32_t crc = test::png_crc(std::string_view(file).substr(at + 4, length + 4));
    for (size_t i = 0; i < 4; ++i) {
      file[at + 8 + length + i] = static_cast<char>(crc >> (24 - 8 * i));
    }
    at += length + 12;
  }
}

/// One to four bytes of `file` changed; one time in 16 it is cut short too.
std::string damaged(const std::string& file, uint64_t random) {
  std::string result = file;
  const uint64_t flips = 1 + random % 4;
  const bool cut = (random >> 8) % 16 == 0;
  for (uint64_t i = 0; i < flips; ++i) {
    random = mix64(random + i + 1);
    // Headers decide most: half of the changes go to the first 400 bytes.
    const size_t range = (random >> 60 & 1) != 0 ? std::min<size_t>(400, file.size()) : file.size();
    const size_t place = (random >> 8) % range;
    const auto value = static_cast<uint8_t>(random >> 48);
    const auto bit = static_cast<uint8_t>(1U << (random >> 40 & 7));
    const auto old = static_cast<uint8_t>(result[place]);
    result[place] = static_cast<char>((random >> 59 & 1) != 0 ? value : old ^ bit);
  }
  if (cut) result.resize(mix64(random) % (result.size() + 1));
  return result;
}

double seconds_since(std::chrono::steady_clock::time_point start) {
  return std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
}

TEST(Hostile, EveryTruncationIsAnErrorThatNamesTheFile) {
  for (const Sample& sample : SampleMaker().make()) {
    ASSERT_TRUE(read_image(exact_bytes(sample.file), sample.name)) << sample.name;
    const auto start = std::chrono::steady_clock::now();
    size_t first_accepted = sample.file.size();
    // Every byte of one file of each kind; the variants of EXR differ in their pixels only.
    const size_t step = sample.name.starts_with("compression") ? 13 : 1;
    for (size_t size = 0; size < sample.file.size(); size += step) {
      const Result<Image> image = read_image(exact_bytes(sample.file.substr(0, size)), sample.name);
      if (image) {
        first_accepted = std::min(first_accepted, size);
      } else {
        EXPECT_EQ(image.error().message.find(sample.name + ": "), 0U) << image.error().message;
      }
    }
    // What nobody needs may be missing: a JPEG's end marker, the coarse levels of a tiled EXR, its
    // second part; what a TIFF says of its program behind its pixels.
    if (sample.name.find("tiled") == std::string::npos && sample.name != "parts.exr" &&
        sample.name.find(".tif") == std::string::npos) {
      EXPECT_GE(first_accepted + 2, sample.file.size()) << sample.name;
    }
    EXPECT_LT(seconds_since(start), 20.0) << sample.name;
  }
}

TEST(Hostile, FlippedBytesNeverCrash) {
  const char* wish = std::getenv("HYADES_FUZZ_ROUNDS");
  const int rounds = wish != nullptr ? std::atoi(wish) : 2000;
  ImageLimits limits;
  limits.max_side = 4096;
  limits.max_pixels = 1 << 15;  // keeps the test quick
  for (const Sample& sample : SampleMaker().make()) {
    const auto start = std::chrono::steady_clock::now();
    int accepted = 0;
    for (int round = 0; round < rounds; ++round) {
      std::string file = damaged(sample.file, hash_combine(static_cast<uint64_t>(round), 7));
      if (sample.name.ends_with(".png")) mend_png(file);
      const Result<Image> image =
          read_image(exact_bytes(file), sample.name, ColorSpace::automatic, limits);
      if (!image) continue;
      ++accepted;
      const size_t pixels = static_cast<size_t>(image->width) * static_cast<size_t>(image->height);
      ASSERT_LE(pixels, limits.max_pixels);
      ASSERT_EQ(image->data.size(), pixels * image->channels.size());
    }
    // Both ends of the road are walked: damage that is seen, and damage that is not.
    EXPECT_GT(accepted, 0) << sample.name;
    EXPECT_LT(accepted, rounds) << sample.name;
    if (wish == nullptr) {
      EXPECT_LT(seconds_since(start), 20.0) << sample.name;
    }
    RecordProperty(sample.name, accepted);
  }
}

TEST(Hostile, UnknownFilesAreNamed) {
  const auto error = [](const std::string& file) {
    const Result<Image> image = read_image(exact_bytes(file), "x");
    return image ? std::string("no error") : image.error().message;
  };
  EXPECT_EQ(error(""), "x: the file is empty");
  const std::string expected =
      "; expected PNG, JPEG, TIFF, TGA, BMP, QOI, PPM, PFM, Radiance HDR, OpenEXR or IES";
  EXPECT_EQ(error("hello"), "x: not a known picture" + expected);
  EXPECT_EQ(error("GIF89a..."), "x: GIF files are not read" + expected);
  const Result<Image> missing = read_image_file("no/such/file.png");
  ASSERT_FALSE(missing);
  EXPECT_EQ(missing.error().message, "no/such/file.png: no such file");
  EXPECT_FALSE(read_image_file("."));
}

}  // namespace
}  // namespace hyades::core
