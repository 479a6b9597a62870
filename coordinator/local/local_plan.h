#pragma once

#include <cstdint>
#include <functional>
#include <string>
#include <vector>

#include "coordinator/scheduler/ids.h"
#include "coordinator/store/log_files.h"
#include "core/base/hash.h"
#include "core/base/rect.h"
#include "core/film/unit.h"

namespace hyades::coordinator {

/// What a run on this machine renders. No field but `frames`, `region`, `samples` and `batches` can
/// change a bit of a film.
struct LocalPlan {
  std::vector<int32_t> frames;  ///< in this order; no number twice
  core::PixelRect region;       ///< of every frame
  uint32_t samples = 1;         ///< per pixel, of the whole job
  core::BatchRange batches;     ///< which of these are rendered; none: all of them
  int threads = 1;
  int32_t tile_size = 32;  ///< pixels; a resumed run keeps what it began with
  uint64_t shuffle = 0;    ///< not 0: take tiles in a random order (tests)

  uint32_t frames_in_flight = 3;  ///< films and scenes that may be in memory at once
  Duration unit_time = std::chrono::milliseconds(500);  ///< what one unit shall take one thread
  /// Films that may wait for the disk before the threads wait too.
  uint64_t max_waiting_bytes = uint64_t{512} << 20U;
};

/// The batches that the plan renders.
inline core::BatchRange batches_of(const LocalPlan& plan) {
  return plan.batches.count > 0 ? plan.batches
                                : core::BatchRange{0, core::batch_count(plan.samples)};
}

using FrameKey = core::Sha256;

/// Where the run keeps its films.
struct LocalLog {
  std::string folder;  ///< empty: nothing is kept, the run cannot be resumed
  /// Hash of what decides a frame's pixels: a kept film of another key is never mixed in, it ends
  /// the run before it begins. Called by many threads. All frames have the same key where it is
  /// empty.
  std::function<FrameKey(int32_t frame)> frame_key;
  /// Continue with what the folder holds; otherwise it is emptied first.
  bool resume = false;
  /// The log is rewritten when it has grown by this much, and by as much as the films take.
  uint64_t compact_bytes = uint64_t{256} << 20U;
  /// The run ends with an error when nothing could be stored for this long.
  Duration patience = std::chrono::seconds(30);
  LogFiles* files = nullptr;  ///< the disk where null
  /// Called by the log's thread: so long took the disk to make a group of films durable.
  std::function<void(std::chrono::nanoseconds took)> on_sync{};
};

}  // namespace hyades::coordinator
