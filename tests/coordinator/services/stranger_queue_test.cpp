#include "coordinator/services/stranger_queue.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <deque>
#include <map>
#include <set>
#include <string>
#include <utility>
#include <vector>

namespace hyades::coordinator {
namespace {

using namespace std::chrono_literals;

using Ids = std::vector<StrangerQueue::Id>;

/// Any moment will do.
constexpr StrangerQueue::Time kBegin{};

StrangerQueue::Limits few() {
  return {.inside = 4,
          .inside_of_one = 2,
          .kept = 0,
          .waiting = 10,
          .patience = 10s,
          .patience_when_full = 2s};
}

Ids let_in_all(StrangerQueue& queue, StrangerQueue::Time now = kBegin) {
  Ids all;
  while (const auto id = queue.let_in(now)) all.push_back(*id);
  return all;
}

TEST(StrangerQueue, NeighbourhoodsTakeTurnsAndTheLastOfEachIsFirst) {
  StrangerQueue queue(few());
  for (StrangerQueue::Id id = 1; id <= 6; ++id) queue.come(id, "crowd");
  queue.come(7, "honest");
  EXPECT_EQ(let_in_all(queue), (Ids{6, 7, 5})) << "two of the crowd are the most";
  EXPECT_EQ(queue.inside(), 3U);
  EXPECT_EQ(queue.waiting(), 4U);
  queue.come(8, "another");
  EXPECT_EQ(let_in_all(queue), (Ids{8})) << "what one neighbourhood leaves is for others";
  queue.come(9, "another");
  EXPECT_EQ(let_in_all(queue), Ids{}) << "four in all are the most";
  queue.leave(6);
  EXPECT_EQ(let_in_all(queue), (Ids{4})) << "the crowd has waited for longer";
  queue.leave(4);
  EXPECT_EQ(let_in_all(queue), (Ids{9})) << "and then it is not its turn";
}

TEST(StrangerQueue, WhoIsInTheWayHasLessTime) {
  StrangerQueue queue(few());
  queue.come(1, "a");
  queue.come(2, "a");
  queue.come(3, "b");
  let_in_all(queue);
  EXPECT_EQ(queue.next_expiry(), kBegin + 10s);
  EXPECT_EQ(queue.expel(kBegin + 9s), Ids{});
  queue.come(4, "a");
  EXPECT_EQ(queue.next_expiry(), kBegin + 2s);
  Ids gone = queue.expel(kBegin + 9s);
  EXPECT_EQ(std::set(gone.begin(), gone.end()), (std::set<StrangerQueue::Id>{1, 2}));
  EXPECT_EQ(queue.inside(), 1U) << "the one of b is in nobody's way";
  EXPECT_EQ(let_in_all(queue, kBegin + 9s), (Ids{4}));
  EXPECT_EQ(queue.expel(kBegin + 10s), (Ids{3}));
  EXPECT_EQ(queue.expel(kBegin + 18s), Ids{});
  EXPECT_EQ(queue.expel(kBegin + 19s), (Ids{4}));
  EXPECT_FALSE(queue.next_expiry());
}

TEST(StrangerQueue, WhereAllPlacesAreTakenEverybodyIsInTheWay) {
  StrangerQueue queue(few());
  for (StrangerQueue::Id id = 1; id <= 4; ++id) queue.come(id, id < 3 ? "a" : "b");
  EXPECT_EQ(let_in_all(queue).size(), 4U);
  queue.come(5, "c");
  EXPECT_EQ(queue.next_expiry(), kBegin + 2s);
  EXPECT_EQ(queue.expel(kBegin + 2s).size(), 4U);
  EXPECT_EQ(let_in_all(queue, kBegin + 2s), (Ids{5}));
}

TEST(StrangerQueue, WhoeverBecomesKnownLeavesAPlace) {
  StrangerQueue queue(few());
  for (StrangerQueue::Id id = 1; id <= 10; ++id) queue.come(id, "one machine");
  size_t in = 0;
  for (Ids now = let_in_all(queue); !now.empty(); now = let_in_all(queue)) {
    in += now.size();
    for (const auto id : now) queue.leave(id);
  }
  EXPECT_EQ(in, 10U) << "all within no time";
}

TEST(StrangerQueue, ACrowdTurnsAwayItself) {
  StrangerQueue queue(few());
  for (StrangerQueue::Id id = 1; id <= 12; ++id) queue.come(id, "crowd");
  let_in_all(queue);
  queue.come(13, "honest");
  EXPECT_EQ(queue.turn_away(), 1U) << "the one that has waited longest";
  EXPECT_FALSE(queue.turn_away());
  EXPECT_EQ(let_in_all(queue), (Ids{13}));
}

TEST(StrangerQueue, BoundsHoldAndNobodyIsLostWhateverHappens) {
  StrangerQueue::Limits limits = few();
  limits.kept = 1;
  limits.own = 1;
  limits.trusted = 1;
  StrangerQueue queue(limits);
  std::map<StrangerQueue::Id, std::string> all;
  std::set<StrangerQueue::Id> inside;
  uint64_t state = 1;
  const auto choose = [&](uint64_t below) {
    state = state * 6'364'136'223'846'793'005U + 1'442'695'040'888'963'407U;
    return (state >> 33U) % below;
  };
  const auto forget = [&](StrangerQueue::Id id) {
    all.erase(id);
    inside.erase(id);
  };
  for (StrangerQueue::Id id = 1; id < 20'000; ++id) {
    const StrangerQueue::Time now = kBegin + id * 100ms;
    if (choose(3) > 0) {
      all[id] = std::string(1, static_cast<char>('a' + choose(5)));
      queue.come(id, all[id], all[id] == "e");
    } else if (!all.empty()) {
      const auto any = std::next(all.begin(), static_cast<long>(choose(all.size())))->first;
      queue.leave(any);
      forget(any);
    }
    for (const auto gone : queue.expel(now)) forget(gone);
    for (const auto in : let_in_all(queue, now)) ASSERT_TRUE(inside.insert(in).second);
    while (const auto away = queue.turn_away()) forget(*away);
    ASSERT_EQ(queue.inside(), inside.size());
    ASSERT_EQ(queue.waiting(), all.size() - inside.size());
    ASSERT_LE(queue.waiting(), 10U);
    std::map<std::string, int> of;
    for (const auto in : inside) ASSERT_LE(++of[all[in]], 2);
    ASSERT_LE(inside.size(), 5U);
    if (!inside.empty() && choose(4) == 0) {
      const auto one = *std::next(inside.begin(), static_cast<long>(choose(inside.size())));
      queue.know(one, choose(2) == 0 ? "a token" : "another", now);
      forget(one);
    }
    if (id % 200 > 0) continue;
    // Where all who are inside go again and again, all who wait come in.
    for (int round = 0; round < 12; ++round) {
      for (const auto in : std::exchange(inside, {})) {
        queue.leave(in);
        forget(in);
      }
      for (const auto in : let_in_all(queue, now)) inside.insert(in);
    }
    ASSERT_EQ(queue.waiting(), 0U) << id;
  }
}

TEST(StrangerQueue, OneThatIsKnownLetsTheNextOfItsNeighbourhoodIn) {
  // Thirty addresses of a crowd, each with six that say nothing, and forty machines behind one.
  StrangerQueue::Limits limits;
  limits.kept = 0;
  StrangerQueue queue(limits);
  StrangerQueue::Id next = 1;
  for (int address = 0; address < 30; ++address) {
    for (int i = 0; i < 6; ++i) queue.come(next++, "crowd " + std::to_string(address));
  }
  let_in_all(queue);
  const StrangerQueue::Id first = next;
  while (next < first + 40) queue.come(next++, "farm");
  StrangerQueue::Time now = kBegin;
  size_t known = 0;
  for (; known < 40 && now < kBegin + 60s; now += 100ms) {
    queue.expel(now);
    while (const auto id = queue.let_in(now)) {
      if (*id < first) continue;
      queue.know(*id, "a token", now);
      ++known;
    }
  }
  EXPECT_EQ(known, 40U);
  EXPECT_LE(now, kBegin + 5s) << "the crowd had one round at most";
}

TEST(StrangerQueue, ThoseWhoAreKnownDoNotHandOnAllPlaces) {
  // Somebody with a token at two addresses shows it wherever one of his has been inside for long.
  StrangerQueue queue({});
  StrangerQueue::Id next = 1;
  const auto fill = [&](StrangerQueue::Id id) { queue.come(id, id % 2 == 0 ? "a" : "b"); };
  for (; next <= 80; ++next) fill(next);
  for (const auto id : let_in_all(queue)) queue.know(id, "a token", kBegin);
  std::deque<StrangerQueue::Id> inside;
  for (const auto id : let_in_all(queue)) inside.push_back(id);
  ASSERT_EQ(inside.size(), 24U);
  queue.come(100'000, "new");
  StrangerQueue::Id in = 0;
  StrangerQueue::Time now = kBegin;
  for (; now < kBegin + 60s && in != 100'000; now += 60ms) {
    fill(next++);
    queue.know(inside.front(), "a token", now);
    inside.pop_front();
    const auto let = queue.let_in(now);
    ASSERT_TRUE(let);
    in = *let;
    inside.push_back(in);
  }
  EXPECT_LE(now, kBegin + 5s) << "each has a turn and hands it on for two seconds";
}

TEST(StrangerQueue, PlacesAreKeptForThoseWhoHaveBeenKnown) {
  StrangerQueue queue({});
  queue.come(1, "farm");
  ASSERT_EQ(let_in_all(queue), Ids{1});
  queue.know(1, "a token", kBegin);
  StrangerQueue::Id next = 2;
  for (int address = 0; address < 3000; ++address) queue.come(next++, std::to_string(address));
  EXPECT_EQ(let_in_all(queue).size(), 16U) << "eight are kept";
  queue.come(next, "farm");
  EXPECT_EQ(let_in_all(queue), Ids{next}) << "at once";
  // Nor can a neighbourhood that was trusted take all that are left.
  for (int i = 0; i < 20; ++i) queue.come(++next, "farm");
  EXPECT_EQ(let_in_all(queue).size(), 7U);
  EXPECT_EQ(queue.inside(), 24U);
  EXPECT_EQ(queue.expel(kBegin + 2s).size(), 24U) << "all are in somebody's way";
  EXPECT_EQ(let_in_all(queue, kBegin + 2s).size(), 24U);
}

/// However many of them it has made trusted, and however full they keep the queue.
TEST(StrangerQueue, NeighbourhoodsOfOneTokenHaveOneTurn) {
  StrangerQueue queue({});
  StrangerQueue::Id next = 1;
  for (int i = 0; i < 600; ++i) {
    queue.come(next, "of eve " + std::to_string(i));
    ASSERT_EQ(let_in_all(queue), Ids{next});
    queue.know(next++, "eve's", kBegin);
  }
  queue.come(next, "of ada");
  ASSERT_EQ(let_in_all(queue), Ids{next});
  queue.know(next++, "ada's", kBegin);
  for (int i = 0; i < 1800; ++i) queue.come(next++, "of eve " + std::to_string(i % 600));
  EXPECT_EQ(let_in_all(queue).size(), 24U);
  const StrangerQueue::Id ada = 100'000;
  const StrangerQueue::Id newcomer = 100'001;
  queue.come(ada, "of ada");
  queue.come(newcomer, "of nobody");
  EXPECT_EQ(queue.expel(kBegin + 2s).size(), 24U);
  const Ids in = let_in_all(queue, kBegin + 2s);
  ASSERT_EQ(in.size(), 24U);
  EXPECT_EQ(std::count(in.begin(), in.begin() + 3, ada), 1);
  EXPECT_EQ(std::count(in.begin(), in.begin() + 10, newcomer), 1) << "eight are kept";
}

/// However many neighbourhoods somebody with a token has made trusted.
TEST(StrangerQueue, OurOwnUserComesFirstAndHasPlacesOfHisOwn) {
  StrangerQueue queue(few());
  for (StrangerQueue::Id id = 1; id <= 8; ++id) queue.come(id, "crowd " + std::to_string(id));
  EXPECT_EQ(let_in_all(queue).size(), 4U);
  queue.come(9, "own", true);
  queue.come(10, "own", true);
  queue.come(11, "own", true);
  EXPECT_EQ(let_in_all(queue), (Ids{11, 10})) << "beside the four of others";
  queue.leave(11);
  EXPECT_EQ(let_in_all(queue), (Ids{9}));
  queue.leave(10);
  queue.leave(9);
  EXPECT_EQ(let_in_all(queue), Ids{}) << "these places are nobody else's";
  queue.leave(1);
  queue.come(12, "own", true);
  EXPECT_EQ(let_in_all(queue).front(), 12U) << "before all who have waited";
}

TEST(StrangerQueue, TrustIsForgottenInTime) {
  StrangerQueue::Limits limits;
  limits.trusted = 2;
  StrangerQueue queue(limits);
  StrangerQueue::Id next = 1;
  for (const char* name : {"a", "b", "c", "d", "e"}) {
    queue.come(next, name);
    ASSERT_EQ(let_in_all(queue), Ids{next});
    queue.know(next++, "a token", kBegin);
  }
  for (int address = 0; address < 100; ++address) queue.come(next++, std::to_string(address));
  ASSERT_EQ(let_in_all(queue).size(), 16U);
  queue.come(next, "a");
  EXPECT_TRUE(let_in_all(queue).empty()) << "four have been known since";
  queue.come(++next, "e");
  EXPECT_EQ(let_in_all(queue), Ids{next});
}

/// One that stays for days is known all that time.
TEST(StrangerQueue, WhoGoesAfterDaysIsTrusted) {
  StrangerQueue queue({});
  StrangerQueue::Id next = 1;
  const auto known = [&](const std::string& from, StrangerQueue::Time now) {
    queue.come(next, from);
    ASSERT_EQ(let_in_all(queue, now), Ids{next});
    queue.know(next++, "a token", now);
  };
  for (const char* name : {"stays", "gone"}) known(name, kBegin);
  for (int day = 1; day < 4; ++day) known("others", kBegin + day * 25h);
  const auto now = kBegin + 80h;
  for (int address = 0; address < 100; ++address) queue.come(next++, std::to_string(address));
  ASSERT_EQ(let_in_all(queue, now).size(), 16U);
  queue.come(next++, "gone");
  queue.come(next, "stays");
  EXPECT_TRUE(let_in_all(queue, now).empty());
  queue.trust("stays", "a token", now);  // its old connection ends after the new one has come
  EXPECT_EQ(let_in_all(queue, now), Ids{next});
}

/// A crowd of addresses, of which each has always somebody waiting.
class Crowd {
 public:
  Crowd(StrangerQueue& queue, int addresses, const std::string& group) : queue_(queue) {
    for (int i = 0; i < addresses; ++i) come(group + " " + std::to_string(i), group);
  }
  /// One of them has gone.
  void comes_again(StrangerQueue::Id id) {
    const auto of = all_.extract(id);
    come(of.mapped().first, of.mapped().second);
  }

 private:
  void come(const std::string& name, const std::string& group) {
    all_[next_] = {name, group};
    queue_.come(next_++, name, false, group);
  }

  StrangerQueue& queue_;
  std::map<StrangerQueue::Id, std::pair<std::string, std::string>> all_;
  StrangerQueue::Id next_ = 1'000'000;
};

/// After how long somebody of `name` comes in who waits for twenty seconds each time, as gRPC's
/// clients do, and tries again soon.
std::chrono::nanoseconds time_to_come_in(StrangerQueue& queue, Crowd& crowd,
                                         const std::string& name, const std::string& group) {
  StrangerQueue::Id own = 0;
  StrangerQueue::Id next = 1;
  auto tried = kBegin;
  for (auto now = kBegin; now < kBegin + 600s; now += 100ms) {
    if (own == 0 && now >= tried) {
      own = next++;
      tried = now;
      queue.come(own, name, false, group);
    }
    for (const auto id : queue.expel(now)) crowd.comes_again(id);
    for (const auto id : let_in_all(queue, now)) {
      if (id == own) return now - kBegin;
    }
    if (own != 0 && now - tried >= 20s) {
      queue.leave(std::exchange(own, 0));
      tried = now + 3s;
    }
  }
  return 600s;
}

/// The same beside a crowd of so many addresses of `theirs`, a group or "".
std::chrono::nanoseconds time_beside(int addresses, const std::string& theirs,
                                     const std::string& group) {
  StrangerQueue queue({});
  Crowd crowd(queue, addresses, theirs);
  let_in_all(queue, kBegin);
  return time_to_come_in(queue, crowd, "honest", group);
}

TEST(StrangerQueue, WhoTriesAgainHasNotLostHisTurn) { EXPECT_LE(time_beside(400, "", ""), 80s); }

/// Nor among those who may be one, as the users of a machine.
TEST(StrangerQueue, AGroupHasOneTurnAndItsOwnEachTheirs) {
  EXPECT_LE(time_beside(2000, "network", ""), 3s);
  EXPECT_LE(time_beside(400, "users of this machine", "users of this machine"), 80s);
}

/// However many addresses of one network give up, or crowd: they take no other's turn, nor turn
/// away anybody else.
TEST(StrangerQueue, AGroupTakesNoTurnsThatAreKeptForOthers) {
  StrangerQueue queue({});
  Crowd crowd(queue, 400, "");
  let_in_all(queue, kBegin);
  StrangerQueue::Id next = 2'000'000;
  for (int i = 0; i < 10'000; ++i, ++next) {
    queue.come(next, "of a network " + std::to_string(i), false, "network");
    queue.leave(next);
  }
  EXPECT_LE(time_to_come_in(queue, crowd, "honest", ""), 80s);
  StrangerQueue full({});
  Crowd network(full, 4000, "network");
  full.come(1, "honest");
  for (int i = 0; i < 100; ++i) {
    full.come(next++, "more " + std::to_string(i), false, "network");
    while (const auto away = full.turn_away()) ASSERT_NE(*away, 1U);
  }
  Ids in = let_in_all(full);
  EXPECT_EQ(std::count(in.begin(), in.end(), 1U), 1);
}

/// A token that somebody shows from an address that he shares takes nothing from the others there.
TEST(StrangerQueue, AnotherTokenTakesNoTurn) {
  StrangerQueue queue({});
  StrangerQueue::Id next = 1;
  const auto known = [&](const std::string& from, const std::string& token) {
    queue.come(next, from);
    ASSERT_EQ(let_in_all(queue), Ids{next});
    queue.know(next++, token, kBegin);
  };
  known("office", "ada's");
  for (int i = 0; i < 100; ++i) known("of eve " + std::to_string(i), "eve's");
  known("office", "eve's");
  for (int token = 1; token < 5; ++token) {
    const std::string another = "eve's " + std::to_string(token);
    for (int i = 0; i < 100; ++i) known("of eve " + std::to_string(i), another);
    known("office", another);
  }
  for (int i = 0; i < 100; ++i) queue.come(next++, "of eve " + std::to_string(i));
  EXPECT_EQ(let_in_all(queue).size(), 24U);
  queue.come(next, "office");
  queue.expel(kBegin + 2s);
  const Ids in = let_in_all(queue, kBegin + 2s);
  EXPECT_EQ(std::count(in.begin(), in.begin() + 6, next), 1) << "the five of eve come before";
}

/// However many addresses crowd with the token of one that waits, or each with one of its own.
TEST(StrangerQueue, WhoHasATokenKeepsHisTurn) {
  for (const bool each : {false, true}) {
    StrangerQueue queue({});
    StrangerQueue::Id next = 1;
    const auto known = [&](const std::string& from) {
      queue.come(next, from);
      ASSERT_EQ(let_in_all(queue), Ids{next});
      queue.know(next++, each ? "that of " + from : "the farm's", kBegin);
    };
    known("honest");
    for (int i = 0; i < 400; ++i) known("crowd " + std::to_string(i));
    Crowd crowd(queue, 400, "crowd");
    let_in_all(queue, kBegin);
    EXPECT_LE(time_to_come_in(queue, crowd, "honest", ""), 80s) << each;
  }
}

/// A token that is shown from everywhere only after another of the place was: once it has its turn.
TEST(StrangerQueue, APlaceBelongsToItsTokenOfFewest) {
  StrangerQueue queue({});
  StrangerQueue::Id next = 10;
  const auto known = [&](const std::string& from, const std::string& token) {
    queue.come(next, from);
    ASSERT_EQ(let_in_all(queue), Ids{next});
    queue.know(next++, token, kBegin);
  };
  known("office", "eve's");
  known("office", "ada's");
  queue.come(1, "office");  // to eve's: it is the first of two of which nobody is here
  ASSERT_EQ(let_in_all(queue), Ids{1});
  for (int i = 0; i < 100; ++i) known("crowd " + std::to_string(i), "eve's");
  Crowd crowd(queue, 100, "crowd");
  ASSERT_EQ(let_in_all(queue).size(), 23U);
  // Its first turn is one of a hundred, and the next is one of two.
  auto now = kBegin;
  const auto time_of = [&](StrangerQueue::Id one) {
    queue.come(one, "office");
    const auto since = now;
    for (; now < kBegin + 100s; now += 100ms) {
      for (const auto id : queue.expel(now)) {
        if (id >= 1'000'000) crowd.comes_again(id);
      }
      const Ids in = let_in_all(queue, now);
      if (std::count(in.begin(), in.end(), one) > 0) break;
    }
    return now - since;
  };
  EXPECT_GE(time_of(2), 4s);
  EXPECT_LE(time_of(3), 2s);
}

/// Whoever shows one token from everywhere makes nobody else's be forgotten.
TEST(StrangerQueue, OneTokenPushesOutNoOther) {
  StrangerQueue::Limits limits;
  limits.trusted = 2;
  StrangerQueue queue(limits);
  StrangerQueue::Id next = 1;
  for (const char* name : {"of ada", "1", "2", "3", "4", "5", "6", "7"}) {
    queue.come(next, name);
    ASSERT_EQ(let_in_all(queue), Ids{next});
    queue.know(next, next == 1 ? "ada's" : "eve's", kBegin);
    ++next;
  }
  for (int address = 0; address < 100; ++address)
    queue.come(next++, "crowd " + std::to_string(address));
  ASSERT_EQ(let_in_all(queue).size(), 16U);
  queue.come(next, "of ada");
  EXPECT_EQ(let_in_all(queue), Ids{next});
}

TEST(StrangerQueue, WhoHasGoneKeepsHisPlaceForATime) {
  StrangerQueue::Limits limits;
  limits.inside = 2;
  limits.inside_of_one = 1;
  limits.patience_when_full = 2s;
  StrangerQueue queue(limits);
  queue.come(1, "a");
  queue.come(2, "a");
  ASSERT_EQ(let_in_all(queue, kBegin), (std::vector<StrangerQueue::Id>{2}));
  queue.go(2, kBegin + 1s);
  EXPECT_TRUE(let_in_all(queue, kBegin + 1s).empty());
  EXPECT_TRUE(queue.all_inside().empty()) << "but nobody is there";
  EXPECT_EQ(queue.next_expiry(), kBegin + 2s);
  queue.expel(kBegin + 2s);
  EXPECT_EQ(let_in_all(queue, kBegin + 2s), (std::vector<StrangerQueue::Id>{1}));
  queue.leave(1);  // he is known
  EXPECT_EQ(queue.inside(), 0U);
  queue.come(3, "a");
  queue.go(3, kBegin + 3s);
  EXPECT_EQ(queue.waiting(), 0U);
}

}  // namespace
}  // namespace hyades::coordinator
