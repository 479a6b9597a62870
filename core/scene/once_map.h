#pragma once

#include <map>
#include <memory>
#include <mutex>

#include "core/base/result.h"

namespace hyades::core {

/// Values that are made once per key, by whoever asks first. Who asks for the same key meanwhile
/// waits for that one only; other keys go on. What could not be made is tried again by the next who
/// asks. Thread-safe.
template <class Key, class Value>
class OnceMap {
 public:
  using Pointer = std::shared_ptr<const Value>;

  /// The value of `key`; `make()` returns a Result<Pointer>.
  template <class Make>
  Result<Pointer> get(const Key& key, const Make& make) {
    const std::shared_ptr<Slot> slot = slot_of(key);
    const std::lock_guard lock(slot->mutex);
    if (slot->value) return slot->value;
    Result<Pointer> made = make();
    if (made) slot->value = *made;
    return made;
  }

  /// Calls visit(value) for everything made so far, waiting for what is being made.
  template <class Visit>
  void for_each(const Visit& visit) const {
    const std::lock_guard lock(mutex_);
    for (const auto& [key, slot] : slots_) {
      const std::lock_guard slot_lock(slot->mutex);
      if (slot->value) visit(*slot->value);
    }
  }

 private:
  struct Slot {
    std::mutex mutex;  ///< held while the value is made
    Pointer value;     ///< guarded by mutex
  };

  std::shared_ptr<Slot> slot_of(const Key& key) {
    const std::lock_guard lock(mutex_);
    auto& slot = slots_[key];
    if (!slot) slot = std::make_shared<Slot>();
    return slot;
  }

  mutable std::mutex mutex_;
  std::map<Key, std::shared_ptr<Slot>> slots_;  ///< guarded by mutex_
};

}  // namespace hyades::core
