#pragma once

#include <algorithm>
#include <cstdint>

#include "coordinator/scheduler/ids.h"

namespace hyades::coordinator {

/// How many batches of a tile make up one unit: as many as take one thread `unit_time`, where one
/// takes `batch_seconds` (above 0); but where the `left` batches that may still be leased are few
/// for `threads`, not so many that the threads would end far apart. At least 1.
inline uint64_t run_length(double batch_seconds, Duration unit_time, uint64_t left,
                           uint64_t threads) {
  const auto by_time =
      static_cast<uint64_t>(std::clamp(seconds(unit_time) / batch_seconds, 1.0, 1e6));
  const uint64_t by_spread = left / (4 * std::max<uint64_t>(threads, 1));
  return std::max<uint64_t>(1, std::min(by_time, by_spread));
}

}  // namespace hyades::coordinator
