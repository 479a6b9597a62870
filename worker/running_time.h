#pragma once

#include <algorithm>
#include <chrono>
#include <optional>

namespace hyades::worker {

/// Time in which this process ran: while the machine slept, or the person had pressed Ctrl-Z,
/// nobody else got on either. No clock of its own.
class RunningTime {
 public:
  using TimePoint = std::chrono::steady_clock::time_point;
  using Duration = std::chrono::steady_clock::duration;

  /// To be told often what time it is; two ticks are never taken for more than a second apart.
  /// What has passed since the first.
  Duration tick(TimePoint now) {
    constexpr Duration kLongestTick = std::chrono::seconds(1);
    if (ticked_) time_ += std::clamp<Duration>(now - *ticked_, Duration(0), kLongestTick);
    ticked_ = now;
    return time_;
  }
  Duration passed() const { return time_; }

 private:
  Duration time_{0};
  std::optional<TimePoint> ticked_;
};

}  // namespace hyades::worker
