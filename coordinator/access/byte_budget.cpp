#include "coordinator/access/byte_budget.h"

#include "coordinator/access/address.h"

namespace hyades::coordinator {

bool ByteBudget::has_room(const std::string& owner, uint64_t bytes) const {
  const core::MutexLock lock(mutex_);
  return fits(owner, bytes);
}

bool ByteBudget::try_take(const std::string& owner, uint64_t bytes) {
  const core::MutexLock lock(mutex_);
  if (!fits(owner, bytes)) return false;
  add(owner, bytes);
  return true;
}

void ByteBudget::take(const std::string& owner, uint64_t bytes) {
  const core::MutexLock lock(mutex_);
  add(owner, bytes);
}

bool ByteBudget::fits(const std::string& owner, uint64_t bytes) const {
  if (held_ + bytes > most_) return false;
  const auto known = held_for_.find(owner);
  return (known == held_for_.end() ? 0 : known->second) + bytes <= most_of_one_;
}

void ByteBudget::add(const std::string& owner, uint64_t bytes) {
  held_for_[owner] += bytes;
  held_ += bytes;
}

void ByteBudget::give_back(const std::string& owner, uint64_t bytes) {
  const core::MutexLock lock(mutex_);
  const auto known = held_for_.find(owner);
  if (known == held_for_.end()) return;
  held_ -= bytes;
  known->second -= bytes;
  if (known->second == 0) held_for_.erase(known);
}

std::string ByteBudget::owner_of(const Caller& caller) {
  return caller.name.empty() ? neighbourhood_of(caller.address) : caller.name;
}

}  // namespace hyades::coordinator
