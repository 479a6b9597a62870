#include "coordinator/web/connection_count.h"

#include <algorithm>

namespace hyades::coordinator {

bool ConnectionCount::may_come(const Neighbour& owner) const {
  const size_t kept = most_ / 8;
  const bool known = known_.contains(owner.name);
  const size_t most = owner.is_own_user ? most_ : known ? most_ - kept / 4 : most_ - kept;
  if (open_ >= most) return false;
  if (owner.is_own_user) return true;
  // Of those who are known, too: one token makes all of a group known.
  const size_t most_of_group = most_ / 2 + (known ? kept / 2 : 0);
  if (!owner.group.empty() && count_of(owner.group) >= most_of_group) return false;
  return count_of(owner.name) < std::max(sure_, std::min(most_of_one_, (most - open_) / 4));
}

size_t ConnectionCount::count_of(const std::string& whose) const {
  const auto found = open_of_.find(whose);
  return found == open_of_.end() ? 0 : found->second;
}

void ConnectionCount::enter(const Neighbour& owner) {
  ++open_;
  add(owner.name, true);
  if (!owner.group.empty()) add(owner.group, true);
}

void ConnectionCount::leave(const Neighbour& owner) {
  if (!open_of_.contains(owner.name)) return;
  --open_;
  add(owner.name, false);
  if (!owner.group.empty()) add(owner.group, false);
}

void ConnectionCount::add(const std::string& whose, bool comes) {
  size_t& count = open_of_[whose];
  count += comes ? 1 : -1;
  if (count == 0) open_of_.erase(whose);
}

}  // namespace hyades::coordinator
