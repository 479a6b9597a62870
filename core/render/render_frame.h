#pragma once

#include <cstdint>
#include <functional>

#include "core/render/frame_renderer.h"

namespace hyades::core {

/// How render_frame cuts its work; no choice changes the bits.
struct RenderFrameOptions {
  int threads = 1;
  int tile_size = 32;  ///< pixels
  uint32_t batches_per_unit = 4;
  bool shuffle = false;  ///< hand units out in a scrambled order (tests)
  /// Told after each unit, by one thread at a time: which share of all is done, 0 to 1.
  std::function<void(double share)> progress{};
};

struct RenderedFrame {
  Film film;
  RenderCounters counters;
};

/// Renders all of `window` (where films have splats, the scene's) in memory, nothing durable: for
/// tests, benchmarks and tools. Jobs go through the scheduler (coordinator/local) instead.
RenderedFrame render_frame(const FrameRenderer& renderer, const PixelRect& window, uint32_t samples,
                           int32_t frame, const RenderFrameOptions& options = {});

}  // namespace hyades::core
