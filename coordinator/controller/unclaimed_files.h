#pragma once

#include <cstdint>
#include <map>
#include <string>
#include <unordered_map>
#include <unordered_set>

#include "core/base/mutex.h"

namespace hyades::coordinator {

/// Whole files that owners have uploaded since the coordinator's start and that no job has had yet:
/// what OwnerLimits::bytes counts beside unfinished ones. Thread-safe.
class UnclaimedFiles {
 public:
  /// The owner's upload of the file, named by its content, is whole. It counts for the first who
  /// has brought it.
  void add(const std::string& owner, const std::string& name, uint64_t size);
  /// A job has the file, or it is gone: it counts for nobody.
  void remove(const std::string& name);
  /// Only these are still there, and no job has them.
  void keep_only(const std::unordered_set<std::string>& names);
  /// Bytes of the owner's.
  uint64_t bytes_of(const std::string& owner) const;

 private:
  struct Claimable {
    std::string owner;
    uint64_t bytes = 0;
  };
  mutable core::Mutex mutex_;
  std::unordered_map<std::string, Claimable> files_ HYADES_GUARDED_BY(mutex_);
  std::map<std::string, uint64_t> bytes_ HYADES_GUARDED_BY(mutex_);  ///< by owner
};

}  // namespace hyades::coordinator
