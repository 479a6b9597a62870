#include "coordinator/web/connection_count.h"

#include <algorithm>

namespace hyades::coordinator {

bool ConnectionCount::may_come(const Neighbour& owner) const {
  if (open_ >= most_) return false;
  if (owner.is_own_user) return true;
  const auto known = open_of_.find(owner.name);
  if (known == open_of_.end()) return true;
  return known->second < std::max(sure_, std::min(most_of_one_, (most_ - open_) / 4));
}

void ConnectionCount::enter(const Neighbour& owner) {
  ++open_;
  ++open_of_[owner.name];
}

void ConnectionCount::leave(const Neighbour& owner) {
  const auto known = open_of_.find(owner.name);
  if (known == open_of_.end()) return;
  --open_;
  if (--known->second == 0) open_of_.erase(known);
}

}  // namespace hyades::coordinator
