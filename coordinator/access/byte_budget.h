#pragma once

#include <cstdint>
#include <map>
#include <string>

#include "coordinator/access/caller.h"
#include "core/base/mutex.h"

namespace hyades::coordinator {

/// How many bytes are held at once, and for whom, so that nobody fills the memory or takes the
/// room of all others. Thread-safe.
class ByteBudget {
 public:
  /// At most `most` are held, and for one owner (owner_of) at most `most_of_one`.
  ByteBudget(uint64_t most, uint64_t most_of_one) : most_(most), most_of_one_(most_of_one) {}

  /// Whether so many more may be held for the owner.
  bool has_room(const std::string& owner, uint64_t bytes) const;
  /// Counts bytes as held from now on if so many more may be held for the owner; whether they may.
  bool try_take(const std::string& owner, uint64_t bytes);
  /// Counts bytes that are held from now on, whether there is room or not.
  void take(const std::string& owner, uint64_t bytes);
  /// Counts bytes that are not held any more; as many for each owner as were taken.
  void give_back(const std::string& owner, uint64_t bytes);

  /// Whom a caller's bytes are counted for: the name of his token, or where he has none that part
  /// of the network that he comes from (neighbourhood_of()).
  static std::string owner_of(const Caller& caller);

 private:
  bool fits(const std::string& owner, uint64_t bytes) const HYADES_REQUIRES(mutex_);
  void add(const std::string& owner, uint64_t bytes) HYADES_REQUIRES(mutex_);

  const uint64_t most_;
  const uint64_t most_of_one_;
  mutable core::Mutex mutex_;
  uint64_t held_ HYADES_GUARDED_BY(mutex_) = 0;
  std::map<std::string, uint64_t> held_for_ HYADES_GUARDED_BY(mutex_);
};

}  // namespace hyades::coordinator
