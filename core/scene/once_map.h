#pragma once

#include <functional>
#include <map>
#include <memory>
#include <type_traits>

#include "core/base/mutex.h"
#include "core/base/result.h"

namespace hyades::core {

/// Values that are made once per key, by whoever asks first, and held as `Held`: a shared_ptr (made
/// once and for all) or a weak_ptr (made again when nobody uses it any more). Who asks for the same
/// key meanwhile waits for that one only; other keys go on. What could not be made is tried again
/// by the next who asks. Thread-safe.
template <class Key, class Value, class Held, class Less>
class MapOfMade {
 public:
  using Pointer = std::shared_ptr<const Value>;

  /// The value of `key`; `make()` returns a Result<Pointer>.
  template <class Make>
  Result<Pointer> get(const Key& key, const Make& make) {
    const std::shared_ptr<Slot> slot = slot_of(key);
    const MutexLock lock(slot->mutex);
    if (Pointer value = alive(slot->value)) return value;
    Result<Pointer> made = make();
    if (made) slot->value = *made;
    return made;
  }

  /// Calls visit(value) for everything made so far that is still there, waiting for what is being
  /// made.
  template <class Visit>
  void for_each(const Visit& visit) const {
    const MutexLock lock(mutex_);
    for (const auto& [key, slot] : slots_) {
      const MutexLock slot_lock(slot->mutex);
      if (const Pointer value = alive(slot->value)) visit(*value);
    }
  }

 private:
  using Weak = std::weak_ptr<const Value>;

  struct Slot {
    Mutex mutex;  ///< held while the value is made
    Held value HYADES_GUARDED_BY(mutex);
  };

  static Pointer alive(const Pointer& held) { return held; }
  static Pointer alive(const Weak& held) { return held.lock(); }

  std::shared_ptr<Slot> slot_of(const Key& key) {
    const MutexLock lock(mutex_);
    auto& slot = slots_[key];
    if (slot) return slot;
    slot = std::make_shared<Slot>();
    const std::shared_ptr<Slot> fresh = slot;
    if constexpr (std::is_same_v<Held, Weak>) drop_unused();
    return fresh;
  }

  /// Slots that nobody else holds, nor can get hold of meanwhile, and whose values are gone.
  void drop_unused() HYADES_REQUIRES(mutex_) {
    std::erase_if(slots_, [](const auto& row) {
      if (row.second.use_count() > 1) return false;
      const MutexLock slot_lock(row.second->mutex);
      return row.second->value.expired();
    });
  }

  mutable Mutex mutex_;
  std::map<Key, std::shared_ptr<Slot>, Less> slots_ HYADES_GUARDED_BY(mutex_);
};

/// Kept as long as the map is.
template <class Key, class Value, class Less = std::less<Key>>
using OnceMap = MapOfMade<Key, Value, std::shared_ptr<const Value>, Less>;

/// Kept only as long as somebody uses them.
template <class Key, class Value, class Less = std::less<Key>>
using WeakMap = MapOfMade<Key, Value, std::weak_ptr<const Value>, Less>;

}  // namespace hyades::core
