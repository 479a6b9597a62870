#pragma once

#include <chrono>
#include <cstddef>
#include <cstdint>
#include <list>
#include <map>
#include <optional>
#include <set>
#include <string>
#include <unordered_map>
#include <unordered_set>
#include <utility>
#include <vector>

#include "coordinator/access/trusted_neighbours.h"

namespace hyades::coordinator {

/// Who of those that nobody knows yet may come in, who waits, and who has to go: bounds in all and
/// for each neighbourhood (neighbourhood_of()). Some places are kept for neighbourhoods of which
/// somebody has become known lately, so that no crowd of others keeps a farm's own machines out.
/// Knows no sockets and no clock. Not thread-safe.
class StrangerQueue {
 public:
  using Id = uint64_t;
  using Time = std::chrono::steady_clock::time_point;

  /// How many there may be, and for how long.
  struct Limits {
    size_t inside = 24;
    size_t inside_of_one = 12;  ///< of one neighbourhood
    size_t kept = 8;            ///< of those inside, for neighbourhoods that are trusted
    size_t own = 2;             ///< besides those inside, for our own user
    size_t waiting = 4000;
    std::chrono::milliseconds patience{10'000};  ///< with one who is inside, until known
    std::chrono::milliseconds patience_when_full{
        2000};                     ///< the same where others wait for the place
    std::chrono::hours trust{24};  ///< how long a neighbourhood is trusted at least
    size_t trusted = 4096;         ///< how many are at least
  };

  explicit StrangerQueue(const Limits& limits);

  /// One comes, and waits; `own`: it is our own user, who comes before all others, and for whom
  /// there are places beside theirs.
  void come(Id id, const std::string& neighbourhood, bool own = false);
  /// Lets the next one in, if one may be. Neighbourhoods take turns; of each the last that came is
  /// the first: who has waited for long has given up, or soon will.
  std::optional<Id> let_in(Time now);
  /// Where more wait than may: one of them, who has to go. Of the neighbourhood of which most wait
  /// the one that has waited longest, so that a crowd turns away nobody but itself.
  std::optional<Id> turn_away();
  /// Those that have been inside for too long, who have to go.
  std::vector<Id> expel(Time now);
  /// One has become known: its neighbourhood is trusted from now on, and the next of it comes in
  /// in its place, for as long as `patience_when_full` since one came in in turn. Nothing where
  /// this one was not there.
  void know(Id id, Time now);
  /// One has gone, and its place is free at once; nothing where this one was not there.
  void leave(Id id);
  /// One has gone. Who was inside leaves its place empty for as long as it might have been there
  /// while others wait: gRPC may still have work of it, and more may not come than it can do.
  void go(Id id, Time now);

  /// When expel() will find the next one, as things stand; nothing where nobody is inside.
  std::optional<Time> next_expiry() const;
  size_t inside() const { return inside_.size(); }  ///< places that are taken
  std::vector<Id> all_inside() const;               ///< but for those that have gone
  size_t waiting() const { return strangers_.size() - inside_.size(); }

 private:
  struct Neighbourhood {
    size_t inside = 0;
    std::list<Id> waiting{};  ///< in the order in which they came
    bool trusted = false;
    bool own = false;
    int64_t turn = 0;  ///< key in turns_of(), while somebody waits; negative: out of turn
    Time turn_began;   ///< when one came in in turn
  };
  using Neighbourhoods = std::map<std::string, Neighbourhood>;
  struct Stranger {
    Neighbourhoods::iterator of;
    std::list<Id>::iterator place;  ///< in Neighbourhood::waiting, while it waits
  };

  /// Those of whom somebody waits, by whose turn it is.
  using Turns = std::map<int64_t, Neighbourhoods::iterator>;
  Turns& turns_of(const Neighbourhood& one) {
    return one.own ? own_turns_ : one.trusted ? trusted_turns_ : turns_;
  }
  size_t most_inside() const {
    return limits_.inside + (first_not_full(own_turns_) == own_turns_.cend() ? 0 : limits_.own);
  }
  void set_turn(Neighbourhoods::iterator one, int64_t turn);

  bool is_full(const Neighbourhood& one) const { return one.inside >= limits_.inside_of_one; }
  Turns::const_iterator first_not_full(const Turns& turns) const;
  /// Whether those that are not trusted have all places that they may have.
  bool others_have_all() const {
    return inside_.size() - trusted_inside_ >= limits_.inside - limits_.kept;
  }
  /// Whose turn it is, of those of whom one more may be inside.
  Neighbourhoods::iterator next_in_turn();
  bool is_waited_for(const Neighbourhood& one) const;
  Time expiry(Id id, Time since) const;
  void stop_waiting(const Stranger& stranger);
  void forget_if_empty(Neighbourhoods::iterator one);

  Limits limits_;
  Neighbourhoods neighbourhoods_;
  std::unordered_map<Id, Stranger> strangers_;
  std::unordered_map<Id, Time> inside_;  ///< since when
  std::unordered_set<Id> gone_;          ///< of those inside
  int64_t last_turn_ = 0;
  int64_t first_turn_ = 0;
  Turns turns_;          ///< of those that are not trusted
  Turns trusted_turns_;  ///< of those that are
  Turns own_turns_;      ///< of our own user
  size_t trusted_inside_ = 0;
  TrustedNeighbours trusted_;
  std::set<std::pair<size_t, const std::string*>> by_number_;  ///< the same, by how many wait
};

}  // namespace hyades::coordinator
