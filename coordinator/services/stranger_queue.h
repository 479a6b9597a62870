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

namespace hyades::coordinator {

/// Who of those that nobody knows yet may come in, who waits, and who has to go: bounds in all and
/// for each neighbourhood (neighbourhood_of()). Knows no sockets and no clock. Not thread-safe.
class StrangerQueue {
 public:
  using Id = uint64_t;
  using Time = std::chrono::steady_clock::time_point;

  /// How many there may be, and for how long.
  struct Limits {
    size_t inside = 24;
    size_t inside_of_one = 12;  ///< of one neighbourhood
    size_t waiting = 4000;
    std::chrono::milliseconds patience{10'000};  ///< with one who is inside, until known
    std::chrono::milliseconds patience_when_full{
        2000};  ///< the same where others wait for the place
  };

  explicit StrangerQueue(const Limits& limits) : limits_(limits) {}

  /// One comes, and waits.
  void come(Id id, const std::string& neighbourhood);
  /// Lets the next one in, if one may be. Neighbourhoods take turns; of each the last that came is
  /// the first: who has waited for long has given up, or soon will.
  std::optional<Id> let_in(Time now);
  /// Where more wait than may: one of them, who has to go. Of the neighbourhood of which most wait
  /// the one that has waited longest, so that a crowd turns away nobody but itself.
  std::optional<Id> turn_away();
  /// Those that have been inside for too long, who have to go.
  std::vector<Id> expel(Time now);
  /// One has become known; nothing where this one was not there.
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
    uint64_t turn = 0;        ///< key in turns_, while somebody waits
  };
  using Neighbourhoods = std::map<std::string, Neighbourhood>;
  struct Stranger {
    Neighbourhoods::iterator of;
    std::list<Id>::iterator place;  ///< in Neighbourhood::waiting, while it waits
  };

  bool is_full(const Neighbourhood& one) const { return one.inside >= limits_.inside_of_one; }
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
  uint64_t last_turn_ = 0;
  std::map<uint64_t, Neighbourhoods::iterator> turns_;         ///< those of whom somebody waits
  std::set<std::pair<size_t, const std::string*>> by_number_;  ///< the same, by how many wait
};

}  // namespace hyades::coordinator
