#pragma once

#include <chrono>
#include <cstdint>
#include <vector>

#include "coordinator/scheduler/ids.h"
#include "coordinator/scheduler/tile_grid.h"
#include "core/base/rect.h"
#include "core/film/noise.h"
#include "core/film/unit.h"

namespace hyades::coordinator {

/// What a run on this machine renders. No field but `frames`, `region`, `samples`, `batches` and
/// `threshold` can change a bit of a film; with a threshold `tile_size` can, too.
struct LocalPlan {
  std::vector<int32_t> frames;     ///< in this order; no number twice
  core::PixelRect region;          ///< of every frame
  uint32_t samples = 1;            ///< per pixel, of the whole job
  core::BatchRange batches;        ///< which of these are rendered; none: all of them
  core::NoiseThreshold threshold;  ///< when a tile has enough of them; not with some batches only
  int threads = 1;
  int32_t tile_size = kTile;  ///< pixels; a resumed run keeps what it began with
  uint64_t shuffle = 0;       ///< not 0: take tiles in a random order (tests)

  uint32_t frames_in_flight = 3;  ///< films and scenes that may be in memory at once
  Duration unit_time = std::chrono::milliseconds(500);  ///< what one unit shall take one thread
};

/// The batches that the plan renders.
inline core::BatchRange batches_of(const LocalPlan& plan) {
  return plan.batches.count > 0 ? plan.batches
                                : core::BatchRange{0, core::batch_count(plan.samples)};
}

}  // namespace hyades::coordinator
