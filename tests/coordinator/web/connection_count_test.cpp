// Whose connections there may be how many of.
#include "coordinator/web/connection_count.h"

#include <gtest/gtest.h>

#include <string>
#include <vector>

namespace hyades::coordinator {
namespace {

const Neighbour kOne{"192.0.2.1"};
const Neighbour kOther{"192.0.2.2"};
const Neighbour kOwn{"this user at 127.0.0.1", "", true};

TEST(ConnectionCount, NobodyTakesAll) {
  ConnectionCount count(60, 2, 1);
  count.enter(kOne);
  EXPECT_TRUE(count.may_come(kOne));
  const ConnectionCount::Place place = count.enter(kOne);
  EXPECT_FALSE(count.may_come(kOne));
  EXPECT_TRUE(count.may_come(kOther));
  count.leave(place);
  EXPECT_TRUE(count.may_come(kOne));
}

TEST(ConnectionCount, AProxyOfOurOwnHasAsManyAsThereAre) {
  ConnectionCount count(6, 2, 1);
  for (int i = 0; i < 6; ++i) {
    EXPECT_TRUE(count.may_come(kOwn));
    count.enter(kOwn);
  }
  EXPECT_FALSE(count.may_come(kOwn));
  EXPECT_FALSE(count.may_come(kOne));
}

TEST(ConnectionCount, AnotherUserOfThisMachineTakesNotAll) {
  ConnectionCount count(60, 20, 1);
  const Neighbour other{"user 1001"};
  int came = 0;
  for (; count.may_come(other); ++came) count.enter(other);
  EXPECT_LE(came, 15);
  EXPECT_TRUE(count.may_come(kOwn));
}

/// One customer's network, or one user's many, takes half at most.
TEST(ConnectionCount, AGroupTakesHalf) {
  ConnectionCount count(4000, 1000, 8);
  int came = 0;
  for (int i = 0; i < 600; ++i) {
    const Neighbour one{"2001:db8:0:" + std::to_string(i) + "::/64", "2001:db8::/48"};
    for (int k = 0; k < 8 && count.may_come(one); ++k, ++came) count.enter(one);
  }
  EXPECT_EQ(came, 2000);
  EXPECT_TRUE(count.may_come(kOne));
}

/// One token makes any number of addresses known, by which half of what is kept can be had.
TEST(ConnectionCount, OneTokenTakesNotAllThatIsKept) {
  ConnectionCount count(4000, 1000, 8);
  count.know(kOne, "ada's", {});
  std::vector<ConnectionCount::Place> places;
  for (int i = 0; i < 1000; ++i) {
    const Neighbour one{"address " + std::to_string(i)};
    count.know(one, "eve's", {});
    for (int k = 0; k < 8 && count.may_come(one); ++k) places.push_back(count.enter(one));
  }
  EXPECT_EQ(places.size(), 3500U);
  EXPECT_TRUE(count.may_come(kOne));
  EXPECT_FALSE(count.may_come({"address 1"}));
  for (int i = 0; i < 3300; ++i) {
    count.leave(places.back());
    places.pop_back();
  }
  EXPECT_TRUE(count.may_come({"address 999"}));
}

/// Nor by showing it from an address that others use, too.
TEST(ConnectionCount, AnotherTokenTakesNoPlaces) {
  ConnectionCount count(4000, 1000, 8);
  for (int i = 0; i < 600; ++i) {
    const Neighbour one{"address " + std::to_string(i)};
    count.know(one, "eve's", {});
    for (int k = 0; k < 8 && count.may_come(one); ++k) count.enter(one);
  }
  count.know(kOne, "ada's", {});
  count.know(kOne, "eve's", {});
  EXPECT_TRUE(count.may_come(kOne));
  EXPECT_EQ(count.enter(kOne).token, "token eve's");
}

/// By one token all of a group are known.
TEST(ConnectionCount, AGroupThatIsKnownLeavesPlaces) {
  ConnectionCount count(4000, 1000, 8);
  count.know(kOne, "ada's", {});
  for (int i = 0; i < 600; ++i) {
    const Neighbour one{"user " + std::to_string(i), "users of this machine"};
    count.know(one, "eve's", {});
    for (int k = 0; k < 1000 && count.may_come(one); ++k) count.enter(one);
  }
  EXPECT_TRUE(count.may_come(kOne));
  EXPECT_TRUE(count.may_come(kOwn));
}

TEST(ConnectionCount, WhoIsKnownHasPlacesThatStrangersDoNotReach) {
  ConnectionCount count(4000, 1000, 8);
  count.know(kOne, "ada's", {});
  for (int i = 0; i < 1000; ++i) {
    const Neighbour stranger{"stranger " + std::to_string(i)};
    for (int k = 0; k < 8 && count.may_come(stranger); ++k) count.enter(stranger);
  }
  EXPECT_FALSE(count.may_come(kOther));
  EXPECT_TRUE(count.may_come(kOne));
  EXPECT_TRUE(count.may_come(kOwn));
}

}  // namespace
}  // namespace hyades::coordinator
