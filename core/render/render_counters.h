#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "core/film/fixed128.h"
#include "core/film/unit.h"
#include "core/integrators/integrator.h"

namespace hyades::core {

/// The largest magnitude of a sample's radiance (times its filter weight), albedo and normal that
/// counts, about 3.4e10: sums of batches stay well within what a film can hold.
inline constexpr float kMaxSample = kMaxDeposit / static_cast<float>(2 * kBatchSamples);

/// Why `sample` does not count, in words that fit behind "this sample is not counted: "; nothing
/// where it does.
std::optional<std::string> why_not_counted(const PixelSample& sample);

/// What is wrong with samples that do not count, in words that fit behind "they are ": "not finite
/// or beyond 3.44e+10".
std::string bad_sample_words();

/// A sample that does not count, for it is not finite or beyond kMaxSample: left out of the film
/// (as if it were black), reported so that it can be replayed.
struct BadSample {
  Vec2i pixel{0, 0};
  uint32_t sample = 0;
};

/// What rendering a unit took.
struct RenderCounters {
  uint64_t samples = 0;  ///< of whole batches, bad ones too
  uint64_t rays = 0;
  uint64_t bounces = 0;
  uint64_t bad_samples = 0;         ///< and single splats that do not count
  std::vector<BadSample> examples;  ///< the first few bad ones

  void add(const RenderCounters& other);
};

}  // namespace hyades::core
