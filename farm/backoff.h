#pragma once

#include <algorithm>
#include <chrono>
#include <cstdint>
#include <random>

namespace hyades::farm {

/// How long to wait before trying again: twice as long each time, up to a limit, and each time a
/// random part of it, so that a thousand callers do not come back at once. Everybody who tries
/// again waits by this.
class Backoff {
 public:
  using Duration = std::chrono::steady_clock::duration;

  /// The first wait and the longest. Equal seeds wait
  /// equally.
  Backoff(Duration first, Duration limit, uint32_t seed = std::random_device{}())
      : first_(first), limit_(limit), next_(first), random_(seed) {}

  /// Between a half and the whole of the current wait, after what the other side `asked` for.
  Duration next(Duration asked = Duration(0)) {
    const Duration wait = next_;
    next_ = std::min(next_ * 2, limit_);
    const double share = std::uniform_real_distribution<double>(0.5, 1.0)(random_);
    return asked + std::chrono::duration_cast<Duration>(wait * share);
  }

  /// After success.
  void reset() { next_ = first_; }

 private:
  Duration first_;
  Duration limit_;
  Duration next_;
  std::minstd_rand random_;
};

/// Of workers whose stream has ended. The limit is a part of what a coordinator waits for them
/// after its restart (ControllerOptions::adoption_time).
inline constexpr std::chrono::milliseconds kFirstReconnect{200};
inline constexpr std::chrono::milliseconds kLongestReconnect{3000};

}  // namespace hyades::farm
