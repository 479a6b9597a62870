#pragma once

#include <chrono>
#include <cstddef>
#include <set>
#include <string>
#include <utility>

namespace hyades::coordinator {

/// Neighbourhoods of which somebody has shown a token lately: the last thousands of them at least,
/// and those of a day. Knows no clock. Not thread-safe.
class TrustedNeighbours {
 public:
  using Time = std::chrono::steady_clock::time_point;

  /// Each is trusted for `time` at least, unless more than `most` have come since.
  explicit TrustedNeighbours(std::chrono::hours time = std::chrono::hours(24), size_t most = 4096)
      : time_(time), most_(most) {}

  /// In two generations, so that nothing has to be looked through.
  void trust(const std::string& neighbourhood, Time now) {
    if (now_.size() >= most_ || now - since_ >= time_) {
      before_ = std::exchange(now_, {});
      since_ = now;
    }
    now_.insert(neighbourhood);
  }
  bool contains(const std::string& neighbourhood) const {
    return now_.contains(neighbourhood) || before_.contains(neighbourhood);
  }

 private:
  std::chrono::hours time_;
  size_t most_;
  std::set<std::string> now_;     ///< since `since_`
  std::set<std::string> before_;  ///< of the time before
  Time since_{};
};

}  // namespace hyades::coordinator
