#pragma once

#include <cstddef>
#include <map>
#include <string>

#include "coordinator/access/peer_user.h"
#include "coordinator/access/trusted_neighbours.h"

namespace hyades::coordinator {

/// How many connections are open, and of whom, so that nobody takes all of them. Not thread-safe.
class ConnectionCount {
 public:
  /// At most `most` are open at once, an eighth of them for those who are known alone: a quarter of
  /// that for our own user, and half of it at most for those who are known by one token. Of a group
  /// half may be open, and half of that eighth, and of one owner (neighbour_at()) at most
  /// `most_of_one` and a quarter of what is left, but `sure` in any case. So a few owners cannot
  /// take all: of four that try each gets an eighth, and one who comes later as much as they have.
  ConnectionCount(size_t most, size_t most_of_one, size_t sure)
      : most_(most), most_of_one_(most_of_one), sure_(sure) {}

  /// Those for whom an open connection is counted.
  struct Place {
    std::string owner{};
    std::string group{};  ///< empty: none
    std::string token{};  ///< key of a token that was shown from there; empty: none was
  };

  /// Whether the owner may have one more. Our own user, who may run a proxy, may have all.
  bool may_come(const Neighbour& owner) const;
  /// The owner has shown the token of this id (Caller::token_id), or needs none.
  void know(const Neighbour& owner, const std::string& token_id, TrustedNeighbours::Time now) {
    known_.trust(owner.name, token_id, now);
  }
  /// Counts one that has come.
  Place enter(const Neighbour& owner);
  /// Counts one that has gone; once for each that has entered.
  void leave(const Place& place);

 private:
  /// Of those that were shown from there, the one by which most or fewest are open; empty: none
  /// was. By that of fewest it is judged, and for that of most it counts: so the token of somebody
  /// who shares an address takes nothing from those of others.
  std::string token_key(const Neighbour& owner, bool most) const;
  size_t count_of(const std::string& whose) const;
  void add(const Place& place, bool comes);

  size_t most_;
  size_t most_of_one_;
  size_t sure_;
  size_t open_ = 0;
  std::map<std::string, size_t> open_of_;  ///< by owner, by group and by token
  TrustedNeighbours known_;
};

}  // namespace hyades::coordinator
