#pragma once

#include <chrono>

#include "farm/backoff.h"

namespace hyades::cli {

/// When to try a failed call again, and when to give up: waits grow from 0.1 s to 5 s as
/// farm::Backoff has them.
class Patience {
 public:
  using Clock = std::chrono::steady_clock;

  /// `first`, `later`: seconds without an answer, before and after the first one.
  Patience(double first, double later) : first_(first), later_(later) {}

  /// An answer came: patience is whole again.
  void reached() {
    reached_ = true;
    waiting_ = false;
    backoff_.reset();
  }

  bool was_reached() const { return reached_; }

  /// The wait in seconds before the next try at `now`, more than `asked_for` if there
  /// is so much time; negative: give up.
  double next_wait(Clock::time_point now, double asked_for = 0);

 private:
  double first_;
  double later_;
  bool reached_ = false;
  bool waiting_ = false;
  Clock::time_point since_;
  farm::Backoff backoff_{std::chrono::milliseconds(100), std::chrono::seconds(5)};
};

}  // namespace hyades::cli
