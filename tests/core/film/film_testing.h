#pragma once

#include <cmath>
#include <cstdint>
#include <limits>
#include <vector>

#include "core/base/hash.h"
#include "core/film/film.h"

namespace hyades::core {

inline const LayerSet kAllLayers{true, true, true};

/// What a renderer would give: a pure function of pixel, batch and channel.
inline float rendered(int x, int y, uint32_t batch, int channel, const FilmLayout& layout) {
  const uint64_t pixel = hash_combine(static_cast<uint32_t>(x), static_cast<uint32_t>(y));
  const uint64_t random = hash_combine(pixel, hash_combine(batch, static_cast<uint32_t>(channel)));
  const float u = static_cast<float>(random % 0x1000000) * 0x1p-24F;
  if (channel == layout.depth) {
    return u < 0.2F ? std::numeric_limits<float>::infinity() : 10.0F * u;
  }
  const float sign = channel >= 5 && u < 0.3F ? -1.0F : 1.0F;
  return sign * std::ldexp(0.5F + u, static_cast<int>((random >> 32U) % 30) - 20);
}

/// A film of one tile with some of its batches, of a job of `samples` samples per pixel.
inline Film render(const FilmLayout& layout, const PixelRect& tile, BatchRange batches,
                   uint32_t samples, const PixelRect& region) {
  Film film(layout, tile, region);
  std::vector<float> values(static_cast<size_t>(tile.area()) *
                            static_cast<size_t>(layout.deposited));
  for (uint32_t b = batches.first; b < batches.end(); ++b) {
    size_t i = 0;
    for (int y = tile.y0; y < tile.y1; ++y) {
      for (int x = tile.x0; x < tile.x1; ++x) {
        for (int c = 0; c < layout.deposited; ++c) values[i++] = rendered(x, y, b, c, layout);
      }
    }
    film.deposit(tile, b, samples_in_batch(b, samples), values);
  }
  return film;
}

inline Film render(const FilmLayout& layout, const PixelRect& tile, BatchRange batches,
                   uint32_t samples = 1000000) {
  return render(layout, tile, batches, samples, tile);
}

/// A film of `tile` with splats in `region`: two of each sample, a pure function of pixel and
/// batch.
inline Film render_with_splats(const FilmLayout& layout, const PixelRect& tile, BatchRange batches,
                               const PixelRect& region, uint32_t samples = 1000000) {
  Film film = render(layout, tile, batches, samples, region);
  std::vector<PixelSplat> splats;
  for (uint32_t b = batches.first; b < batches.end(); ++b) {
    for (int y = tile.y0; y < tile.y1; ++y) {
      for (int x = tile.x0; x < tile.x1; ++x) {
        for (uint32_t i = 0; i < 2 * samples_in_batch(b, samples); ++i) {
          const uint64_t path =
              hash_combine(hash_combine(static_cast<uint32_t>(x), static_cast<uint32_t>(y)), b);
          const uint64_t random = hash_combine(path, i);
          PixelSplat splat;
          splat.pixel = static_cast<uint32_t>(random % static_cast<uint64_t>(region.area()));
          for (uint32_t c = 0; c < 3; ++c) {
            splat.value[c] =
                std::ldexp(static_cast<float>(hash_combine(random, c) % 0x1000000) - 1e6F,
                           static_cast<int>(random >> 32U) % 12 - 20);
          }
          splats.push_back(splat);
        }
      }
    }
  }
  film.deposit_splats(std::move(splats));
  return film;
}

}  // namespace hyades::core
