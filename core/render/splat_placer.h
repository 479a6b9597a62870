#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "core/base/rect.h"
#include "core/film/fixed128.h"
#include "core/film/splats.h"
#include "core/integrators/integrator.h"
#include "core/integrators/light_parts.h"
#include "core/samplers/filter.h"

namespace hyades::core {

/// The largest magnitude of a splat that counts. It may be far larger than a pixel's value: it
/// stands for as many pixels as the film has.
inline constexpr float kMaxSplat = 1024.0F * kMaxDeposit;

/// Whether `splat` counts: it is finite and not beyond kMaxSplat.
bool counts(const PixelSplat& splat);

/// Adds `splat`, in parts that a film can hold where it is large; nothing where it is black. False
/// where it does not count.
bool add_splat(const PixelSplat& splat, std::vector<PixelSplat>& into);

/// The splats of a batch.
struct BatchSplats {
  std::vector<PixelSplat> beauty;
  std::vector<std::vector<PixelSplat>> parts;  ///< of each part of light

  void clear();
};

/// Which pixel a splat counts for. A splat at x is an estimate of filter(x - centre) times its
/// value for every pixel; instead of all those within the filter's reach one gets it, chosen with
/// probability |filter(x - centre)| / S, where S is the sum of |filter| over them: it gets S times
/// the value, with the filter's sign. The mean is the same, for every shape of filter.
class SplatPlacer {
 public:
  /// `radius`: of the filter, pixels, > 0. `region`: full-frame pixels that there are.
  SplatPlacer(const PixelFilter& filter, float radius, PixelRect region)
      : filter_(filter), radius_(radius), region_(region) {}

  /// What `splat` brings to which pixel; nothing where that is outside of the region. `random`: 64
  /// independent bits.
  std::optional<PixelSplat> place(const Splat& splat, uint64_t random) const;

  /// Adds `splat` and its `parts`, which all count for the pixel that `random` says. False where it
  /// would be somewhere, but does not count.
  bool add(const Splat& splat, std::span<const SplatPart> parts, uint64_t random,
           BatchSplats& into) const;

 private:
  struct Choice {
    int pixel = 0;        ///< column or row
    float weight = 0.0F;  ///< S with the sign of the filter; 0: there is none
  };
  Choice choose(float at, float u) const;

  const PixelFilter& filter_;
  float radius_;
  PixelRect region_;
};

}  // namespace hyades::core
