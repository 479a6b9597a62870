#pragma once

#include <chrono>
#include <cstddef>
#include <map>
#include <string>

namespace hyades::farm {

/// What each of many has lately used of something that they share, such as a thread's time: whoever
/// has used least shall have it next. Not thread-safe.
class FairShares {
 public:
  using Time = std::chrono::steady_clock::time_point;

  /// `who` has used `amount` more, until `now`.
  void use(const std::string& who, double amount, Time now);

  /// What `who` has used: what was ten minutes ago counts half, and so on. 0 for who is not known,
  /// or not any more, as of very many only those are who have used most.
  double used(const std::string& who, Time now) const;

 private:
  struct Share {
    double amount = 0;
    Time at;
  };
  static double now_worth(const Share& share, Time now);

  std::map<std::string, Share> shares_;
};

}  // namespace hyades::farm
