#pragma once

#include <cstdint>

#include "core/base/hash.h"
#include "core/samplers/sampler.h"

namespace hyades::core {

/// Steps of a Weyl sequence: distinct counters hashed from distinct multiples are independent.
inline constexpr uint64_t kGoldenGamma = 0x9E3779B97F4A7C15ULL;

/// What all samples of one pixel share: a hash of everything in `id` but the sample index.
inline uint64_t pixel_key(const SampleId& id) {
  const uint64_t pixel = static_cast<uint64_t>(static_cast<uint32_t>(id.pixel.x)) << 32 |
                         static_cast<uint32_t>(id.pixel.y);
  return hash_combine(hash_combine(id.seed, id.frame), pixel);
}

}  // namespace hyades::core
