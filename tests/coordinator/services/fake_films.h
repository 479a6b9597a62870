#pragma once

#include <algorithm>
#include <cstdint>
#include <vector>

#include "core/base/hash.h"
#include "core/film/film.h"

namespace hyades::coordinator {

/// The film of a unit, without light: noise that depends on nothing but frame, pixel and sample.
inline core::Film fake_film(const core::Unit& unit, uint32_t samples,
                            const core::FilmLayout& layout) {
  core::Film film(layout, unit.tile);
  std::vector<float> values(static_cast<size_t>(unit.tile.area()) *
                            static_cast<size_t>(layout.deposited));
  for (uint32_t b = unit.batches.first; b < unit.batches.end(); ++b) {
    const uint32_t n = core::samples_in_batch(b, samples);
    size_t i = 0;
    for (int y = unit.tile.y0; y < unit.tile.y1; ++y) {
      for (int x = unit.tile.x0; x < unit.tile.x1; ++x) {
        for (int c = 0; c < layout.deposited; ++c) {
          uint64_t h = core::hash_combine(static_cast<uint64_t>(unit.frame), b);
          h = core::hash_combine(h, (static_cast<uint64_t>(x) << 32U) | static_cast<uint64_t>(y));
          h = core::hash_combine(h, static_cast<uint64_t>(c));
          values[i++] = static_cast<float>(static_cast<double>(h >> 11U) * 0x1p-53 * n);
        }
      }
    }
    film.deposit(unit.tile, b, n, values);
  }
  return film;
}

}  // namespace hyades::coordinator
