#pragma once

#include <cstdint>
#include <memory>

#include "core/base/vec.h"

namespace hyades::core {

/// Names one sample of one pixel. `pixel` is a full-frame coordinate, so crops and tiles see the
/// same numbers.
struct SampleId {
  uint64_t seed = 0;
  uint32_t frame = 0;
  Vec2i pixel{0, 0};
  uint32_t sample = 0;  ///< index within the pixel, from 0 over all batches
};

/// A stream of numbers in [0, 1) that is a pure function of (SampleId, dimension): random access,
/// no state shared between samples. One object per thread, restarted for every sample.
///
/// Dimensions are handed out in order. Integrators call set_dimension at the start of each bounce
/// so that the same decision has the same dimension in every path (stratification survives
/// branches that consume different amounts).
class Sampler {
 public:
  virtual ~Sampler() = default;

  /// Begins sample `id` at dimension 0.
  virtual void start(const SampleId& id) = 0;

  /// The next number handed out is that of dimension `dimension`.
  virtual void set_dimension(uint32_t dimension) = 0;

  /// One number in [0, 1). Never 1, also after rounding to float.
  virtual float next_1d() = 0;

  /// Two numbers that are stratified together, in [0, 1)^2. Starts at an even dimension.
  virtual Vec2 next_2d() = 0;

  /// Four numbers at once: what next_2d, next_1d and next_1d hand out from the next dimension that
  /// is a multiple of four, for less work.
  virtual Vec4 next_4d() = 0;
};

enum class SamplerKind { sobol, independent };

/// Owen-scrambled Sobol points (default), or independent numbers (for tests).
std::unique_ptr<Sampler> make_sampler(SamplerKind kind);

}  // namespace hyades::core
