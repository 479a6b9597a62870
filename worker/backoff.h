#pragma once

#include <algorithm>
#include <chrono>
#include <random>

namespace hyades::worker {

/// How long to wait before trying again: twice as long each time, up to a limit, and each time a
/// random part of it, so that a thousand workers do not come back at once.
class Backoff {
 public:
  using Duration = std::chrono::steady_clock::duration;

  explicit Backoff(Duration first = std::chrono::milliseconds(200),
                   Duration limit = std::chrono::seconds(15))
      : first_(first), limit_(limit), next_(first), random_(std::random_device{}()) {}

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

}  // namespace hyades::worker
