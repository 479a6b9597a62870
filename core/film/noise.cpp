#include "core/film/noise.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>
#include <optional>

#include "core/base/elementary.h"

namespace hyades::core {
namespace {

/// How many blocks a picture is judged by, along each side.
constexpr int32_t kBlocksAlong = 8;
/// Luminance of linear Rec.709 (ITU-R BT.709-6, item 3.2).
constexpr double kWeights[3] = {0.2126, 0.7152, 0.0722};
/// Luminance below which it is as dark as it gets.
constexpr double kDarkest = 1e-4;

/// What a pixel shows, and the variance of that.
struct PixelEstimate {
  double luminance = 0;
  double variance = 0;
};

/// Nothing where the pixel holds fewer than two batches. `paths`: of all of the film, where it has
/// splats.
std::optional<PixelEstimate> estimate_pixel(const Film& film, int x, int y, double paths) {
  const FilmLayout& layout = film.layout();
  const double n = to_double(film.sum(x, y, layout.samples));
  const double batches = std::ceil(n / kBatchSamples);
  if (batches < 2) return std::nullopt;
  PixelEstimate pixel;
  for (int c = 0; c < 3; ++c) {
    const double sum = to_double(film.sum(x, y, c));
    const double squares = to_double(film.sum(x, y, layout.moment2 + c));
    // Variance of the mean over batches, as in Film::normalised. Colours vary together, so
    // that their weighted deviations add rather than their variances; this is the safe side.
    const double spread = std::max(0.0, squares - sum * sum / n) / (batches - 1) / n;
    pixel.variance += kWeights[c] * spread;
    pixel.luminance += kWeights[c] * sum / n;
    if (!layout.layers.splats) continue;
    const SplatLayer::Sums splats = film.splats().at(x, y);
    const auto i = static_cast<size_t>(c);
    pixel.luminance += kWeights[c] * to_double(splats.value[i]) / paths;
    pixel.variance +=
        kWeights[c] * to_double(splats.square[i]) * kSplatSquareUnit / (paths * paths);
  }
  return pixel;
}

/// See tile_noise().
double block_noise(const Film& film, const PixelRect& block, double scale, double paths = 0) {
  double variance = 0;
  double luminance = 0;
  for (int y = block.y0; y < block.y1; ++y) {
    for (int x = block.x0; x < block.x1; ++x) {
      const auto pixel = estimate_pixel(film, x, y, paths);
      if (!pixel) return std::numeric_limits<double>::infinity();
      variance += pixel->variance;
      luminance += pixel->luminance;
    }
  }
  const auto pixels = static_cast<double>(block.area());
  const double shown = std::max(kDarkest, scale * luminance / pixels);
  return scale * std::sqrt(variance / pixels) / std::max(shown, std::sqrt(shown));
}

}  // namespace

NoiseThreshold make_noise_threshold(const NoiseAim& aim, uint32_t samples) {
  NoiseThreshold threshold{aim, {}};
  if (aim.noise <= 0) return threshold;
  const uint32_t all = batch_count(samples);
  for (uint32_t round = std::max(2U, batch_count(aim.min_samples)); round < all;
       round += std::max(1U, round / 2)) {
    threshold.rounds.push_back(round);
  }
  return threshold;
}

double tile_noise(const Film& film, const PixelRect& tile, float exposure) {
  const double scale = exp2(exposure);
  double worst = 0;
  for (int32_t y = tile.y0; y < tile.y1; y += kNoiseBlock) {
    for (int32_t x = tile.x0; x < tile.x1; x += kNoiseBlock) {
      const PixelRect block = intersection(tile, {x, y, x + kNoiseBlock, y + kNoiseBlock});
      worst = std::max(worst, block_noise(film, block, scale));
    }
  }
  return worst;
}

double picture_noise(const Film& film, float exposure) {
  const PixelRect& window = film.window();
  const double scale = exp2(exposure);
  const double paths = film.layout().layers.splats ? film.all_samples() : 0;
  const auto step_of = [](int32_t pixels) {
    return std::max(kNoiseBlock, pixels / kBlocksAlong / kNoiseBlock * kNoiseBlock);
  };
  const int32_t down = step_of(window.height());
  const int32_t across = step_of(window.width());
  double sum = 0;
  int judged = 0;
  int blocks = 0;
  for (int32_t y = window.y0 + down / 2; y < window.y1; y += down) {
    for (int32_t x = window.x0 + across / 2; x < window.x1; x += across) {
      const PixelRect block = intersection(window, {x, y, x + kNoiseBlock, y + kNoiseBlock});
      const double noise = block_noise(film, block, scale, paths);
      ++blocks;
      if (!std::isfinite(noise)) continue;
      sum += noise;
      ++judged;
    }
  }
  return judged > 0 && 4 * judged >= 3 * blocks ? sum / judged : -1;
}

bool is_clean(const Film& film, const PixelRect& tile, const NoiseThreshold& threshold) {
  return tile_noise(film, tile, threshold.aim.exposure) <= double{threshold.aim.noise};
}

std::vector<PixelRect> unfinished_tiles(const Film& film, const PixelRect& crop, uint32_t samples,
                                        const NoiseThreshold& threshold) {
  const uint32_t all = batch_count(samples);
  const auto has_enough = [&](const PixelRect& tile) {
    if (!film.window().contains(tile)) return false;
    if (film.coverage().contains({tile, {0, all}})) return true;
    // The last round that is there; beyond it nothing may be.
    const auto round =
        std::find_if(threshold.rounds.rbegin(), threshold.rounds.rend(), [&](uint32_t batches) {
          return film.coverage().contains({tile, {0, batches}});
        });
    if (round == threshold.rounds.rend()) return false;
    return !film.coverage().overlap({tile, {*round, all - *round}}) &&
           is_clean(film, tile, threshold);
  };
  const auto begin_of = [](int32_t at) {
    return at - ((at % kJudgedTile) + kJudgedTile) % kJudgedTile;
  };
  std::vector<PixelRect> tiles;
  for (int32_t y = begin_of(crop.y0); y < crop.y1; y += kJudgedTile) {
    for (int32_t x = begin_of(crop.x0); x < crop.x1; x += kJudgedTile) {
      const PixelRect tile = intersection(crop, {x, y, x + kJudgedTile, y + kJudgedTile});
      if (!has_enough(tile)) tiles.push_back(tile);
    }
  }
  return tiles;
}

}  // namespace hyades::core
