#pragma once

#include <chrono>
#include <cstdint>

namespace hyades::core {

/// Microseconds since 1970, UTC.
inline int64_t wall_us() {
  return std::chrono::duration_cast<std::chrono::microseconds>(
             std::chrono::system_clock::now().time_since_epoch())
      .count();
}

/// Milliseconds since 1970, UTC.
inline int64_t wall_ms() { return wall_us() / 1000; }

}  // namespace hyades::core
