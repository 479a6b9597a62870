#include "core/finish/denoise.h"

#include <gtest/gtest.h>

#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <string>

#include "core/base/hash.h"
#include "core/finish/frame_outputs.h"
#include "core/image/read_image.h"
#include "tests/support/temp_folder.h"

namespace hyades::core {
namespace {

constexpr int kWidth = 96;
constexpr int kHeight = 64;
constexpr float kNoise = 0.2F;  ///< standard deviation of a pixel

/// Sum of twelve numbers: mean 0, variance 1.
float bell(uint64_t name) {
  float sum = -6.0F;
  for (uint64_t i = 0; i < 12; ++i)
    sum += static_cast<float>(mix64(hash_combine(name, i)) >> 40) * 0x1p-24F;
  return sum;
}

/// Without noise: a ramp from left to right on a board of light and dark squares, whose colour the
/// albedo knows.
float truth(int x, int y) {
  const float albedo = (x / 16 + y / 16) % 2 == 0 ? 0.8F : 0.2F;
  return albedo * (1.0F + static_cast<float>(x) / kWidth);
}

Image noisy_picture(bool with_layers) {
  std::vector<std::string> names = {"R", "G", "B", "A"};
  if (with_layers) {
    for (const char* name : {"variance.R", "variance.G", "variance.B", "albedo.R", "albedo.G",
                             "albedo.B", "normal.X", "normal.Y", "normal.Z"})
      names.emplace_back(name);
  }
  Image image = make_image(kWidth, kHeight, names);
  for (int y = 0; y < kHeight; ++y) {
    for (int x = 0; x < kWidth; ++x) {
      for (int c = 0; c < 3; ++c) {
        const auto name = static_cast<uint64_t>((y * kWidth + x) * 3 + c);
        image.at(x, y, c) = truth(x, y) + kNoise * bell(name);
        if (!with_layers) continue;
        image.at(x, y, 4 + c) = kNoise * kNoise;
        image.at(x, y, 7 + c) = (x / 16 + y / 16) % 2 == 0 ? 0.8F : 0.2F;
      }
      image.at(x, y, 3) = 1.0F;
    }
  }
  return image;
}

double mean_square_error(const Image& image) {
  double sum = 0.0;
  for (int y = 0; y < kHeight; ++y) {
    for (int x = 0; x < kWidth; ++x) {
      for (int c = 0; c < 3; ++c) {
        const double d = double{image.at(x, y, c)} - double{truth(x, y)};
        sum += d * d;
      }
    }
  }
  return sum / (3.0 * kWidth * kHeight);
}

Image cleaned(const Image& noisy, int threads = 1) {
  auto clean = denoise(noisy, Denoiser::features, threads);
  EXPECT_TRUE(clean) << clean.error().message;
  return std::move(*clean);
}

TEST(Denoise, TakesMostOfTheNoiseAndLeavesWhatTheFeaturesKnow) {
  const Image noisy = noisy_picture(true);
  const Image clean = cleaned(noisy);
  const double before = mean_square_error(noisy);
  EXPECT_NEAR(before, kNoise * kNoise, 0.1 * kNoise * kNoise);
  EXPECT_LT(mean_square_error(clean), before / 10.0);
  // Edges of squares: were they blurred, pixels beside them would lie between.
  for (const int x : {15, 16, 47, 48}) {
    float sum = 0.0F;
    for (int y = 0; y < 16; ++y) sum += clean.at(x, y, 0) / 16.0F;
    EXPECT_NEAR(sum, truth(x, 0), 0.06F) << x;
  }
}

TEST(Denoise, KeepsDetailsBelowTheNoiseThatTheAlbedoTellsOf) {
  Image picture = noisy_picture(true);
  for (int y = 0; y < kHeight; ++y) {
    for (int x = 0; x < kWidth; ++x) {
      for (int c = 0; c < 3; ++c) {
        picture.at(x, y, c) += 0.5F + 0.1F * static_cast<float>(x % 2) - truth(x, y);
        picture.at(x, y, 7 + c) = x % 2 == 0 ? 0.2F : 0.8F;
      }
    }
  }
  const Image clean = cleaned(picture);
  double contrast = 0.0;
  for (int y = 0; y < kHeight; ++y) {
    for (int x = 0; x < kWidth; ++x)
      contrast += (x % 2 == 0 ? -1.0 : 1.0) * double{clean.at(x, y, 0)};
  }
  EXPECT_NEAR(contrast / (kWidth * kHeight / 2), 0.1, 0.02);
}

TEST(Denoise, GuessesNoiseThatNobodyMeasured) {
  const Image noisy = noisy_picture(false);
  EXPECT_LT(mean_square_error(cleaned(noisy)), mean_square_error(noisy) / 3.0);
}

TEST(Denoise, OneBatchOfSplatsIsNoMeasureOfNoise) {
  Image noisy = noisy_picture(true);
  noisy.channels.emplace_back("samples.N");
  std::vector<float> data;
  for (int i = 0; i < kWidth * kHeight; ++i) {
    const float* pixel = &noisy.data[static_cast<size_t>(i) * 13];
    data.insert(data.end(), pixel, pixel + 13);
    // A third of the pixels were hit by light paths, which are all that is measured.
    for (size_t c = 4; c < 7; ++c) data[data.size() - 13 + c] = i % 3 == 0 ? 1e-4F : 0.0F;
    data.push_back(16.0F);
  }
  noisy.data = std::move(data);
  EXPECT_LT(mean_square_error(cleaned(noisy)), mean_square_error(noisy_picture(true)) / 3.0);
}

TEST(Denoise, LeavesAPictureWithoutNoiseAsItIs) {
  Image picture = noisy_picture(true);
  for (int y = 0; y < kHeight; ++y) {
    for (int x = 0; x < kWidth; ++x) {
      for (int c = 0; c < 3; ++c) {
        // Details of single pixels that no feature tells of.
        picture.at(x, y, c) = 0.5F + 0.4F * static_cast<float>((x * 7 + y * 13) % 3);
        picture.at(x, y, 4 + c) = 1e-10F;
      }
    }
  }
  const Image clean = cleaned(picture);
  for (int y = 0; y < kHeight; ++y) {
    for (int x = 0; x < kWidth; ++x) EXPECT_NEAR(clean.at(x, y, 1), picture.at(x, y, 1), 1e-3F);
  }
}

TEST(Denoise, DampsFirefliesButNoHighlights) {
  Image picture = noisy_picture(true);
  for (int c = 0; c < 3; ++c) {
    picture.at(30, 30, c) = 500.0F;  // one path of many
    picture.at(30, 30, 4 + c) = 500.0F * 500.0F;
    picture.at(60, 30, c) = 500.0F;  // all paths
    picture.at(60, 30, 4 + c) = 1.0F;
  }
  const Image clean = cleaned(picture);
  EXPECT_LT(clean.at(30, 30, 0), 3.0F);
  EXPECT_LT(clean.at(33, 30, 0), 3.0F);
  EXPECT_GT(clean.at(60, 30, 0), 250.0F);
}

// Where a lamp is found by one path in a thousand, a quarter of the pixels has one: they are no
// single fireflies, and their light belongs to all.
TEST(Denoise, SpreadsTheLightOfLuckyPathsThatAreMany) {
  Image picture = noisy_picture(true);
  double before = 0.0;
  for (int y = 0; y < kHeight; ++y) {
    for (int x = 0; x < kWidth; ++x) {
      const bool lucky = mix64(static_cast<uint64_t>(y * kWidth + x)) % 4 == 0;
      for (int c = 0; c < 3; ++c) {
        picture.at(x, y, c) =
            (lucky ? 2.0F : 0.2F) + 0.02F * bell(static_cast<uint64_t>((y * kWidth + x) * 3 + c));
        picture.at(x, y, 4 + c) = lucky ? 1.8F * 1.8F : 0.02F * 0.02F;
        picture.at(x, y, 7 + c) = 0.5F;
      }
      before += double{picture.at(x, y, 0)};
    }
  }
  const Image clean = cleaned(picture);
  double after = 0.0;
  double squares = 0.0;
  for (int y = 0; y < kHeight; ++y) {
    for (int x = 0; x < kWidth; ++x) {
      after += double{clean.at(x, y, 0)};
      squares += double{clean.at(x, y, 0)} * double{clean.at(x, y, 0)};
    }
  }
  constexpr double kPixels = kWidth * kHeight;
  EXPECT_NEAR(after / before, 1.0, 0.05);
  EXPECT_LT(std::sqrt(squares / kPixels - (after / kPixels) * (after / kPixels)), 0.1);
}

// Fine stripes between lamps, of less contrast than what the lamps' edges make a pixel differ: were
// those taken for noise, stripes would go for 3 pixels around.
TEST(Denoise, TakesTheEdgesOfLampsForNoNoise) {
  constexpr float kLamp = 30.0F;
  const auto lamp = [](int x, int y) { return x % 24 < 5 && y % 16 < 4; };
  for (const bool measured : {false, true}) {
    Image picture = noisy_picture(measured);
    for (int y = 0; y < kHeight; ++y) {
      for (int x = 0; x < kWidth; ++x) {
        for (int c = 0; c < 3; ++c) {
          const auto name = static_cast<uint64_t>((y * kWidth + x) * 3 + c);
          const float around = (y % 2 == 0 ? 0.6F : 0.3F) + 0.005F * bell(name);
          picture.at(x, y, c) = lamp(x, y) ? kLamp : around;
          if (!measured) continue;
          // What few batches say of a lamp that some of them see the edge of.
          picture.at(x, y, 4 + c) = lamp(x, y) ? 2.0F : 0.005F * 0.005F;
          picture.at(x, y, 7 + c) = 0.5F;
        }
      }
    }
    const Image clean = cleaned(picture);
    double error = 0.0;
    int pixels = 0;
    for (int y = 0; y < kHeight; ++y) {
      for (int x = 0; x < kWidth; ++x) {
        if (lamp(x, y)) continue;
        error += std::abs(double{clean.at(x, y, 1)} - (y % 2 == 0 ? 0.6 : 0.3));
        ++pixels;
      }
    }
    EXPECT_LT(error / pixels, 0.01) << measured;
  }
}

TEST(Denoise, IsTheSameWithAnyThreads) {
  const Image noisy = noisy_picture(true);
  EXPECT_EQ(cleaned(noisy, 1).data, cleaned(noisy, 3).data);
}

TEST(Denoise, SurvivesPixelsThatAreNoNumbers) {
  Image noisy = noisy_picture(true);
  noisy.at(10, 10, 0) = NAN;
  noisy.at(20, 10, 1) = INFINITY;
  noisy.at(30, 10, 5) = NAN;
  noisy.at(40, 10, 8) = INFINITY;
  noisy.at(50, 10, 11) = -INFINITY;
  for (const float value : cleaned(noisy).data) EXPECT_TRUE(std::isfinite(value));
}

TEST(Denoise, NeedsColour) {
  const auto clean = denoise(make_image(4, 4, {"Y"}), Denoiser::features);
  ASSERT_FALSE(clean);
  EXPECT_EQ(clean.error().message, "there are no channels R, G, B to be denoised");
}

/// While it lives, the program finds Open Image Denoise where `path` says.
class OidnAt {
 public:
  explicit OidnAt(const std::string& path) { setenv("HYADES_OIDN", path.c_str(), 1); }
  ~OidnAt() { unsetenv("HYADES_OIDN"); }
  OidnAt(const OidnAt&) = delete;
  OidnAt& operator=(const OidnAt&) = delete;
};

TEST(OpenImageDenoise, IsNamedWhereItIsMissing) {
  const OidnAt nowhere("/nowhere/libOpenImageDenoise.so");
  const auto clean = denoise(noisy_picture(true), Denoiser::oidn);
  ASSERT_FALSE(clean);
  EXPECT_NE(clean.error().message.find("HYADES_OIDN: /nowhere/libOpenImageDenoise.so"),
            std::string::npos)
      << clean.error().message;
  EXPECT_EQ(denoise(noisy_picture(true), Denoiser::automatic, 1)->data,
            cleaned(noisy_picture(true)).data)
      << "without it, ours";
}

TEST(OpenImageDenoise, IsGivenWhatItNeeds) {
  // tests/support/oidn_stand_in: output = color + 10 albedo + 100 normal, where it is asked for
  // HDR.
  const OidnAt stand_in(HYADES_OIDN_STAND_IN);
  Image noisy = noisy_picture(true);
  for (int y = 0; y < kHeight; ++y) {
    for (int x = 0; x < kWidth; ++x) {
      for (int c = 0; c < 3; ++c) {
        noisy.at(x, y, c) = std::abs(noisy.at(x, y, c));
        noisy.at(x, y, 10 + c) = static_cast<float>(c) - 1.0F;
      }
    }
  }
  for (const Denoiser denoiser : {Denoiser::oidn, Denoiser::automatic}) {
    const auto clean = denoise(noisy, denoiser);
    ASSERT_TRUE(clean) << clean.error().message;
    for (int c = 0; c < 3; ++c) {
      EXPECT_NEAR(
          clean->at(70, 20, c),
          noisy.at(70, 20, c) + 10.0F * noisy.at(70, 20, 7 + c) + 100.0F * noisy.at(70, 20, 10 + c),
          1e-4F);
    }
  }
}

TEST(OpenImageDenoise, SaysWhatWentWrong) {
  const OidnAt stand_in(HYADES_OIDN_STAND_IN);
  const auto clean = denoise(make_image(13, 13, {"R", "G", "B"}), Denoiser::oidn);
  ASSERT_FALSE(clean);
  EXPECT_EQ(clean.error().message, "Open Image Denoise: 13 is an unlucky number");
}

/// Outputs of a frame that is `noisy_picture` in one batch.
TEST(Denoise, OutputsShowItAndKeepTheNoisyLayers) {
  const test::TempFolder folder;
  LayerSet layers;
  layers.albedo = layers.normal = true;
  const FilmLayout layout = make_film_layout(layers);
  Film film(layout, {0, 0, kWidth, kHeight});
  const Image noisy = noisy_picture(true);
  std::vector<float> sums;
  for (int y = 0; y < kHeight; ++y) {
    for (int x = 0; x < kWidth; ++x) {
      for (int c = 0; c < 4; ++c) sums.push_back(16.0F * std::abs(noisy.at(x, y, c)));
      for (int c = 7; c < 13; ++c) sums.push_back(16.0F * noisy.at(x, y, c));
    }
  }
  film.deposit({0, 0, kWidth, kHeight}, 0, 16, sums);
  FilmInfo info;
  info.frame = 1;
  info.width = kWidth;
  info.height = kHeight;
  OutputDesc plain;
  plain.file = "plain.exr";
  OutputDesc both = plain;
  both.file = "both.exr";
  both.denoise = "features";
  both.layers = {"beauty", "alpha"};
  OutputDesc shown = both;
  shown.file = "shown.png";
  shown.tone_map = "linear";
  const std::vector<OutputDesc> outputs = {plain, both, shown};
  const auto written = write_outputs(outputs, folder.path().string(), info, film);
  ASSERT_TRUE(written) << written.error().message;

  const auto before = read_image_file(folder.file("plain.exr"));
  const auto after = read_image_file(folder.file("both.exr"));
  const auto png = read_image_file(folder.file("shown.png"), ColorSpace::linear);
  ASSERT_TRUE(before && after && png);
  const int first = after->find_channel("denoised.R");
  ASSERT_GE(first, 0);
  EXPECT_EQ(before->find_channel("denoised.R"), -1);
  double change = 0.0;
  for (int y = 0; y < kHeight; ++y) {
    for (int x = 0; x < kWidth; ++x) {
      EXPECT_EQ(after->at(x, y, after->find_channel("R")),
                before->at(x, y, before->find_channel("R")));
      const float clean = after->at(x, y, first);
      EXPECT_NEAR(png->at(x, y, 0), std::min(clean, 1.0F), 0.6F / 255.0F);
      change += std::abs(double{clean} - double{before->at(x, y, 0)});
    }
  }
  EXPECT_GT(change / (kWidth * kHeight), 0.05);
}

}  // namespace
}  // namespace hyades::core
