// jpeglib.h needs size_t and FILE before it.
#include <cstddef>
#include <cstdio>

#include <gtest/gtest.h>
#include <jpeglib.h>

#include <cmath>
#include <cstdlib>
#include <filesystem>
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

/// A smooth JPEG of `space`, plain or progressive.
std::string make_jpeg(J_COLOR_SPACE space, int channels, bool progressive, int size = 16) {
  jpeg_compress_struct jpeg;
  jpeg_error_mgr errors;
  jpeg.err = jpeg_std_error(&errors);
  jpeg_create_compress(&jpeg);
  unsigned char* memory = nullptr;
  unsigned long bytes = 0;
  jpeg_mem_dest(&jpeg, &memory, &bytes);
  jpeg.image_width = static_cast<JDIMENSION>(size);
  jpeg.image_height = static_cast<JDIMENSION>(size);
  jpeg.input_components = channels;
  jpeg.in_color_space = space;
  jpeg_set_defaults(&jpeg);
  jpeg_set_quality(&jpeg, 95, TRUE);
  if (progressive) jpeg_simple_progression(&jpeg);
  jpeg_start_compress(&jpeg, TRUE);
  std::vector<JSAMPLE> row(static_cast<size_t>(size * channels));
  for (int y = 0; y < size; ++y) {
    for (size_t i = 0; i < row.size(); ++i) row[i] = static_cast<JSAMPLE>(8 * y + i);
    JSAMPROW rows[] = {row.data()};
    jpeg_write_scanlines(&jpeg, rows, 1);
  }
  jpeg_finish_compress(&jpeg);
  std::string file(reinterpret_cast<char*>(memory), bytes);
  jpeg_destroy_compress(&jpeg);
  std::free(memory);
  return file;
}

TEST(Jpeg, RoundTripOfColourAndGrey) {
  const TempFolder folder;
  const std::string path = folder.file("a.jpg");
  for (const bool grey : {false, true}) {
    Image image = make_image(
        64, 48, grey ? std::vector<std::string>{"Y"} : std::vector<std::string>{"R", "G", "B"});
    for (int y = 0; y < 48; ++y) {
      for (int x = 0; x < 64; ++x) {
        for (int c = 0; c < image.channel_count(); ++c) {
          image.at(x, y, c) = 0.5F + 0.4F * std::sin(0.1F * static_cast<float>(x + y * (c + 1)));
        }
      }
    }
    ASSERT_TRUE(write_jpeg(path, image, 98));
    const Result<Image> back = read_image_file(path, ColorSpace::linear);
    ASSERT_TRUE(back) << back.error().message;
    EXPECT_LT(test::largest_difference(*back, image), 0.02F);
    const Result<Image> decoded = read_image_file(path);
    ASSERT_TRUE(decoded);
    EXPECT_FLOAT_EQ(decoded->data[7], srgb_decode(back->data[7]));
  }
}

TEST(Jpeg, LowerQualityIsSmaller) {
  const TempFolder folder;
  const Image image = test::hashed_image(64, 64, {"R", "G", "B"});
  ASSERT_TRUE(write_jpeg(folder.file("a.jpg"), image, 30));
  ASSERT_TRUE(write_jpeg(folder.file("b.jpg"), image, 95));
  EXPECT_LT(std::filesystem::file_size(folder.file("a.jpg")),
            std::filesystem::file_size(folder.file("b.jpg")));
}

TEST(Jpeg, ProgressiveFilesAreRead) {
  const Result<Image> image = read_image(exact_bytes(make_jpeg(JCS_RGB, 3, true)), "p.jpg");
  ASSERT_TRUE(image) << image.error().message;
  EXPECT_EQ(image->channels.size(), 3U);
}

TEST(Jpeg, CmykIsRefusedInWords) {
  const Result<Image> image = read_image(exact_bytes(make_jpeg(JCS_CMYK, 4, false)), "print.jpg");
  ASSERT_FALSE(image);
  EXPECT_EQ(image.error().message,
            "print.jpg: JPEG: CMYK colours (for printing) are not read; save it as RGB");
}

TEST(Jpeg, EndlessScansAreRefused) {
  // Repeats the first scan of a progressive file a thousand times.
  const std::string file = make_jpeg(JCS_GRAYSCALE, 1, true);
  const size_t scan = file.find("\xFF\xDA");
  const size_t second = file.find("\xFF\xDA", scan + 2);
  ASSERT_NE(second, std::string::npos);
  // Tables stand between scans: keep them with the scan in front.
  std::string hostile = file.substr(0, second);
  for (int i = 0; i < 1000; ++i) hostile += file.substr(scan, second - scan);
  hostile += file.substr(second);
  EXPECT_FALSE(read_image(exact_bytes(hostile), "scans.jpg"));
}

TEST(Jpeg, ABombIsRefusedBeforeMemoryIsTaken) {
  std::string file = make_jpeg(JCS_RGB, 3, false);
  const size_t frame = file.find("\xFF\xC0");
  ASSERT_NE(frame, std::string::npos);
  file.replace(frame + 5, 4, "\x3A\x98\x3A\x98");  // 15,000 x 15,000
  const Result<Image> image = read_image(exact_bytes(file), "bomb.jpg");
  ASSERT_FALSE(image);
  EXPECT_EQ(image.error().message, "bomb.jpg: JPEG: the file is truncated");
}

TEST(Jpeg, ReadsTheRealWorld) {
  const std::string folder = test::shared_file("assets/textures");
  HYADES_SKIP_WITHOUT(folder);
  int count = 0;
  for (const auto& entry : std::filesystem::directory_iterator(folder)) {
    if (entry.path().extension() != ".jpg") continue;
    const std::string name = entry.path().filename().string();
    if (name.find("Color") == std::string::npos && name.find("Roughness") == std::string::npos) {
      continue;
    }
    const Result<Image> image = read_image_file(entry.path().string());
    ASSERT_TRUE(image) << image.error().message;
    EXPECT_GE(image->width, 1024);
    ++count;
  }
  EXPECT_GE(count, 3);
}

}  // namespace
}  // namespace hyades::core
