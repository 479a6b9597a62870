#include "coordinator/services/stranger_queue.h"

#include <algorithm>
#include <iterator>

namespace hyades::coordinator {

void StrangerQueue::come(Id id, const std::string& neighbourhood) {
  const auto of = neighbourhoods_.try_emplace(neighbourhood).first;
  std::list<Id>& waiting = of->second.waiting;
  if (waiting.empty()) {
    of->second.turn = ++last_turn_;
    turns_.emplace(of->second.turn, of);
  } else {
    by_number_.erase({waiting.size(), &of->first});
  }
  waiting.push_back(id);
  by_number_.emplace(waiting.size(), &of->first);
  strangers_.emplace(id, Stranger{of, std::prev(waiting.end())});
}

std::optional<StrangerQueue::Id> StrangerQueue::let_in(Time now) {
  if (inside_.size() >= limits_.inside) return std::nullopt;
  const auto of = next_in_turn();
  if (of == neighbourhoods_.end()) return std::nullopt;
  Neighbourhood& one = of->second;
  const Id id = one.waiting.back();
  turns_.erase(one.turn);
  one.turn = ++last_turn_;
  turns_.emplace(one.turn, of);
  stop_waiting(strangers_.at(id));
  ++one.inside;
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

void StrangerQueue::leave(Id id) {
  const auto found = strangers_.find(id);
  if (found == strangers_.end()) return;
  const Stranger stranger = found->second;
  gone_.erase(id);
  if (inside_.erase(id) > 0) {
    --stranger.of->second.inside;
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

/// Few are full: those before the one that is looked for have all the places inside.
StrangerQueue::Neighbourhoods::iterator StrangerQueue::next_in_turn() {
  const auto found = std::find_if(turns_.begin(), turns_.end(),
                                  [&](const auto& turn) { return !is_full(turn.second->second); });
  return found == turns_.end() ? neighbourhoods_.end() : found->second;
}

/// Whether somebody could come in if one of this neighbourhood went.
bool StrangerQueue::is_waited_for(const Neighbourhood& one) const {
  if (is_full(one) && !one.waiting.empty()) return true;
  return inside_.size() >= limits_.inside &&
         std::any_of(turns_.begin(), turns_.end(),
                     [&](const auto& turn) { return !is_full(turn.second->second); });
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
    turns_.erase(one.turn);
  } else {
    by_number_.emplace(one.waiting.size(), name);
  }
}

void StrangerQueue::forget_if_empty(Neighbourhoods::iterator one) {
  if (one->second.inside == 0 && one->second.waiting.empty()) neighbourhoods_.erase(one);
}

}  // namespace hyades::coordinator
