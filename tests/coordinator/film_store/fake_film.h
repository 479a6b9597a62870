#pragma once

#include <algorithm>
#include <cstdint>
#include <string>
#include <utility>
#include <vector>

#include "core/base/hash.h"
#include "core/film/film.h"
#include "core/film/unit.h"

namespace hyades::coordinator {

/// The value of a sample's channel: noise that depends on nothing but its arguments.
inline double fake_sample(int32_t frame, int x, int y, uint32_t sample, int channel) {
  uint64_t h = core::hash_combine(static_cast<uint64_t>(frame), static_cast<uint64_t>(x));
  h = core::hash_combine(h, static_cast<uint64_t>(y));
  h = core::hash_combine(h, (uint64_t{sample} << 8U) | static_cast<uint64_t>(channel));
  return static_cast<double>(h >> 11U) * 0x1p-53;
}

/// The film of a unit, without light: what the real renderer does with its samples. Where there is
/// a `region`, every batch of a pixel splats onto one of it.
inline core::Film fake_film(const core::Unit& unit, uint32_t samples,
                            const core::PixelRect& region = {}) {
  const core::FilmLayout layout =
      core::make_film_layout({.depth = true, .splats = !region.empty()});
  core::Film film(layout, unit.tile, region);
  std::vector<core::PixelSplat> splats;
  const auto channels = static_cast<size_t>(film.layout().deposited);
  std::vector<float> values(static_cast<size_t>(unit.tile.area()) * channels);
  for (uint32_t b = unit.batches.first; b < unit.batches.end(); ++b) {
    const uint32_t n = core::samples_in_batch(b, samples);
    size_t i = 0;
    for (int y = unit.tile.y0; y < unit.tile.y1; ++y) {
      for (int x = unit.tile.x0; x < unit.tile.x1; ++x) {
        for (int c = 0; c < film.layout().deposited; ++c) {
          double sum = 0;
          double least = 2;
          for (uint32_t s = 0; s < n; ++s) {
            const double v = fake_sample(unit.frame, x, y, b * core::kBatchSamples + s, c);
            sum += v;
            least = std::min(least, v);
          }
          values[i++] = static_cast<float>(c == film.layout().depth ? least : sum);
        }
        if (region.empty()) continue;
        const float value = values[i - 1];
        const auto area = static_cast<double>(region.area());
        const double where = fake_sample(unit.frame, x, y, b, 99) * area;
        splats.push_back({static_cast<uint32_t>(where), {value, 2 * value, 1.0F}});
      }
    }
    film.deposit(unit.tile, b, n, values);
  }
  if (!region.empty()) film.deposit_splats(std::move(splats));
  return film;
}

/// What every way of rendering must give.
inline std::string oracle_digest(int32_t frame, const core::PixelRect& region, uint32_t samples,
                                 const core::PixelRect& splat_region = {}) {
  return fake_film({frame, region, {0, core::batch_count(samples)}}, samples, splat_region)
      .digest();
}

}  // namespace hyades::coordinator
