// What pictures say of their colours and of themselves, read by others than who writes them.
#include <OpenEXR/ImfInputFile.h>
#include <OpenEXR/ImfStandardAttributes.h>
#include <gtest/gtest.h>
#include <tiffio.h>

#include <array>
#include <fstream>
#include <string>

#include "core/image/icc_profile.h"
#include "core/image/read_image.h"
#include "core/image/write_image.h"
#include "tests/support/temp_folder.h"

namespace hyades::core {
namespace {

const ImageMetadata kTexts = {{"hyades.job", "glass ünd fog"}, {"hyades.samples", "64"}};

Image ramp(std::vector<std::string> channels) {
  Image image = make_image(37, 21, std::move(channels));
  for (size_t i = 0; i < image.data.size(); ++i) {
    image.data[i] = static_cast<float>(i * 7919 % 65536) / 65535.0F;
  }
  return image;
}

std::string bytes_of(const std::string& path) {
  std::ifstream file(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(file), {}};
}

std::string as_text(const std::vector<uint8_t>& bytes) { return {bytes.begin(), bytes.end()}; }

uint32_t number_at(const std::vector<uint8_t>& bytes, size_t at) {
  return uint32_t{bytes[at]} << 24U | uint32_t{bytes[at + 1]} << 16U |
         uint32_t{bytes[at + 2]} << 8U | bytes[at + 3];
}

/// The numbers of a tag's element, behind its type and four zeros.
std::vector<double> element(const std::vector<uint8_t>& profile, const std::string& name,
                            size_t skip) {
  for (uint32_t i = 0; i < number_at(profile, 128); ++i) {
    const size_t entry = 132 + 12 * size_t{i};
    if (std::string(profile.begin() + static_cast<long>(entry),
                    profile.begin() + static_cast<long>(entry) + 4) != name) {
      continue;
    }
    const size_t at = number_at(profile, entry + 4);
    const size_t size = number_at(profile, entry + 8);
    EXPECT_LE(at + size, profile.size());
    EXPECT_EQ(at % 4, 0U);
    std::vector<double> numbers;
    for (size_t byte = at + skip; byte + 4 <= at + size; byte += 4) {
      numbers.push_back(static_cast<int32_t>(number_at(profile, byte)) / 65536.0);
    }
    return numbers;
  }
  ADD_FAILURE() << "no tag " << name;
  return {};
}

TEST(IccProfile, IsRec709UnderD50WithTheCurveInClosedForm) {
  const auto profile = icc_profile(ColorTag::srgb);
  ASSERT_GT(profile.size(), 132U);
  EXPECT_EQ(number_at(profile, 0), profile.size());
  EXPECT_EQ(as_text(profile).substr(36, 4), "acsp");
  EXPECT_EQ(icc_profile(ColorTag::srgb), profile);
  EXPECT_TRUE(icc_profile(ColorTag::none).empty());
  // White is the sum of the primaries, and the matrix takes D65 (0.9505, 1, 1.0891) there.
  const auto red = element(profile, "rXYZ", 8);
  const auto green = element(profile, "gXYZ", 8);
  const auto blue = element(profile, "bXYZ", 8);
  const auto white = element(profile, "wtpt", 8);
  const auto adaptation = element(profile, "chad", 8);
  constexpr std::array<double, 3> kD50 = {0.9642, 1, 0.8249};
  constexpr std::array<double, 3> kD65 = {0.95046, 1, 1.08906};
  ASSERT_EQ(adaptation.size(), 9U);
  for (size_t i = 0; i < 3; ++i) {
    EXPECT_NEAR(red[i] + green[i] + blue[i], kD50[i], 1e-4);
    EXPECT_NEAR(white[i], kD50[i], 1e-4);
    double adapted = 0;
    for (size_t j = 0; j < 3; ++j) adapted += adaptation[3 * i + j] * kD65[j];
    EXPECT_NEAR(adapted, kD50[i], 1e-4);
  }
  // Red, taken back by the matrix's effect on it: its chromaticity under D65 is Rec.709's, so that
  // adapting (0.64, 0.33) gives its direction here.
  std::array<double, 3> adapted{};
  constexpr std::array<double, 3> kRed = {0.64 / 0.33, 1, 0.03 / 0.33};
  for (size_t i = 0; i < 3; ++i) {
    for (size_t j = 0; j < 3; ++j) adapted[i] += adaptation[3 * i + j] * kRed[j];
  }
  EXPECT_NEAR(adapted[0] / adapted[1], red[0] / red[1], 1e-3);
  EXPECT_NEAR(adapted[2] / adapted[1], red[2] / red[1], 1e-3);
  const auto curve = element(profile, "gTRC", 12);
  ASSERT_EQ(curve.size(), 5U);
  constexpr std::array<double, 5> kCurve = {2.4, 1 / 1.055, 0.055 / 1.055, 1 / 12.92, 0.04045};
  for (size_t i = 0; i < 5; ++i) EXPECT_NEAR(curve[i], kCurve[i], 1e-5);
  EXPECT_EQ(element(icc_profile(ColorTag::linear), "rTRC", 12), std::vector<double>{1.0});
}

TEST(WriteTiff, ReadBackByLibtiff) {
  const test::TempFolder folder;
  const std::string path = folder.file("a.tif");
  for (const int bits : {8, 16}) {
    for (const bool alpha : {false, true}) {
      const Image image = ramp(alpha ? std::vector<std::string>{"R", "G", "B", "A"}
                                     : std::vector<std::string>{"R", "G", "B"});
      ASSERT_TRUE(write_tiff(path, image, kTexts, {bits, ColorTag::srgb}).ok());
      TIFF* tiff = TIFFOpen(path.c_str(), "r");
      ASSERT_NE(tiff, nullptr);
      uint16_t depth = 0;
      uint16_t samples = 0;
      uint16_t extra = 0;
      uint16_t* kinds = nullptr;
      uint16_t compression = 0;
      char* text = nullptr;
      TIFFGetField(tiff, TIFFTAG_BITSPERSAMPLE, &depth);
      TIFFGetField(tiff, TIFFTAG_SAMPLESPERPIXEL, &samples);
      TIFFGetField(tiff, TIFFTAG_COMPRESSION, &compression);
      EXPECT_EQ(depth, bits);
      EXPECT_EQ(samples, image.channels.size());
      EXPECT_EQ(compression, COMPRESSION_ADOBE_DEFLATE);
      if (alpha) {
        ASSERT_EQ(TIFFGetField(tiff, TIFFTAG_EXTRASAMPLES, &extra, &kinds), 1);
        EXPECT_EQ(kinds[0], EXTRASAMPLE_UNASSALPHA);
      }
      ASSERT_EQ(TIFFGetField(tiff, TIFFTAG_IMAGEDESCRIPTION, &text), 1);
      EXPECT_STREQ(text, "hyades.job: glass ünd fog\nhyades.samples: 64");
      ASSERT_EQ(TIFFGetField(tiff, TIFFTAG_SOFTWARE, &text), 1);
      EXPECT_TRUE(std::string(text).starts_with("hyades "));
      uint32_t size = 0;
      uint8_t* profile = nullptr;
      ASSERT_EQ(TIFFGetField(tiff, TIFFTAG_ICCPROFILE, &size, &profile), 1);
      EXPECT_EQ(std::vector<uint8_t>(profile, profile + size), icc_profile(ColorTag::srgb));
      const float largest = bits == 8 ? 255.0F : 65535.0F;
      std::vector<uint8_t> row(static_cast<size_t>(TIFFScanlineSize(tiff)));
      for (int y = 0; y < image.height; ++y) {
        ASSERT_EQ(TIFFReadScanline(tiff, row.data(), static_cast<uint32_t>(y)), 1);
        for (size_t i = 0; i < image.channels.size() * 37; ++i) {
          const float expected =
              image.data[static_cast<size_t>(y) * image.channels.size() * 37 + i];
          const float found = bits == 8 ? row[i] : reinterpret_cast<const uint16_t*>(row.data())[i];
          ASSERT_NEAR(found, expected * largest, 0.51) << y << " " << i;
        }
      }
      TIFFClose(tiff);
      // The same picture is the same bytes.
      const std::string first = bytes_of(path);
      ASSERT_TRUE(write_tiff(path, image, kTexts, {bits, ColorTag::srgb}).ok());
      EXPECT_EQ(bytes_of(path), first);
    }
  }
}

TEST(WriteTiff, WhereItCannotBeWrittenIsOneError) {
  const test::TempFolder folder;
  const Status failed = write_tiff(folder.file("none/a.tif"), ramp({"R", "G", "B"}));
  ASSERT_FALSE(failed.ok());
  EXPECT_EQ(failed.error().message.find("cannot write"), 0U);
  EXPECT_FALSE(write_tiff(folder.file("a.tif"), ramp({"X"})).ok());
}

TEST(WritePng, SixteenBitsAndWhatItsNumbersMean) {
  const test::TempFolder folder;
  const std::string path = folder.file("a.png");
  const Image image = ramp({"R", "G", "B", "A"});
  ASSERT_TRUE(write_png(path, image, kTexts, {16, ColorTag::linear}).ok());
  const auto back = read_image_file(path, ColorSpace::linear);
  ASSERT_TRUE(back.ok());
  for (size_t i = 0; i < image.data.size(); ++i) {
    ASSERT_NEAR(back->data[i], image.data[i], 0.51 / 65535) << i;
  }
  const auto texts = read_png_texts(path);
  ASSERT_TRUE(texts.ok());
  EXPECT_EQ(*texts, kTexts);
  const auto says = [&](const char* chunk) {
    return bytes_of(path).find(chunk) != std::string::npos;
  };
  EXPECT_TRUE(says("gAMA") && says("cHRM"));
  EXPECT_FALSE(says("sRGB"));
  ASSERT_TRUE(write_png(path, image, {}, {8, ColorTag::none}).ok());
  EXPECT_FALSE(says("gAMA") || says("sRGB"));
  ASSERT_TRUE(write_png(path, image).ok());
  EXPECT_TRUE(says("sRGB"));
}

TEST(WriteJpeg, HoldsProfileAndTexts) {
  const test::TempFolder folder;
  const std::string path = folder.file("a.jpg");
  ASSERT_TRUE(write_jpeg(path, ramp({"R", "G", "B"}), 92, kTexts).ok());
  const std::string file = bytes_of(path);
  EXPECT_NE(file.find("ICC_PROFILE"), std::string::npos);
  EXPECT_NE(file.find(as_text(icc_profile(ColorTag::srgb))), std::string::npos);
  EXPECT_NE(file.find("hyades.job: glass ünd fog\nhyades.samples: 64"), std::string::npos);
  ASSERT_TRUE(write_jpeg(path, ramp({"R", "G", "B"}), 92, {}, ColorTag::none).ok());
  EXPECT_EQ(bytes_of(path).find("ICC_PROFILE"), std::string::npos);
  EXPECT_TRUE(read_image_file(path).ok());
}

TEST(WriteExr, SaysWhichPrimaries) {
  const test::TempFolder folder;
  ASSERT_TRUE(write_exr(folder.file("a.exr"), ramp({"R", "G", "B"}), kTexts).ok());
  const Imf::InputFile file(folder.file("a.exr").c_str());
  ASSERT_TRUE(Imf::hasChromaticities(file.header()));
  const Imf::Chromaticities& told = Imf::chromaticities(file.header());
  EXPECT_FLOAT_EQ(told.red.x, 0.64F);
  EXPECT_FLOAT_EQ(told.green.y, 0.60F);
  EXPECT_FLOAT_EQ(told.blue.y, 0.06F);
  EXPECT_FLOAT_EQ(told.white.x, 0.3127F);
}

}  // namespace
}  // namespace hyades::core
