#pragma once

#include <algorithm>
#include <chrono>

namespace hyades::farm {

/// How often something may happen: `burst` times at once, and `per_second` times a second from then
/// on.
class TokenBucket {
 public:
  using TimePoint = std::chrono::steady_clock::time_point;

  TokenBucket(double burst, double per_second, TimePoint now)
      : burst_(burst), per_second_(per_second), left_(burst), asked_(now) {}

  /// Whether it may happen now, which is counted then. `now` never goes back.
  bool take(TimePoint now) {
    const std::chrono::duration<double> passed = now - asked_;
    left_ = std::min(burst_, left_ + passed.count() * per_second_);
    asked_ = now;
    if (left_ < 1) return false;
    left_ -= 1;
    return true;
  }

  /// When somebody last asked.
  TimePoint asked() const { return asked_; }

 private:
  double burst_;
  double per_second_;
  double left_;
  TimePoint asked_;
};

}  // namespace hyades::farm
