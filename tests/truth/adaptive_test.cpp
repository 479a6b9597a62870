// Pictures whose tiles stop at a noise: they are as clean as was asked, and no darker than others.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <string>
#include <vector>

#include "core/film/noise.h"
#include "core/job/noise_threshold.h"
#include "tests/support/means.h"
#include "tests/truth/render_yaml.h"

namespace hyades::test {
namespace {

constexpr int kTileSide = 32;

/// A matt ball, a glossy and one of glass in a room that is lit by a small lamp and a window.
constexpr const char* kRoom = R"(
hyades: 1
name: room
film: {size: [64, 48]}
sampling: {samples: SAMPLES, noise: NOISE, seed: SEED}
camera: {look_from: [0, 1.2, 4.6], look_at: [0, 0.9, 0], fov: 40}
materials:
  wall: {type: lambert, color: 0.7}
  gloss: {type: glossy, color: [0.6, 0.2, 0.1], reflectiveness: 0.4, glossiness: 0.7}
  glass: {type: dielectric, ior: 1.5}
objects:
  floor: {shape: rectangle, size: [6, 6], material: wall}
  back: {shape: rectangle, size: [6, 6], material: wall, transform: [{rotate_x: 90}], at: [0, 1, -2]}
  matt: {shape: sphere, radius: 0.5, at: [-1.1, 0.5, 0], material: wall}
  shiny: {shape: sphere, radius: 0.5, at: [0, 0.5, -0.5], material: gloss}
  drop: {shape: sphere, radius: 0.5, at: [1.1, 0.5, 0], material: glass}
  lamp: {shape: sphere, radius: 0.15, at: [0.5, 2.4, 0.5], emit: {radiance: 30}}
environment: {color: 0.1}
)";

YamlScene room(double noise, uint64_t seed, int samples = 2048) {
  std::string text = kRoom;
  text.replace(text.find("SAMPLES"), 7, std::to_string(samples));
  text.replace(text.find("NOISE"), 5, std::to_string(noise));
  text.replace(text.find("SEED"), 4, std::to_string(seed));
  return YamlScene(text);
}

/// The picture as its tiles need it: what LocalRun and a farm give, in the plainest way.
core::Film render_tiles(const YamlScene& scene) {
  const core::NoiseThreshold threshold = core::noise_threshold(scene.job());
  const core::PixelRect window = core::render_window(scene.job().film);
  const uint32_t all = core::batch_count(scene.job().sampling.samples);
  core::Film whole(scene.renderer().layout(), window);
  for (int y = window.y0; y < window.y1; y += kTileSide) {
    for (int x = window.x0; x < window.x1; x += kTileSide) {
      const core::PixelRect tile = core::intersection(window, {x, y, x + kTileSide, y + kTileSide});
      core::Film film(scene.renderer().layout(), tile);
      uint32_t done = 0;
      const auto render_to = [&](uint32_t batches) {
        const core::Unit unit{1, tile, {done, batches - done}};
        EXPECT_TRUE(film.merge(scene.renderer().render(unit).film).ok());
        done = batches;
      };
      for (const uint32_t round : threshold.rounds) {
        render_to(round);
        if (core::is_clean(film, tile, threshold)) break;
      }
      if (!core::is_clean(film, tile, threshold)) render_to(all);
      EXPECT_TRUE(whole.merge(film).ok());
    }
  }
  return whole;
}

double luminance(const core::Image& image, int x, int y) {
  constexpr std::array<double, 3> kWeights = {0.2126, 0.7152, 0.0722};
  double sum = 0;
  for (int c = 0; c < 3; ++c) {
    sum += kWeights[static_cast<size_t>(c)] * double{image.at(x, y, c)};
  }
  return sum;
}

/// 8 x 8 pixels of a picture.
struct Block {
  double luminance = 0;  ///< in truth
  double error = 0;      ///< mean square
};

std::vector<Block> blocks_of(const core::Image& picture, const core::Image& truth) {
  std::vector<Block> blocks;
  for (int y = 0; y < picture.height; y += core::kNoiseBlock) {
    for (int x = 0; x < picture.width; x += core::kNoiseBlock) {
      Block block;
      for (int v = y; v < y + core::kNoiseBlock; ++v) {
        for (int u = x; u < x + core::kNoiseBlock; ++u) {
          const double right = luminance(truth, u, v);
          const double off = luminance(picture, u, v) - right;
          block.luminance += right / 64;
          block.error += off * off / 64;
        }
      }
      blocks.push_back(block);
    }
  }
  return blocks;
}

TEST(AdaptiveTruth, NoBlockIsNoisierThanWasAskedFor) {
  constexpr double kNoise = 0.06;
  constexpr int kRuns = 6;
  const core::Image truth = [] {
    core::Film film = room(0, 1000).render().film;  // 2048 samples: an error of a tenth
    return film.normalised();
  }();
  std::vector<double> noise(64 * 48 / 64, 0.0);  // mean squares
  double samples = 0;
  for (int run = 0; run < kRuns; ++run) {
    const core::Film film = render_tiles(room(kNoise, static_cast<uint64_t>(run)));
    samples += film.all_samples() / (64 * 48) / kRuns;
    const std::vector<Block> blocks = blocks_of(film.normalised(), truth);
    for (size_t i = 0; i < blocks.size(); ++i) {
      const double shown = std::max(blocks[i].luminance, std::sqrt(blocks[i].luminance));
      noise[i] += blocks[i].error / (shown * shown) / kRuns;
    }
  }
  const auto noisier =
      std::count_if(noise.begin(), noise.end(), [&](double n) { return std::sqrt(n) > kNoise; });
  double all = 0;
  for (const double n : noise) all += n / static_cast<double>(noise.size());
  RecordProperty("samples", std::to_string(samples));
  RecordProperty("noise", std::to_string(std::sqrt(all)));
  // A block's own noise is known to 4 % by 6 times 64 pixels.
  EXPECT_LE(noisier, 4) << "of " << noise.size();
  EXPECT_LT(std::sqrt(all), kNoise);
  // Nor is much more done than was asked for: what keeps a tile going is its noisiest block.
  EXPECT_GT(std::sqrt(*std::max_element(noise.begin(), noise.end())), 0.8 * kNoise);
  EXPECT_GT(samples, 40.0);
  EXPECT_LT(samples, 1500.0);
}

TEST(AdaptiveTruth, StoppingEarlyMakesPicturesHardlyDarker) {
  Moments adaptive;
  Moments plain;
  for (uint64_t seed = 0; seed < 24; ++seed) {
    adaptive.add(picture_mean(render_tiles(room(0.15, seed))).mean.g);
  }
  for (uint64_t seed = 100; seed < 112; ++seed) {
    plain.add(picture_mean(room(0, seed, 256).render().film).mean.g);
  }
  const double ratio = adaptive.mean() / plain.mean();
  const double sigma =
      std::sqrt(adaptive.variance_of_mean() + plain.variance_of_mean()) / plain.mean();
  RecordProperty("ratio", std::to_string(ratio));
  RecordProperty("sigma", std::to_string(sigma));
  EXPECT_LT(sigma, 0.001) << "or the test could not tell a bias of half a percent";
  EXPECT_NEAR(ratio, 1.0, 0.005);
}

}  // namespace
}  // namespace hyades::test
