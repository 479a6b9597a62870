#pragma once

#include <chrono>
#include <functional>
#include <random>

namespace hyades::cli {

/// When to try a failed call again, and when to give up: waits grow from 0.1 s to 5 s, each
/// shortened by up to a half by chance, so that clients which lost the same coordinator do not come
/// back as one.
class Patience {
 public:
  using Clock = std::chrono::steady_clock;

  /// `first`, `later`: seconds without an answer, before and after the first one.
  Patience(double first, double later) : first_(first), later_(later) {}

  /// An answer came: patience is whole again.
  void reached() {
    reached_ = true;
    waiting_ = false;
    next_ = kShortest;
  }

  bool was_reached() const { return reached_; }

  /// The wait in seconds before the next try at `now`, at least `asked_for`; negative: give up.
  double next_wait(Clock::time_point now, double asked_for = 0);

 private:
  static constexpr double kShortest = 0.1;
  static constexpr double kLongest = 5.0;

  double first_;
  double later_;
  bool reached_ = false;
  bool waiting_ = false;
  Clock::time_point since_;
  double next_ = kShortest;
  std::mt19937_64 random_{std::random_device{}()};
};

}  // namespace hyades::cli
