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

/// Who of those that nobody knows yet may come in, who waits, and who has to go. There are bounds
/// in all and for each neighbourhood (neighbourhood_of()). A neighbourhood is trusted if somebody
/// has shown a token from there lately. Some places are kept for these, so that no crowd of others
/// keeps a farm's own machines out.
///
/// Neighbourhoods take turns. Those of one token have one turn together, as have those that may be
/// one (Neighbour::group): so they make no crowd that comes before others. Who gives up while he
/// waits, as clients do that try again, keeps his turn. Knows no sockets and no clock. Not
/// thread-safe.
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
        2000};                       ///< the same where others wait for the place
    std::chrono::hours trust{24};    ///< how long a neighbourhood is trusted at least
    size_t trusted = 4096;           ///< how many of one token are at least
    std::chrono::seconds turn{300};  ///< how long a turn is kept at least of who has given up
    size_t turns = 8192;             ///< how many are at most, of parties and within groups each
  };

  explicit StrangerQueue(const Limits& limits);

  /// One comes, and waits; `own`: it is our own user, who comes before all others, and for whom
  /// there are places beside theirs. `group`: of neighbourhoods that may be one; empty: none.
  void come(Id id, const std::string& neighbourhood, bool own = false,
            const std::string& group = {});
  /// Lets the next one in, if one may be. Of each neighbourhood the last that came is the first:
  /// who has waited for long has given up, or soon will.
  std::optional<Id> let_in(Time now);
  /// Where more wait than may: one of them, who has to go. Of those who have one turn together the
  /// party of which most wait, of these the neighbourhood that is last in line, and of it the one
  /// that has waited longest: so that a crowd turns away nobody but itself.
  std::optional<Id> turn_away();
  /// Those that have been inside for too long, who have to go.
  std::vector<Id> expel(Time now);
  /// One has become known by the token of this id: its neighbourhood is trusted from now on, and
  /// the next of it comes in in its place, for as long as `patience_when_full` since one came in in
  /// turn. Nothing where this one was not there.
  void know(Id id, const std::string& token_id, Time now);
  /// Somebody of there, who is none of our own user's, is still known by the token of this id.
  void trust(const std::string& neighbourhood, const std::string& token_id, Time now);
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
  enum class Rank { own, trusted, other };
  struct Party;
  using PartyOf = std::pair<Rank, std::string>;
  using Parties = std::map<PartyOf, Party>;
  struct Neighbourhood {
    size_t inside = 0;
    std::list<Id> waiting{};  ///< in the order in which they came
    Parties::iterator party;
    int64_t turn = 0;  ///< key in Party::turns, while somebody waits; negative: out of turn
    Time turn_began;   ///< when one came in in turn
  };
  using Neighbourhoods = std::map<std::string, Neighbourhood>;
  /// Those who have one turn together: our own user, the neighbourhoods of a token, or a group of
  /// which nobody is known.
  struct Party {
    size_t neighbourhoods = 0;
    size_t waiting = 0;
    std::map<int64_t, Neighbourhoods::iterator> turns{};  ///< where somebody waits, the next first
    int64_t turn = 0;
    int64_t place = 0;  ///< key in turns_, while somebody waits: `turn`, or the first of `turns`
                        ///< where that is out of turn; 0: nobody waits
  };
  struct Stranger {
    Neighbourhoods::iterator of;
    std::list<Id>::iterator place;  ///< in Neighbourhood::waiting, while it waits
  };
  /// Those of whom somebody waits, the next first.
  using Turns = std::map<int64_t, Parties::iterator>;

  /// Turns of those who have given up, of the last while and of the while before.
  struct KeptTurns {
    std::map<std::string, int64_t> now{};
    std::map<std::string, int64_t> before{};
  };
  void keep(KeptTurns& kept, const std::string& whose, int64_t turn) const;
  int64_t take_turn(KeptTurns& kept, const std::string& whose);

  static Rank rank_of(const Neighbourhood& one) { return one.party->first.first; }
  bool is_full(const Neighbourhood& one) const { return one.inside >= limits_.inside_of_one; }
  /// Whether those that are not trusted have all places that they may have.
  bool others_have_all() const {
    return inside_.size() - trusted_inside_ >= limits_.inside - limits_.kept;
  }
  bool is_waited_for(const Neighbourhood& one) const;
  Time expiry(Id id, Time since) const;

  /// Whose turn it is, of those of whom one more may be inside; and that of its party.
  struct Next {
    Neighbourhoods::iterator neighbourhood;
    int64_t turn;
  };
  std::optional<Next> next_of(Rank rank) const;
  std::optional<Next> next() const;

  void join(Neighbourhoods::iterator one, const PartyOf& party);
  void join_best_token(Neighbourhoods::iterator one);
  void part(Neighbourhoods::iterator one);
  void stand_in_line(Neighbourhoods::iterator one, int64_t turn);
  void leave_line(Neighbourhoods::iterator one);
  void place(Parties::iterator party);
  void recount(Parties::iterator party, size_t waiting, int64_t turn);
  void stop_waiting(const Stranger& stranger);
  void give_up(const Stranger& stranger);
  void forget_if_empty(Neighbourhoods::iterator one);

  Limits limits_;
  Parties parties_;
  Neighbourhoods neighbourhoods_;
  std::unordered_map<Id, Stranger> strangers_;
  std::unordered_map<Id, Time> inside_;  ///< since when
  std::unordered_set<Id> gone_;          ///< of those inside
  int64_t last_turn_ = 0;
  int64_t first_turn_ = 0;
  std::map<Rank, Turns> turns_;
  size_t trusted_inside_ = 0;
  TrustedNeighbours trusted_;
  /// Apart, so that strangers take no room of others, nor many addresses that of parties.
  std::map<Rank, KeptTurns> of_parties_;
  std::map<Rank, KeptTurns> of_neighbourhoods_;  ///< within their parties
  Time kept_since_{};
  std::map<std::pair<size_t, int64_t>, Parties::iterator>
      by_number_;  ///< by how many wait, and turn
};

}  // namespace hyades::coordinator
