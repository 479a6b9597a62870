#pragma once

#include <chrono>
#include <cstddef>
#include <limits>
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

  /// Of those who wait in [first, last) the first one whose owner has used least; `last` where none
  /// may be next. `owner_of(*one)` is the owner's name, null for one that may not be next.
  template <class Iterator, class OwnerOf>
  Iterator next(Iterator first, Iterator last, Time now, const OwnerOf& owner_of) const {
    Iterator best = last;
    double least = std::numeric_limits<double>::infinity();
    for (; first != last && least > 0; ++first) {
      const std::string* owner = owner_of(*first);
      if (owner == nullptr) continue;
      const double its = used(*owner, now);
      if (its >= least) continue;
      least = its;
      best = first;
    }
    return best;
  }

 private:
  struct Share {
    double amount = 0;
    Time at;
  };
  static double now_worth(const Share& share, Time now);

  std::map<std::string, Share> shares_;
};

}  // namespace hyades::farm
