#include "core/finish/denoise.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <string>
#include <utility>
#include <vector>

#include "core/film/unit.h"
#include "core/finish/feature_filter.h"
#include "core/finish/open_image_denoise.h"

namespace hyades::core {
namespace {

using Channels = std::array<int, 3>;

/// From -1..1 to half a unit, so that a fold counts about as much as a change of colour.
constexpr float kNormalScale = 0.5F;

Channels find_channels(const Image& image, const std::string& layer, const char* names) {
  Channels found{};
  for (size_t c = 0; c < 3; ++c) found[c] = image.find_channel(layer + names[c]);
  return found;
}

bool complete(const Channels& channels) {
  return std::all_of(channels.begin(), channels.end(), [](int c) { return c >= 0; });
}

/// What is finite and no less than 0 of a channel's value.
float light(float x) { return x > 0.0F && std::isfinite(x) ? x : 0.0F; }

/// Mean over the square of `radius` around each pixel.
std::vector<Rgb> blurred(const std::vector<Rgb>& in, int width, int height, int radius) {
  std::vector<Rgb> rows(in.size());
  std::vector<Rgb> out(in.size());
  const auto at = [width](int x, int y) {
    return static_cast<size_t>(y) * static_cast<size_t>(width) + static_cast<size_t>(x);
  };
  for (int y = 0; y < height; ++y) {
    for (int x = 0; x < width; ++x) {
      const int first = std::max(x - radius, 0);
      const int last = std::min(x + radius, width - 1);
      Rgb sum(0.0F);
      for (int i = first; i <= last; ++i) sum += in[at(i, y)];
      rows[at(x, y)] = sum / static_cast<float>(last - first + 1);
    }
  }
  for (int y = 0; y < height; ++y) {
    for (int x = 0; x < width; ++x) {
      const int first = std::max(y - radius, 0);
      const int last = std::min(y + radius, height - 1);
      Rgb sum(0.0F);
      for (int i = first; i <= last; ++i) sum += rows[at(x, i)];
      out[at(x, y)] = sum / static_cast<float>(last - first + 1);
    }
  }
  return out;
}

/// Whether a pixel as bright as `value` may be so by one lucky path: its standard deviation is
/// about as large. A small highlight that all batches see is none.
bool may_be_chance(float value, const Rgb& variance) {
  return luminance(variance) > 0.06F * value * value;
}

/// Holds pixels that are far brighter than all but two of their 24 neighbours, by chance, down to
/// those: no filter can tell what a single path that found a lamp should have been spread over.
void damp_fireflies(GuidedPicture& picture) {
  constexpr int kRadius = 2;
  constexpr float kTooBright = 2.0F;
  const std::vector<Rgb> original = picture.color;
  const auto at = [&](int x, int y) {
    return static_cast<size_t>(y) * static_cast<size_t>(picture.width) + static_cast<size_t>(x);
  };
  for (int y = 0; y < picture.height; ++y) {
    for (int x = 0; x < picture.width; ++x) {
      std::array<float, 3> brightest{};  // descending
      for (int j = std::max(y - kRadius, 0); j <= std::min(y + kRadius, picture.height - 1); ++j) {
        for (int i = std::max(x - kRadius, 0); i <= std::min(x + kRadius, picture.width - 1); ++i) {
          if (i == x && j == y) continue;
          float value = luminance(original[at(i, j)]);
          for (float& b : brightest) {
            if (value > b) std::swap(value, b);
          }
        }
      }
      const float mine = luminance(original[at(x, y)]);
      const float limit = kTooBright * brightest[2];
      if (!(mine > limit) || !(limit > 0.0F)) continue;
      if (!may_be_chance(mine, picture.variance[at(x, y)])) continue;
      const float scale = limit / mine;
      picture.color[at(x, y)] *= scale;
      picture.variance[at(x, y)] *= scale * scale;
    }
  }
}

/// Noise of each pixel as its own surroundings tell it: along edges there is nothing but noise, so
/// of the second differences in four directions the least one counts.
std::vector<Rgb> least_differences(const GuidedPicture& picture) {
  constexpr std::array<std::array<int, 2>, 4> kDirections = {{{1, 0}, {0, 1}, {1, 1}, {1, -1}}};
  // Of normal numbers with a variance of 1 the least of the four squares, which share a pixel, is
  // 0.42 on average. Somewhat less noise than there is leaves the smallest errors
  // (docs/testing.md).
  constexpr float kMean = 0.55F;
  const auto at = [&](int x, int y) -> const Rgb& {
    x = std::clamp(x, 0, picture.width - 1);
    y = std::clamp(y, 0, picture.height - 1);
    return picture.color[static_cast<size_t>(y) * static_cast<size_t>(picture.width) +
                         static_cast<size_t>(x)];
  };
  std::vector<Rgb> squares;
  squares.reserve(picture.color.size());
  for (int y = 0; y < picture.height; ++y) {
    for (int x = 0; x < picture.width; ++x) {
      Rgb least(0.0F);
      for (size_t k = 0; k < kDirections.size(); ++k) {
        const auto [dx, dy] = kDirections[k];
        const Rgb d = at(x, y) - 0.5F * (at(x + dx, y + dy) + at(x - dx, y - dy));
        const Rgb square = d * d;
        if (k == 0 || luminance(square) < luminance(least)) least = square;
      }
      squares.push_back(least / kMean);
    }
  }
  return squares;
}

/// Where nothing is known of the noise.
std::vector<Rgb> guessed_variance(const GuidedPicture& picture) {
  return blurred(least_differences(picture), picture.width, picture.height, 3);
}

/// What `picture` holds of what helps.
struct Found {
  GuidedPicture guided;
  bool albedo = false;
  bool normal = false;
  float samples = 1e9F;  ///< of the pixel that has fewest; many where it is not known
};

Result<Found> gather(const Image& picture) {
  const Channels color = find_channels(picture, "", "RGB");
  if (!complete(color)) return Error{"there are no channels R, G, B to be denoised"};
  const Channels variance = find_channels(picture, "variance.", "RGB");
  const Channels albedo = find_channels(picture, "albedo.", "RGB");
  const Channels normal = find_channels(picture, "normal.", "XYZ");
  const int alpha = picture.find_channel("A");
  Found found{{}, complete(albedo), complete(normal)};
  GuidedPicture& guided = found.guided;
  guided.width = picture.width;
  guided.height = picture.height;
  const size_t stride = picture.channels.size();
  const size_t pixels = picture.data.size() / stride;
  const int count = picture.find_channel("samples.N");
  guided.color.resize(pixels);
  guided.variance.resize(pixels);
  guided.features.resize(pixels);
  for (size_t i = 0; i < pixels; ++i) {
    const float* in = &picture.data[i * stride];
    GuidedPicture::Features& features = guided.features[i];
    for (size_t k = 0; k < 3; ++k) {
      const int c = static_cast<int>(k);
      guided.color[i][c] = light(in[color[k]]);
      if (complete(variance)) guided.variance[i][c] = light(in[variance[k]]);
      if (found.albedo) features[k] = std::min(light(in[albedo[k]]), 1.0F);
      if (found.normal && std::abs(in[normal[k]]) <= 2.0F)
        features[3 + k] = kNormalScale * in[normal[k]];
    }
    if (alpha >= 0) features[6] = std::min(light(in[alpha]), 1.0F);
    if (count >= 0) found.samples = std::min(found.samples, in[count]);
  }
  return found;
}

/// How far variances are averaged [pixels]: of two or three batches they are mostly noise.
int variance_radius(float samples) { return samples < 48.0F ? 3 : samples < 96.0F ? 2 : 1; }

std::vector<Rgb> filter(GuidedPicture picture, float samples, int threads) {
  // Of one batch only splats have a variance; it says nothing of the rest.
  const bool known = samples > static_cast<float>(kBatchSamples) &&
                     std::any_of(picture.variance.begin(), picture.variance.end(),
                                 [](const Rgb& v) { return max_component(v) > 0.0F; });
  const std::vector<Rgb> guess = guessed_variance(picture);
  if (!known) picture.variance = guess;
  damp_fireflies(picture);
  const std::vector<Rgb> own = picture.variance;
  picture.variance = blurred(own, picture.width, picture.height, variance_radius(samples));
  // Averaging carries the noise of edges and lamps to what is beside them, and away from single
  // pixels that a few lucky paths have brightened: those are alike to nothing then, and stay.
  for (size_t i = 0; i < guess.size(); ++i) {
    const Rgb least = known ? own[i] : Rgb(0.0F);
    picture.variance[i] = glm::max(glm::min(picture.variance[i], guess[i]), least);
  }
  return filter_by_features(picture, threads);
}

std::vector<Rgb> three_features(const GuidedPicture& picture, size_t first, float scale) {
  std::vector<Rgb> out;
  out.reserve(picture.features.size());
  for (const GuidedPicture::Features& f : picture.features) {
    out.emplace_back(f[first] * scale, f[first + 1] * scale, f[first + 2] * scale);
  }
  return out;
}

Result<std::vector<Rgb>> run_network(const OpenImageDenoise& network, const Found& found) {
  OpenImageDenoise::Picture picture;
  picture.width = found.guided.width;
  picture.height = found.guided.height;
  picture.color = found.guided.color;
  if (found.albedo) picture.albedo = three_features(found.guided, 0, 1.0F);
  if (found.normal) picture.normal = three_features(found.guided, 3, 1.0F / kNormalScale);
  return network.run(picture);
}

Result<std::vector<Rgb>> clean(Found found, Denoiser denoiser, int threads) {
  if (denoiser != Denoiser::features) {
    const auto network = OpenImageDenoise::load();
    if (network) return run_network(*network, found);
    if (denoiser == Denoiser::oidn) return network.error();
  }
  return filter(std::move(found.guided), found.samples, threads);
}

}  // namespace

std::optional<Denoiser> find_denoiser(std::string_view name) {
  if (name == "true") return Denoiser::automatic;
  if (name == "features") return Denoiser::features;
  if (name == "oidn") return Denoiser::oidn;
  return std::nullopt;
}

Result<Image> denoise(const Image& picture, Denoiser denoiser, int threads) {
  auto found = gather(picture);
  if (!found) return found.error();
  const auto pixels = clean(std::move(*found), denoiser, threads);
  if (!pixels) return pixels.error();
  Image out = make_image(picture.width, picture.height, {"R", "G", "B"});
  out.placement = picture.placement;
  for (size_t i = 0; i < pixels->size(); ++i) {
    for (size_t c = 0; c < 3; ++c) out.data[3 * i + c] = (*pixels)[i][static_cast<int>(c)];
  }
  return out;
}

}  // namespace hyades::core
