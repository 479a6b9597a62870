#include "coordinator/scheduler/batch_map.h"

#include <algorithm>
#include <bit>
#include <cstddef>

namespace hyades::coordinator {
namespace {

/// Calls visit(word within the tile, mask of the range's bits in it) for every word of `range`.
template <class Visit>
void for_each_word(core::BatchRange range, Visit visit) {
  for (uint32_t at = range.first; at < range.end();) {
    const uint32_t end = std::min(range.end(), (at / 64 + 1) * 64);
    const uint32_t bits = end - at;
    const uint64_t ones = bits == 64 ? ~uint64_t{0} : (uint64_t{1} << bits) - 1;
    visit(at / 64, ones << (at % 64));
    at = end;
  }
}

}  // namespace

BatchMap::BatchMap(uint32_t tiles, uint32_t batches)
    : words_per_tile_((batches + 63) / 64), words_(tiles) {}

uint64_t BatchMap::memory(uint64_t tiles, uint64_t batches) {
  return tiles * (sizeof(Words) + (batches + 63) / 64 * sizeof(uint64_t));
}

BatchMap::Words& BatchMap::words_to_set(uint32_t tile) {
  Words& words = words_[tile];
  if (words.empty()) words.resize(words_per_tile_);
  return words;
}

void BatchMap::set(uint32_t tile, core::BatchRange range) {
  Words& words = words_to_set(tile);
  for_each_word(range, [&](size_t w, uint64_t mask) { words[w] |= mask; });
}

void BatchMap::clear(uint32_t tile, core::BatchRange range) {
  Words& words = words_[tile];
  if (words.empty()) return;
  for_each_word(range, [&](size_t w, uint64_t mask) { words[w] &= ~mask; });
}

uint32_t BatchMap::count(uint32_t tile, core::BatchRange range) const {
  uint32_t n = 0;
  for_each_word(range, [&](size_t w, uint64_t mask) {
    n += static_cast<uint32_t>(std::popcount(bits(tile, w) & mask));
  });
  return n;
}

std::optional<core::BatchRange> BatchMap::first_free(const BatchMap& a, const BatchMap& b,
                                                     uint32_t tile, core::BatchRange range) {
  uint32_t at = range.first;
  const auto taken_from = [&](uint32_t batch) {
    const size_t w = batch / 64;
    return (a.bits(tile, w) | b.bits(tile, w)) >> (batch % 64);
  };
  while (at < range.end()) {
    const uint64_t taken = taken_from(at);
    const uint32_t skip = static_cast<uint32_t>(std::countr_one(taken));
    if (skip == 0) break;
    at += std::min(skip, 64 - at % 64);
  }
  if (at >= range.end()) return std::nullopt;
  uint32_t end = at;
  while (end < range.end()) {
    const uint32_t left = 64 - end % 64;
    const uint32_t zeros = std::min(left, static_cast<uint32_t>(std::countr_zero(taken_from(end))));
    end += zeros;
    if (zeros < left) break;
  }
  return core::BatchRange{at, std::min(end, range.end()) - at};
}

uint32_t BatchMap::count_free(const BatchMap& a, const BatchMap& b, uint32_t tile,
                              core::BatchRange range) {
  uint32_t n = 0;
  for_each_word(range, [&](size_t w, uint64_t mask) {
    const uint64_t taken = a.bits(tile, w) | b.bits(tile, w);
    n += static_cast<uint32_t>(std::popcount(~taken & mask));
  });
  return n;
}

}  // namespace hyades::coordinator
