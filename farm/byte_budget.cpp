#include "farm/byte_budget.h"

namespace hyades::farm {
namespace {

uint64_t at(const std::map<std::string, uint64_t>& held, const std::string& name) {
  const auto known = held.find(name);
  return known == held.end() ? 0 : known->second;
}

/// Whoever holds nothing is forgotten.
void set(std::map<std::string, uint64_t>& held, const std::string& name, uint64_t bytes) {
  if (bytes > 0) {
    held[name] = bytes;
  } else {
    held.erase(name);
  }
}

}  // namespace

bool ByteBudget::has_room(const Owner& owner, uint64_t bytes) const {
  const core::MutexLock lock(mutex_);
  return fits(owner, bytes);
}

bool ByteBudget::Share::try_hold(uint64_t bytes) {
  if (!budget_.change(owner_, held_, bytes, false)) return false;
  held_ = bytes;
  return true;
}

void ByteBudget::Share::hold(uint64_t bytes) {
  budget_.change(owner_, held_, bytes, true);
  held_ = bytes;
}

std::string ByteBudget::machine_of(const Owner& owner) { return owner.name + '\n' + owner.machine; }

bool ByteBudget::fits(const Owner& owner, uint64_t bytes) const {
  return held_ + bytes <= most_ && at(held_for_, owner.name) + bytes <= most_of_one_ &&
         (owner.machine.empty() ||
          at(held_for_machines_, machine_of(owner)) + bytes <= most_of_one_ / 4);
}

bool ByteBudget::change(const Owner& owner, uint64_t before, uint64_t after, bool in_any_case) {
  if (before == after) return true;
  const core::MutexLock lock(mutex_);
  if (!in_any_case && after > before && !fits(owner, after - before)) return false;
  // Unsigned numbers: what is less is added as well.
  const uint64_t more = after - before;
  held_ += more;
  set(held_for_, owner.name, at(held_for_, owner.name) + more);
  if (!owner.machine.empty()) {
    const std::string machine = machine_of(owner);
    set(held_for_machines_, machine, at(held_for_machines_, machine) + more);
  }
  return true;
}

}  // namespace hyades::farm
