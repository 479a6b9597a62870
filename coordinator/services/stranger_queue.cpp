#include "coordinator/services/stranger_queue.h"

#include <algorithm>
#include <iterator>
#include <utility>
#include <vector>

namespace hyades::coordinator {
StrangerQueue::StrangerQueue(const Limits& limits)
    : limits_(limits), trusted_(limits.trust, limits.trusted) {
  limits_.kept = std::min(limits_.kept, limits_.inside / 3);
}

void StrangerQueue::come(Id id, const std::string& neighbourhood, bool own,
                         const std::string& group) {
  const auto [of, is_new] = neighbourhoods_.try_emplace(neighbourhood);
  if (is_new) {
    if (own) {
      join(of, {Rank::own, ""});
    } else {
      join(of, {Rank::other, group.empty() ? neighbourhood : group});
      join_best_token(of);
    }
  }
  std::list<Id>& waiting = of->second.waiting;
  if (waiting.empty()) {
    stand_in_line(of, take_turn(of_neighbourhoods_[rank_of(of->second)], of->first));
  }
  waiting.push_back(id);
  const auto party = of->second.party;
  recount(party, party->second.waiting + 1, party->second.turn);
  strangers_.emplace(id, Stranger{of, std::prev(waiting.end())});
}

std::optional<StrangerQueue::Id> StrangerQueue::let_in(Time now) {
  if (now - kept_since_ >= limits_.turn) {
    for (auto* all : {&of_parties_, &of_neighbourhoods_}) {
      for (auto& [rank, kept] : *all) kept.before = std::exchange(kept.now, {});
    }
    kept_since_ = now;
  }
  const std::optional<Next> who = next();
  if (!who) return std::nullopt;
  const auto of = who->neighbourhood;
  Neighbourhood& one = of->second;
  const Id id = one.waiting.back();
  if (one.turn > 0) one.turn_began = now;
  recount(one.party, one.party->second.waiting, ++last_turn_);
  stop_waiting(strangers_.at(id));
  if (rank_of(one) == Rank::trusted) join_best_token(of);
  if (!one.waiting.empty()) stand_in_line(of, ++last_turn_);
  ++one.inside;
  if (rank_of(one) != Rank::other) ++trusted_inside_;
  inside_.emplace(id, now);
  return id;
}

std::optional<StrangerQueue::Id> StrangerQueue::turn_away() {
  if (waiting() <= limits_.waiting) return std::nullopt;
  const Party& most = by_number_.rbegin()->second->second;
  const Id id = most.turns.rbegin()->second->second.waiting.front();
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

void StrangerQueue::know(Id id, const std::string& token_id, Time now) {
  const auto found = strangers_.find(id);
  if (found == strangers_.end()) return;
  const auto of = found->second.of;
  Neighbourhood& one = of->second;
  if (rank_of(one) != Rank::own) {
    trusted_.trust(of->first, token_id, now);
    join_best_token(of);
  }
  // Not for ever: whoever has a token and two addresses could keep all others out.
  const bool early = now < one.turn_began + limits_.patience_when_full;
  if (early && !one.waiting.empty()) stand_in_line(of, --first_turn_);
  leave(id);
}

void StrangerQueue::trust(const std::string& neighbourhood, const std::string& token_id, Time now) {
  trusted_.trust(neighbourhood, token_id, now);
  // Who comes again after a break of the network is here before the end of his old connection.
  const auto of = neighbourhoods_.find(neighbourhood);
  if (of != neighbourhoods_.end() && rank_of(of->second) != Rank::own) join_best_token(of);
}

void StrangerQueue::leave(Id id) {
  const auto found = strangers_.find(id);
  if (found == strangers_.end()) return;
  const Stranger stranger = found->second;
  gone_.erase(id);
  if (inside_.erase(id) > 0) {
    --stranger.of->second.inside;
    if (rank_of(stranger.of->second) != Rank::other) --trusted_inside_;
  } else {
    give_up(stranger);
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

/// Few neighbourhoods are full: those before the one that is looked for have all the places inside.
std::optional<StrangerQueue::Next> StrangerQueue::next_of(Rank rank) const {
  const auto turns = turns_.find(rank);
  if (turns == turns_.end()) return std::nullopt;
  for (const auto& [place, party] : turns->second) {
    for (const auto& [turn, one] : party->second.turns) {
      if (!is_full(one->second)) return Next{one, place};
    }
  }
  return std::nullopt;
}

std::optional<StrangerQueue::Next> StrangerQueue::next() const {
  if (const auto own = next_of(Rank::own)) {
    return inside_.size() < limits_.inside + limits_.own ? own : std::nullopt;
  }
  if (inside_.size() >= limits_.inside) return std::nullopt;
  const auto trusted = next_of(Rank::trusted);
  const auto other = others_have_all() ? std::nullopt : next_of(Rank::other);
  if (!trusted || !other) return trusted ? trusted : other;
  const bool kept = trusted_inside_ < limits_.kept;
  return kept || trusted->turn < other->turn ? trusted : other;
}

/// Whether somebody could come in if one of this neighbourhood went.
bool StrangerQueue::is_waited_for(const Neighbourhood& one) const {
  if (is_full(one) && !one.waiting.empty()) return true;
  const bool full = inside_.size() >= limits_.inside;
  if (full && (next_of(Rank::trusted) || next_of(Rank::own))) return true;
  const bool others = others_have_all() ? rank_of(one) == Rank::other : full;
  return others && next_of(Rank::other);
}

StrangerQueue::Time StrangerQueue::expiry(Id id, Time since) const {
  const bool pressed = gone_.contains(id) || is_waited_for(strangers_.at(id).of->second);
  return since + (pressed ? limits_.patience_when_full : limits_.patience);
}

void StrangerQueue::join(Neighbourhoods::iterator one, const PartyOf& party) {
  one->second.party = parties_.try_emplace(party).first;
  ++one->second.party->second.neighbourhoods;
}

/// Of the tokens that were shown from there the one with fewest other neighbourhoods here: what
/// others of this one have shown takes nothing from anybody. Stays where none is known.
void StrangerQueue::join_best_token(Neighbourhoods::iterator one) {
  const auto others_of = [&](const std::string& token_id) {
    const auto party = parties_.find({Rank::trusted, token_id});
    if (party == parties_.end()) return size_t{0};
    return party->second.neighbourhoods - (party == one->second.party ? 1 : 0);
  };
  const std::vector<std::string>& all = trusted_.tokens_of(one->first);
  const auto best = std::min_element(
      all.begin(), all.end(),
      [&](const std::string& a, const std::string& b) { return others_of(a) < others_of(b); });
  if (best == all.end() || one->second.party->first == PartyOf{Rank::trusted, *best}) return;
  const size_t waiting = one->second.waiting.size();
  if (waiting > 0) leave_line(one);
  recount(one->second.party, one->second.party->second.waiting - waiting,
          one->second.party->second.turn);
  if (rank_of(one->second) == Rank::other) trusted_inside_ += one->second.inside;
  part(one);
  join(one, {Rank::trusted, *best});
  if (waiting > 0) stand_in_line(one, one->second.turn);
  recount(one->second.party, one->second.party->second.waiting + waiting,
          one->second.party->second.turn);
}

void StrangerQueue::part(Neighbourhoods::iterator one) {
  const auto party = one->second.party;
  if (--party->second.neighbourhoods == 0) parties_.erase(party);
}

void StrangerQueue::stand_in_line(Neighbourhoods::iterator one, int64_t turn) {
  Party& party = one->second.party->second;
  const auto& [rank, name] = one->second.party->first;
  if (party.turns.empty()) {
    recount(one->second.party, party.waiting, take_turn(of_parties_[rank], name));
  }
  party.turns.erase(one->second.turn);
  party.turns.emplace(turn, one);
  one->second.turn = turn;
  place(one->second.party);
}

void StrangerQueue::leave_line(Neighbourhoods::iterator one) {
  one->second.party->second.turns.erase(one->second.turn);
  place(one->second.party);
}

void StrangerQueue::place(Parties::iterator party) {
  Party& one = party->second;
  Turns& turns = turns_[party->first.first];
  turns.erase(one.place);
  one.place = 0;
  if (one.turns.empty()) return;
  const int64_t first = one.turns.begin()->first;
  one.place = first < 0 ? first : one.turn;
  turns.emplace(one.place, party);
}

void StrangerQueue::recount(Parties::iterator party, size_t waiting, int64_t turn) {
  Party& one = party->second;
  by_number_.erase({one.waiting, one.turn});
  one.waiting = waiting;
  one.turn = turn;
  if (waiting > 0) by_number_.emplace(std::pair(waiting, turn), party);
}

void StrangerQueue::stop_waiting(const Stranger& stranger) {
  Neighbourhood& one = stranger.of->second;
  one.waiting.erase(stranger.place);
  recount(one.party, one.party->second.waiting - 1, one.party->second.turn);
  if (one.waiting.empty()) leave_line(stranger.of);
}

void StrangerQueue::give_up(const Stranger& stranger) {
  const Neighbourhood& one = stranger.of->second;
  const auto party = one.party;
  const int64_t turn = one.turn;
  stop_waiting(stranger);
  if (!one.waiting.empty() || turn < 0) return;
  const auto& [rank, name] = party->first;
  if (name != stranger.of->first) keep(of_neighbourhoods_[rank], stranger.of->first, turn);
  if (party->second.turns.empty()) keep(of_parties_[rank], name, party->second.turn);
}

void StrangerQueue::keep(KeptTurns& kept, const std::string& whose, int64_t turn) const {
  if (kept.now.size() < limits_.turns) kept.now.insert_or_assign(whose, turn);
}

/// The one that was kept, or else the last.
int64_t StrangerQueue::take_turn(KeptTurns& kept, const std::string& whose) {
  for (auto* some : {&kept.now, &kept.before}) {
    const auto found = some->find(whose);
    if (found == some->end()) continue;
    const int64_t turn = found->second;
    kept.now.erase(whose);
    kept.before.erase(whose);
    return turn;
  }
  return ++last_turn_;
}

void StrangerQueue::forget_if_empty(Neighbourhoods::iterator one) {
  if (one->second.inside > 0 || !one->second.waiting.empty()) return;
  part(one);
  neighbourhoods_.erase(one);
}

}  // namespace hyades::coordinator
