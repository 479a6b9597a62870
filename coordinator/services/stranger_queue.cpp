#include "coordinator/services/stranger_queue.h"

#include <algorithm>
#include <iterator>
#include <utility>

namespace hyades::coordinator {

StrangerQueue::StrangerQueue(const Limits& limits)
    : limits_(limits), trusted_(limits.trust, limits.trusted) {
  limits_.kept = std::min(limits_.kept, limits_.inside / 3);
}

void StrangerQueue::come(Id id, const std::string& neighbourhood, bool own) {
  const auto [of, is_new] = neighbourhoods_.try_emplace(neighbourhood);
  if (is_new) {
    of->second.own = own;
    of->second.trusted = own || trusted_.contains(neighbourhood);
  }
  std::list<Id>& waiting = of->second.waiting;
  if (waiting.empty()) {
    of->second.turn = ++last_turn_;
    turns_of(of->second).emplace(of->second.turn, of);
  } else {
    by_number_.erase({waiting.size(), &of->first});
  }
  waiting.push_back(id);
  by_number_.emplace(waiting.size(), &of->first);
  strangers_.emplace(id, Stranger{of, std::prev(waiting.end())});
}

std::optional<StrangerQueue::Id> StrangerQueue::let_in(Time now) {
  if (inside_.size() >= most_inside()) return std::nullopt;
  const auto of = next_in_turn();
  if (of == neighbourhoods_.end()) return std::nullopt;
  Neighbourhood& one = of->second;
  const Id id = one.waiting.back();
  if (one.turn > 0) one.turn_began = now;
  set_turn(of, ++last_turn_);
  stop_waiting(strangers_.at(id));
  ++one.inside;
  if (one.trusted) ++trusted_inside_;
  inside_.emplace(id, now);
  return id;
}

std::optional<StrangerQueue::Id> StrangerQueue::turn_away() {
  if (waiting() <= limits_.waiting) return std::nullopt;
  const Id id = neighbourhoods_.at(*by_number_.rbegin()->second).waiting.front();
  leave(id);
  return id;
}

std::vector<StrangerQueue::Id> StrangerQueue::expel(Time now) {
  std::vector<Id> late;
  for (const auto& [id, since] : inside_) {
    if (expiry(id, since) <= now) late.push_back(id);
  }
  for (const Id id : late) leave(id);
  return late;
}

void StrangerQueue::know(Id id, Time now) {
  const auto found = strangers_.find(id);
  if (found == strangers_.end()) return;
  const auto of = found->second.of;
  Neighbourhood& one = of->second;
  trusted_.trust(of->first, now);
  if (!one.trusted) {
    turns_.erase(one.turn);
    one.trusted = true;
    trusted_inside_ += one.inside;
    if (!one.waiting.empty()) trusted_turns_.emplace(one.turn, of);
  }
  // Not for ever: whoever has a token and two addresses could keep all others out.
  const bool early = now < one.turn_began + limits_.patience_when_full;
  if (early && !one.waiting.empty()) set_turn(of, --first_turn_);
  leave(id);
}

void StrangerQueue::leave(Id id) {
  const auto found = strangers_.find(id);
  if (found == strangers_.end()) return;
  const Stranger stranger = found->second;
  gone_.erase(id);
  if (inside_.erase(id) > 0) {
    --stranger.of->second.inside;
    if (stranger.of->second.trusted) --trusted_inside_;
  } else {
    stop_waiting(stranger);
  }
  strangers_.erase(found);
  forget_if_empty(stranger.of);
}

void StrangerQueue::go(Id id, Time now) {
  const auto found = inside_.find(id);
  if (found == inside_.end() || found->second + limits_.patience_when_full <= now) {
    leave(id);
  } else {
    gone_.insert(id);
  }
}

std::vector<StrangerQueue::Id> StrangerQueue::all_inside() const {
  std::vector<Id> ids;
  for (const auto& [id, since] : inside_) {
    if (!gone_.contains(id)) ids.push_back(id);
  }
  return ids;
}

std::optional<StrangerQueue::Time> StrangerQueue::next_expiry() const {
  std::optional<Time> first;
  for (const auto& [id, since] : inside_) {
    const Time then = expiry(id, since);
    first = first ? std::min(*first, then) : then;
  }
  return first;
}

void StrangerQueue::set_turn(Neighbourhoods::iterator one, int64_t turn) {
  Turns& turns = turns_of(one->second);
  turns.erase(one->second.turn);
  one->second.turn = turn;
  turns.emplace(turn, one);
}

/// Few are full: those before the one that is looked for have all the places inside.
StrangerQueue::Turns::const_iterator StrangerQueue::first_not_full(const Turns& turns) const {
  return std::find_if(turns.begin(), turns.end(),
                      [&](const auto& turn) { return !is_full(turn.second->second); });
}

StrangerQueue::Neighbourhoods::iterator StrangerQueue::next_in_turn() {
  const auto own = first_not_full(own_turns_);
  if (own != own_turns_.cend()) return own->second;
  const auto trusted = first_not_full(trusted_turns_);
  const auto other = others_have_all() ? turns_.cend() : first_not_full(turns_);
  if (trusted == trusted_turns_.cend()) {
    return other == turns_.cend() ? neighbourhoods_.end() : other->second;
  }
  const bool kept = trusted_inside_ < limits_.kept;
  return kept || other == turns_.cend() || trusted->first < other->first ? trusted->second
                                                                         : other->second;
}

/// Whether somebody could come in if one of this neighbourhood went.
bool StrangerQueue::is_waited_for(const Neighbourhood& one) const {
  if (is_full(one) && !one.waiting.empty()) return true;
  const bool full = inside_.size() >= limits_.inside;
  if (full && first_not_full(trusted_turns_) != trusted_turns_.cend()) return true;
  if (full && first_not_full(own_turns_) != own_turns_.cend()) return true;
  const bool others = others_have_all() ? !one.trusted : full;
  return others && first_not_full(turns_) != turns_.cend();
}

StrangerQueue::Time StrangerQueue::expiry(Id id, Time since) const {
  const bool pressed = gone_.contains(id) || is_waited_for(strangers_.at(id).of->second);
  return since + (pressed ? limits_.patience_when_full : limits_.patience);
}

void StrangerQueue::stop_waiting(const Stranger& stranger) {
  Neighbourhood& one = stranger.of->second;
  const std::string* name = &stranger.of->first;
  by_number_.erase({one.waiting.size(), name});
  one.waiting.erase(stranger.place);
  if (one.waiting.empty()) {
    turns_of(one).erase(one.turn);
  } else {
    by_number_.emplace(one.waiting.size(), name);
  }
}

void StrangerQueue::forget_if_empty(Neighbourhoods::iterator one) {
  if (one->second.inside == 0 && one->second.waiting.empty()) neighbourhoods_.erase(one);
}

}  // namespace hyades::coordinator
