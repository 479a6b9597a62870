#pragma once

#include <chrono>
#include <optional>

namespace hyades::worker {

/// Notices that a worker has had nothing to do for long enough. No clock of its own.
class IdleWatch {
 public:
  using TimePoint = std::chrono::steady_clock::time_point;
  using Duration = std::chrono::steady_clock::duration;

  /// `limit`: how long without work; 0: for ever. Time counts from `start` on.
  IdleWatch(Duration limit, TimePoint start) : limit_(limit), since_(start) {}

  /// To be told often whether there is work: whether the limit is reached.
  bool over(TimePoint now, bool busy) {
    if (busy) since_ = now;
    return limit_.count() > 0 && now - since_ >= limit_;
  }

 private:
  const Duration limit_;
  TimePoint since_;
};

}  // namespace hyades::worker
