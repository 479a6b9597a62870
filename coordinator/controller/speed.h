#pragma once

#include <cstdint>

#include "coordinator/scheduler/ids.h"

namespace hyades::coordinator {

/// How fast samples become durable, smoothed over some ten seconds.
class Speed {
 public:
  /// Notes that `done` samples in all are durable at `now`. Time in which nobody renders (not
  /// `busy`) and what comes in it do not count.
  void note(uint64_t done, TimePoint now, bool busy);
  /// So many samples of those that are noted next were rendered long ago.
  void skip(uint64_t samples) { done_ += samples; }
  /// Samples per second; 0: not known yet.
  double per_second() const { return seconds_ > 0 ? samples_ / seconds_ : 0; }
  /// Whether it was measured for long enough to tell how long the rest takes: in the first seconds
  /// scenes are read, and what comes says little.
  bool tells_rest() const;

 private:
  TimePoint last_;
  uint64_t done_ = 0;
  double samples_ = 0;  ///< lately, what is longer ago counting less
  double seconds_ = 0;  ///< that these took, counted alike
  int lumps_ = 0;       ///< so often something has come, up to as often as is asked for
};

}  // namespace hyades::coordinator
