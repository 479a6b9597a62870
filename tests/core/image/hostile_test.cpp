#include <gtest/gtest.h>

#include <chrono>
#include <filesystem>
#include <string>
#include <vector>

#include "core/base/hash.h"
#include "core/image/read_image.h"
#include "core/image/write_image.h"
#include "tests/core/image/image_tools.h"
#include "tests/support/temp_folder.h"

namespace hyades::core {
namespace {

using test::exact_bytes;

/// Small valid files, one of each decoder's code paths.
std::vector<std::pair<std::string, std::string>> samples() {
  const test::TempFolder folder;
  std::vector<std::pair<std::string, std::string>> files;
  const auto add = [&](const std::string& name, const Status& status) {
    EXPECT_TRUE(status) << status.error().message;
    files.emplace_back(name, test::file_contents(folder.file(name)));
  };
  const Image color = test::hashed_image(9, 7, {"R", "G", "B"});
  const Image alpha = test::hashed_image(9, 7, {"R", "G", "B", "A"});
  const Image grey = test::hashed_image(9, 7, {"Y"});
  add("color.png", write_png(folder.file("color.png"), color, {{"Title", "x"}}));
  add("alpha.png", write_png(folder.file("alpha.png"), alpha));
  add("grey.jpg", write_jpeg(folder.file("grey.jpg"), grey, 50));
  add("color.jpg", write_jpeg(folder.file("color.jpg"), color, 50));
  add("float.exr", write_exr(folder.file("float.exr"), color));
  add("half.exr", write_exr(folder.file("half.exr"), alpha, {{"note", "x"}}, true));
  std::string hdr = "#?RADIANCE\nFORMAT=32-bit_rle_rgbe\n\n-Y 3 +X 9\n";
  hdr += std::string(
      "\x02\x02\x00\x09"
      "\x89\x80\x89\x81\x89\x82\x89\x83",
      12);
  hdr += std::string(
      "\x02\x02\x00\x09"
      "\x09"
      "123456789"
      "\x09"
      "123456789"
      "\x89\x82\x89\x83",
      28);
  hdr += std::string(
      "\x80\x80\x80\x80"
      "\x01\x01\x01\x08",
      8);
  files.emplace_back("rle.hdr", hdr);
  return files;
}

TEST(Hostile, EveryTruncationIsAnErrorThatNamesTheFile) {
  for (const auto& [name, file] : samples()) {
    ASSERT_TRUE(read_image(exact_bytes(file), name)) << name;
    const auto start = std::chrono::steady_clock::now();
    size_t accepted = 0;
    for (size_t size = 0; size < file.size(); ++size) {
      const Result<Image> image = read_image(exact_bytes(file.substr(0, size)), name);
      if (image) {
        ++accepted;
      } else {
        EXPECT_EQ(image.error().message.find(name + ": "), 0U) << image.error().message;
      }
    }
    // The last bytes of a file may carry nothing (a JPEG's end marker).
    EXPECT_LE(accepted, 2U) << name;
    const std::chrono::duration<double> time = std::chrono::steady_clock::now() - start;
    EXPECT_LT(time.count(), 20.0) << name;
  }
}

TEST(Hostile, FlippedBytesNeverCrash) {
  constexpr int kRounds = 3000;
  ImageLimits limits;
  limits.max_side = 4096;
  limits.max_pixels = 1 << 15;  // keeps the test quick
  for (const auto& [name, file] : samples()) {
    const auto start = std::chrono::steady_clock::now();
    int accepted = 0;
    for (int round = 0; round < kRounds; ++round) {
      std::string damaged = file;
      uint64_t random = hash_combine(static_cast<uint64_t>(round), file.size());
      const uint64_t flips = 1 + random % 4;
      for (uint64_t i = 0; i < flips; ++i) {
        random = mix64(random + i + 1);
        // Headers decide most: half of the flips go to the first 400 bytes.
        const size_t range =
            (random >> 60 & 1) != 0 ? std::min<size_t>(400, file.size()) : file.size();
        const size_t place = (random >> 8) % range;
        damaged[place] = static_cast<char>(random >> 48);
      }
      if (round % 16 == 0) damaged.resize(random % (damaged.size() + 1));
      const Result<Image> image =
          read_image(exact_bytes(damaged), name, ColorSpace::automatic, limits);
      if (image) {
        ++accepted;
        EXPECT_EQ(image->data.size(), static_cast<size_t>(image->width) *
                                          static_cast<size_t>(image->height) *
                                          image->channels.size());
      }
    }
    const std::chrono::duration<double> time = std::chrono::steady_clock::now() - start;
    EXPECT_LT(time.count(), 20.0) << name;
    RecordProperty(name, accepted);
  }
}

TEST(Hostile, UnknownFilesAreNamed) {
  const auto error = [](const std::string& file) {
    const Result<Image> image = read_image(exact_bytes(file), "x");
    return image ? std::string("no error") : image.error().message;
  };
  EXPECT_EQ(error(""), "x: the file is empty");
  EXPECT_EQ(error("hello"), "x: not a known picture; expected PNG, JPEG, Radiance HDR or OpenEXR");
  EXPECT_EQ(error("GIF89a..."),
            "x: GIF files are not read; expected PNG, JPEG, Radiance HDR or OpenEXR");
  const Result<Image> missing = read_image_file("no/such/file.png");
  ASSERT_FALSE(missing);
  EXPECT_NE(missing.error().message.find("no/such/file.png: no such file"), std::string::npos);
  EXPECT_FALSE(read_image_file("."));
}

}  // namespace
}  // namespace hyades::core
