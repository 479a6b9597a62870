#pragma once

#include <cstdint>
#include <map>
#include <string>
#include <utility>

#include "core/base/mutex.h"

namespace hyades::farm {

/// How many bytes are held at once, and for whom, so that nobody fills the memory or takes the
/// room of all others. Thread-safe.
class ByteBudget {
 public:
  /// Whom bytes are counted for.
  struct Owner {
    std::string name;
    std::string machine{};  ///< one of several that share the name; empty: he has the name alone
  };

  /// At most `most` are held, of one name at most `most_of_one`, and of one machine at most a
  /// quarter of that.
  ByteBudget(uint64_t most, uint64_t most_of_one) : most_(most), most_of_one_(most_of_one) {}

  /// Whether so many more may be held for the owner.
  bool has_room(const Owner& owner, uint64_t bytes) const;

  /// What one holder holds of a budget; nothing any more once this is gone. Not thread-safe.
  class Share {
   public:
    /// A share that holds nothing yet. The budget outlives it.
    Share(ByteBudget& budget, Owner owner) : budget_(budget), owner_(std::move(owner)) {}
    ~Share() { hold(0); }
    Share(const Share&) = delete;
    Share& operator=(const Share&) = delete;

    /// Holds so many bytes from now on, in place of what it held, if there is room for what they
    /// are more; whether there was.
    bool try_hold(uint64_t bytes);
    /// Holds so many bytes from now on, whether there is room or not.
    void hold(uint64_t bytes);

   private:
    ByteBudget& budget_;
    const Owner owner_;
    uint64_t held_ = 0;
  };

 private:
  using Held = std::map<std::string, uint64_t>;
  static std::string machine_of(const Owner& owner);
  bool fits(const Owner& owner, uint64_t bytes) const HYADES_REQUIRES(mutex_);
  bool change(const Owner& owner, uint64_t before, uint64_t after, bool in_any_case);

  const uint64_t most_;
  const uint64_t most_of_one_;
  mutable core::Mutex mutex_;
  uint64_t held_ HYADES_GUARDED_BY(mutex_) = 0;
  Held held_for_ HYADES_GUARDED_BY(mutex_);           ///< by name
  Held held_for_machines_ HYADES_GUARDED_BY(mutex_);  ///< by name and machine
};

}  // namespace hyades::farm
