#pragma once

#include <cstdint>

#include "core/base/rect.h"
#include "core/render/frame_renderer.h"

namespace hyades::cli {

/// What samples of a frame cost on this machine.
struct SampleCost {
  double core_seconds = 0;  ///< of one core, whatever else the machine does
  double seconds = 0;       ///< by the clock, where all `threads` render
  bool lit = false;         ///< whether light has reached one of the pixels
};

/// Measures it on small patches that are scattered over `window`, with `threads` threads, until
/// each has used `seconds` of its processor's time, or for `most` seconds by the clock.
SampleCost measure_sample_cost(const core::FrameRenderer& renderer, const core::PixelRect& window,
                               int32_t frame, int threads, double seconds, double most);

}  // namespace hyades::cli
