#include "coordinator/web/connection_count.h"

#include <algorithm>
#include <utility>

namespace hyades::coordinator {

bool ConnectionCount::may_come(const Neighbour& owner) const {
  const size_t kept = most_ / 8;
  const std::string token = token_key(owner, false);
  const bool known = !token.empty();
  const size_t most = owner.is_own_user ? most_ : known ? most_ - kept / 4 : most_ - kept;
  if (open_ >= most) return false;
  if (owner.is_own_user) return true;
  // By one token all of a group are known, or very many addresses.
  if (open_ >= most_ - kept && count_of(token) >= kept / 2) return false;
  const size_t most_of_group = most_ / 2 + (known ? kept / 2 : 0);
  if (!owner.group.empty() && count_of(owner.group) >= most_of_group) return false;
  return count_of(owner.name) < std::max(sure_, std::min(most_of_one_, (most - open_) / 4));
}

std::string ConnectionCount::token_key(const Neighbour& owner, bool most) const {
  std::string best;
  for (const std::string& token_id : known_.tokens_of(owner.name)) {
    std::string key = "token " + token_id;
    const bool is_better = most ? count_of(key) >= count_of(best) : count_of(key) < count_of(best);
    if (best.empty() || is_better) best = std::move(key);
  }
  return best;
}

size_t ConnectionCount::count_of(const std::string& whose) const {
  const auto found = open_of_.find(whose);
  return found == open_of_.end() ? 0 : found->second;
}

ConnectionCount::Place ConnectionCount::enter(const Neighbour& owner) {
  Place place{owner.name, owner.group, token_key(owner, true)};
  add(place, true);
  return place;
}

void ConnectionCount::leave(const Place& place) {
  if (open_of_.contains(place.owner)) add(place, false);
}

void ConnectionCount::add(const Place& place, bool comes) {
  const auto by_one = [comes](size_t& count) { return count += comes ? 1 : -1; };
  by_one(open_);
  for (const std::string* whose : {&place.owner, &place.group, &place.token}) {
    if (!whose->empty() && by_one(open_of_[*whose]) == 0) open_of_.erase(*whose);
  }
}

}  // namespace hyades::coordinator
